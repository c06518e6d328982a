//! The robot's numbers as symbols with the book's names, or as exact numbers.

use crate::atom::{Atom, Class, Id, Name};
use crate::letters::{plain_name, printable};
use crate::offsets::{Offsets, with_offset};
use crate::rational::Rational;
use crate::read::{At, NotRead, Part, agree, read_urdf};
use crate::rotation::{exact, exact_axis, is_short};
use crate::symbol::{Symbol, with_table};
use mozzi::model::description::JointKind;
use mozzi::{Description, Model, SE3, SO3, SpatialInertia, Vec3};
use std::collections::{HashMap, HashSet};

/// The kinds of numbers that become symbols.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Symbols {
    /// Masses m.
    pub masses: bool,
    /// Distances L between joints, r to centres of mass.
    pub lengths: bool,
    /// Rotational inertias I about centres of mass.
    pub inertias: bool,
    /// The size g of gravity.
    pub gravity: bool,
    /// Friction d, μ and springs k, φ of joints.
    pub joints: bool,
}

impl Symbols {
    /// All numbers.
    pub const ALL: Symbols = Symbols { masses: true, lengths: true, inertias: true, gravity: true, joints: true };
    /// No numbers.
    pub const NONE: Symbols = Symbols { masses: false, lengths: false, inertias: false, gravity: false, joints: false };

    /// True if bodies, distances and gravity are symbols.
    pub(crate) fn are_all(self) -> bool {
        self.masses && self.lengths && self.inertias && self.gravity
    }
}

/// Which equal numbers of one kind are one symbol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Equal {
    /// None: each number of the file is a symbol.
    #[default]
    Separate,
    /// Those of one link.
    OfLink,
    /// Those of the robot.
    OfRobot,
}

/// A symbol, and the number of the file that it is.
#[derive(Clone, Debug)]
pub struct Meaning {
    /// Its name.
    pub name: Name,
    /// Its kind.
    pub class: Class,
    /// Its number in the file.
    pub value: Rational,
    /// Its unit.
    pub unit: &'static str,
    /// The places in the file.
    pub places: Vec<String>,
    pub(crate) id: Id,
}

impl Meaning {
    /// Its name in code: `I1_zz`.
    pub fn plain_name(&self) -> String {
        plain_name(&self.name)
    }
}

/// The numbers of one robot.
#[derive(Debug)]
pub(crate) struct Parameters {
    symbols: Symbols,
    equal: Equal,
    /// The number of the moving link that carries each link; 0 for the base.
    carrier: HashMap<String, usize>,
    /// For each joint its parent's carrier, and the part of its length's subscript.
    lengths: HashMap<String, (usize, String)>,
    /// The part of the subscript of each link's own mass.
    bodies: HashMap<String, String>,
    /// The number of each moving joint.
    joints: HashMap<String, usize>,
    /// The coordinates ≠ 0 of each joint's origin and link's centre of mass.
    coordinates: HashMap<(String, bool), usize>,
    /// Lengths are between axes where link frames are not on them.
    offsets: Offsets,
    is_gravity_along_axis: bool,
    pub legend: Vec<Meaning>,
    /// Names of the legend in code.
    taken: HashSet<String>,
    /// Angles of the file that were taken for a multiple of π, with the multiple.
    pub angles: Vec<(String, Rational)>,
    /// The sum of the differences.
    pub angle_error: f64,
}

const AXES: [&str; 3] = ["x", "y", "z"];
const PAIRS: [&str; 6] = ["xx", "xy", "xz", "yy", "yz", "zz"];

impl Parameters {
    pub fn new(model: &Model, symbols: Symbols, equal: Equal) -> Self {
        let robot = model.description();
        let numbers = |name: &dyn Fn(&mozzi::model::description::Joint) -> String| {
            model.moving_joints().map(name).zip(1..).collect::<HashMap<String, usize>>()
        };
        let (joints, moved) = (numbers(&|joint| joint.name.clone()), numbers(&|joint| joint.child.clone()));
        let parent: HashMap<&str, &str> = robot.joints.iter().map(|j| (j.child.as_str(), j.parent.as_str())).collect();
        let carrier_of = |link: &str| {
            let mut at = link;
            while !moved.contains_key(at) {
                let Some(next) = parent.get(at) else { return 0 };
                at = next;
            }
            moved[at]
        };
        let carrier: HashMap<String, usize> =
            robot.links.iter().map(|link| (link.name.clone(), carrier_of(&link.name))).collect();
        let offsets = if symbols.lengths { Offsets::of(robot) } else { Offsets::default() };
        let mut coordinates = HashMap::new();
        let mut count = |name: &str, is_joint: bool, p: Vec3| {
            let count = p.0.iter().filter(|x| **x != 0.0).count();
            coordinates.insert((name.to_string(), is_joint), count);
            count > 0
        };
        let mut on_carrier = vec![0; joints.len() + 1];
        let has_length: Vec<bool> = robot.joints.iter().map(|j| count(&j.name, true, offsets.origin(j))).collect();
        for (joint, _) in robot.joints.iter().zip(&has_length).filter(|(_, has)| **has) {
            on_carrier[carrier[&joint.parent]] += 1;
        }
        let lengths = robot.joints.iter().map(|joint| {
            let at = carrier[&joint.parent];
            let part = if on_carrier[at] > 1 { joint.child.clone() } else { String::new() };
            (joint.name.clone(), (at, part))
        });
        let lengths = lengths.collect();
        let mut bodies_on = vec![0; joints.len() + 1];
        for link in &robot.links {
            count(&link.name, false, offsets.center(link));
            bodies_on[carrier[&link.name]] += usize::from(link.inertia.mass != 0.0);
        }
        let body = |link: &mozzi::model::description::Link| {
            let is_own = moved.contains_key(&link.name) || bodies_on[carrier[&link.name]] == 1;
            (link.name.clone(), if is_own { String::new() } else { link.name.clone() })
        };
        Parameters {
            symbols,
            equal,
            bodies: robot.links.iter().map(body).collect(),
            carrier,
            lengths,
            joints,
            coordinates,
            offsets,
            is_gravity_along_axis: robot.gravity.iter().filter(|x| **x != 0.0).count() == 1,
            legend: Vec::new(),
            taken: HashSet::new(),
            angles: Vec::new(),
            angle_error: 0.0,
        }
    }

    /// The description in symbols: by the file's decimals if there is a file, else by the description's numbers.
    pub fn describe(&mut self, robot: &Description, text: Option<&str>) -> Result<Description<Symbol>, NotRead> {
        match text {
            Some(text) => {
                let mut read = read_urdf(text, robot, is_short, nearest_decimal, |at, text| self.number(at, text))?;
                // what 1.5708 stands for is not its number
                agree(&read, robot, 1e-6 + 3.0 * self.angle_error)?;
                with_exact_axes(&mut read, robot, |axis| !is_short(axis));
                Ok(read)
            }
            None => self.of_numbers(robot),
        }
    }

    /// Without decimals of a file: each number's shortest decimals, but rotations that are exact. Rounding errors of
    /// centres of mass are removed in the 15th digit.
    fn of_numbers(&mut self, robot: &Description) -> Result<Description<Symbol>, NotRead> {
        let mut read = robot.map(nearest_decimal);
        with_exact_axes(&mut read, robot, |_| true);
        for (new, frame) in read.frames.iter_mut().zip(&robot.frames) {
            new.T.R = exact(frame.T.R);
        }
        let offsets = self.offsets.clone();
        let mut exactly = offsets.exact(&read);
        let mut number = |name: &str, part: Part, x: f64| {
            let text = format!("{}", fifteen_digits(x));
            self.number(At { name, part }, &text).ok_or_else(|| NotRead(format!("{name}: the number {x}")))
        };
        for (k, x) in robot.gravity.iter().enumerate() {
            read.gravity[k] = number("gravity", Part::Gravity(k), *x)?;
        }
        let mut lengths = Vec::new();
        for joint in &robot.joints {
            let mut p = Vec3::zero();
            for (k, x) in offsets.origin(joint).0.into_iter().enumerate() {
                p.0[k] = number(&joint.name, Part::Origin(k), x)?;
            }
            lengths.push(p);
        }
        for link in &robot.links {
            let Some(d) = offsets.of_center(link) else { continue };
            let mut moved = Vec3::zero();
            for (k, x) in d.0.into_iter().enumerate() {
                moved.0[k] = number(&link.name, Part::Center(k), x)?;
            }
            exactly.insert(link.name.clone(), moved);
            let joint = read.joints.iter_mut().find(|joint| joint.child == link.name);
            joint.into_iter().for_each(|joint| joint.kind = with_offset(joint.kind, moved));
        }
        let offset = |link: &str| exactly.get(link).copied().unwrap_or(Vec3::zero());
        for ((new, joint), p) in read.joints.iter_mut().zip(&robot.joints).zip(lengths) {
            let name = joint.name.as_str();
            new.origin.R = exact(joint.origin.R);
            new.origin.p = p - offset(&joint.parent) + new.origin.R * offset(&joint.child);
            new.damping = number(name, Part::Damping, joint.damping)?;
            new.friction = number(name, Part::Friction, joint.friction)?;
            new.stiffness = number(name, Part::Stiffness, joint.stiffness)?;
            new.spring_reference = number(name, Part::SpringReference, joint.spring_reference)?;
        }
        for (new, link) in read.links.iter_mut().zip(&robot.links) {
            let (name, G) = (link.name.as_str(), link.inertia);
            let c = G.center_of_mass();
            let T = SE3 { R: SO3::identity(), p: c };
            let at_c = G.congruence(T.Ad());
            let mut center = Vec3::zero();
            for (k, x) in offsets.center(link).0.into_iter().enumerate() {
                center.0[k] = number(name, Part::Center(k), x)?;
            }
            center -= offset(name);
            let size = [G.I.xx, G.I.yy, G.I.zz].into_iter().fold(0.0, f64::max);
            let I = at_c.I;
            let mut entry =
                |k: usize, x: f64| number(name, Part::Inertia(k), if x.abs() < 1e-14 * size { 0.0 } else { x });
            let I = mozzi::Sym3 {
                xx: entry(0, I.xx)?,
                xy: entry(1, I.xy)?,
                xz: entry(2, I.xz)?,
                yy: entry(3, I.yy)?,
                yz: entry(4, I.yz)?,
                zz: entry(5, I.zz)?,
            };
            new.inertia = SpatialInertia::new(number(name, Part::Mass, G.mass)?, center, I);
        }
        Ok(read)
    }

    /// One number of the file.
    fn number(&mut self, at: At, text: &str) -> Option<Symbol> {
        let value = Rational::decimal(text)?;
        if value.is_zero() {
            return Some(value.into());
        }
        let Symbols { masses, lengths, inertias, gravity, joints } = self.symbols;
        let axis = |k: usize, several: bool| if several { AXES[k] } else { "" };
        let join = |a: &str, b: &str| [a, b].into_iter().filter(|x| !x.is_empty()).collect::<Vec<_>>().join(",");
        let several = |is_joint: bool| self.coordinates.get(&(at.name.to_string(), is_joint)).is_some_and(|n| *n > 1);
        let of_joint = |letter: &'static str| {
            joints.then(|| (Name::new(letter, self.joints.get(at.name).copied(), ""), Class::Joint))
        };
        let body = |letter: &'static str, part: &str| {
            Name::new(letter, self.carrier[at.name], join(&self.bodies[at.name], part))
        };
        let (found, unit) = match at.part {
            Part::Angle(_) | Part::InertiaAngle(_) | Part::Offset => return Some(self.angle(at, text, value)),
            Part::Origin(k) => {
                let (number, part) = &self.lengths[at.name];
                let name = || Name::new("L", *number, join(part, axis(k, several(true))));
                (lengths.then(|| (name(), Class::Length)), "m")
            }
            Part::Center(k) => (lengths.then(|| (body("r", axis(k, several(false))), Class::Length)), "m"),
            Part::Mass => (masses.then(|| (body("m", ""), Class::Inertia)), "kg"),
            Part::Inertia(k) => (inertias.then(|| (body("I", PAIRS[k]), Class::Inertia)), "kg m²"),
            Part::Gravity(k) => {
                let part = axis(k, !self.is_gravity_along_axis);
                (gravity.then(|| (Name::new("g", None, part), Class::Gravity)), "m/s²")
            }
            Part::Damping => (of_joint("d"), "N m s/rad or N s/m"),
            Part::Friction => (of_joint("μ"), "N m or N"),
            Part::Stiffness => (of_joint("k"), "N m/rad or N/m"),
            Part::SpringReference => (of_joint("φ"), "rad or m"),
            Part::Axis(_) | Part::Ratio => (None, ""),
        };
        let Some((name, class)) = found else { return Some(value.into()) };
        let is_on_fixed_base =
            name.number == Some(0) && matches!(at.part, Part::Center(_) | Part::Mass | Part::Inertia(_));
        if is_on_fixed_base {
            return Some(value.into()); // it does not move, or is a floating base's own
        }
        Some(self.symbol(at, name, class, value, unit))
    }

    fn symbol(&mut self, at: At, name: Name, class: Class, value: Rational, unit: &'static str) -> Symbol {
        let (size, is_negative) = (value.abs(), value.is_negative());
        let place = format!("{} {}", printable(at.name), describe(at.part));
        let place = self.offsets.describe(at).unwrap_or(place);
        let is_equal = |known: &&mut Meaning| {
            let is_near = match self.equal {
                Equal::Separate => known.places.contains(&place), // one number of two readings
                Equal::OfLink => known.name.number == name.number,
                Equal::OfRobot => true,
            };
            is_near && known.value == size && known.unit == unit
        };
        let id = match self.legend.iter_mut().find(is_equal) {
            Some(known) => {
                if !known.places.contains(&place) {
                    known.places.push(place);
                }
                known.id
            }
            None => {
                let mut name = name;
                while !self.taken.insert(plain_name(&name)) {
                    name.part.push('\'');
                }
                let atom = Atom::Parameter { name: name.clone(), class, value: size.clone() };
                let id = with_table(|table| table.id(atom));
                self.legend.push(Meaning { name, class, value: size, unit, places: vec![place], id });
                id
            }
        };
        let symbol = Symbol::atom(id);
        if is_negative { -symbol } else { symbol }
    }

    /// An angle: a multiple of π/12 if the decimals are those of one, else the number.
    fn angle(&mut self, at: At, text: &str, value: Rational) -> Symbol {
        let digits = text.split(['e', 'E']).next().and_then(|text| text.split_once('.')).map_or(0, |(_, f)| f.len());
        let x = value.to_f64();
        let twelfths = (x / std::f64::consts::PI * 12.0).round();
        let error = (x - twelfths * std::f64::consts::PI / 12.0).abs();
        if twelfths == 0.0
            || digits < 4
            || error > 1.01 * 10.0_f64.powi(-(digits.min(15) as i32))
            || twelfths.abs() > 1e6
        {
            return value.into();
        }
        let multiple = Rational::new(twelfths as i64, 12);
        let written = (format!("{} {} {text}", at.name, describe(at.part)), multiple.clone());
        if !self.angles.contains(&written) {
            self.angles.push(written);
            self.angle_error += error;
        }
        let pi = with_table(|table| table.id(Atom::Pi));
        Symbol::atom(pi) * multiple.into()
    }
}

fn describe(part: Part) -> String {
    match part {
        Part::Origin(k) => format!("origin {}", AXES[k]),
        Part::Angle(k) => format!("origin {}", ["roll", "pitch", "yaw"][k]),
        Part::Axis(k) => format!("axis {}", AXES[k]),
        Part::Mass => "mass".into(),
        Part::Center(k) => format!("centre of mass {}", AXES[k]),
        Part::InertiaAngle(k) => format!("inertial {}", ["roll", "pitch", "yaw"][k]),
        Part::Inertia(k) => format!("i{}", PAIRS[k]),
        Part::Damping => "damping".into(),
        Part::Friction => "friction".into(),
        Part::Stiffness => "spring stiffness".into(),
        Part::SpringReference => "spring reference".into(),
        Part::Ratio => "mimic ratio".into(),
        Part::Offset => "mimic offset".into(),
        Part::Gravity(k) => AXES[k].into(),
    }
}

/// The shortest decimals of a number, without rounding errors of rotations.
fn nearest_decimal(x: f64) -> Symbol {
    let near = [0.0, 1.0, -1.0].into_iter().find(|y| (x - y).abs() < 1e-15).unwrap_or(x);
    Rational::decimal(&format!("{near}")).unwrap_or(Rational::ZERO).into()
}

/// Axes of these directions by numbers of length 1.
fn with_exact_axes(read: &mut Description<Symbol>, robot: &Description, is_such: impl Fn([f64; 3]) -> bool) {
    for (new, joint) in read.joints.iter_mut().zip(&robot.joints) {
        let JointKind::Screw(A) = joint.kind else { continue };
        let direction = if A.is_prismatic() { A.twist().v } else { A.twist().w };
        if let Some(axis) = exact_axis(A).filter(|_| is_such(direction.0)) {
            new.kind = JointKind::Screw(axis);
        }
    }
}

fn fifteen_digits(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}

/// Whether a robot has joints that the axes of which are screws with a pitch.
pub(crate) fn is_turning(kind: JointKind) -> bool {
    matches!(kind, JointKind::Screw(A) if !A.is_prismatic())
}
