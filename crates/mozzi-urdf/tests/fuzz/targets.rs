//! Properties that hold for any input. `fuzz/` runs these under cargo-fuzz, `tests/fuzz` under a plain driver.

use mozzi::model::description::{Joint, JointKind, Limits, Mimic};
use mozzi::{Description, Model, SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Twist, Vec3};
use mozzi_urdf::{LoadError, Policy, Style, parse, parse_with, write};
use std::cell::Cell;

/// Any bytes give a robot whose model is finite, or are refused with places inside the text.
pub fn urdf(bytes: &[u8]) {
    text("fuzz.urdf", bytes);
}

/// The same for MuJoCo's models: bytes without a `<mujoco` are read inside a body.
pub fn mjcf(bytes: &[u8]) {
    if bytes.windows(7).any(|word| word == b"<mujoco") {
        text("fuzz.xml", bytes);
    } else {
        let start: &[u8] = b"<mujoco><worldbody><body name='b'>";
        text("fuzz.xml", &[start, bytes, b"</body></worldbody></mujoco>"].concat());
    }
}

fn text(name: &str, bytes: &[u8]) {
    for policy in [Policy::Strict, Policy::Default, Policy::Lenient] {
        match parse_with(name, bytes, policy) {
            Ok(robot) => {
                let warnings = robot.warnings.iter().map(|warning| warning.pretty(Style::Ascii));
                assert!(warnings.take(3).all(|text| !text.is_empty()));
                // the written text is read back as the same robot
                if let Ok(text) = write(&robot.description) {
                    let again = parse("again.urdf", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
                    assert_eq!(again.description.links.len(), robot.description.links.len());
                }
                match robot.build() {
                    Ok(model) => finite(&model),
                    Err(error) => panic!("read, but not built: {error}"),
                }
            }
            Err(LoadError::Refused { diagnostics, .. }) => {
                let text = diagnostics.first().map(|first| first.pretty(Style::Ascii));
                assert!(text.is_some_and(|text| !text.is_empty()), "refused for no reason");
                assert!(diagnostics.iter().all(|d| d.line() >= 1 && d.column() >= 1 && d.help().is_some()));
                assert!(diagnostics.iter().all(|d| d.excerpt().len() <= bytes.len()));
            }
            Err(other) => panic!("{other}"),
        }
    }
}

/// Any description gives a finite model, or is refused.
pub fn description(bytes: &[u8]) {
    let robot = Reader { bytes }.description();
    let problems = robot.check();
    assert!(problems.iter().all(|problem| !problem.to_string().is_empty()));
    if let Ok(model) = robot.build() {
        finite(&model);
        let theta = vec![0.25; model.nq()];
        let _ = (model.screws(), model.mass_matrix(&theta), model.folded_links());
    }
}

/// Every constant of the model.
fn finite(model: &Model) {
    let is_finite = Cell::new(true);
    model.map(|c: f64| {
        is_finite.set(is_finite.get() && c.is_finite());
        c
    });
    assert!(is_finite.get(), "not finite: {:?}", model.description());
}

/// Makes a description from bytes; zeros after their end.
struct Reader<'b> {
    bytes: &'b [u8],
}

impl Reader<'_> {
    fn byte(&mut self) -> u8 {
        let (first, rest) = self.bytes.split_first().map_or((0, self.bytes), |(first, rest)| (*first, rest));
        self.bytes = rest;
        first
    }

    fn below(&mut self, n: u8) -> u8 {
        self.byte() % n
    }

    /// Mostly harmless, sometimes arbitrary bits.
    fn number(&mut self) -> f64 {
        const NUMBERS: [f64; 24] = [
            0.0,
            1.0,
            -1.0,
            0.5,
            -0.25,
            2.0,
            90.0,
            1e3,
            1e-3,
            -0.0,
            1e-9,
            1e-300,
            5e-324,
            1e150,
            1e154,
            1e200,
            1e300,
            -1e300,
            f64::MAX,
            f64::MIN_POSITIVE,
            f64::EPSILON,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ];
        match self.byte() {
            k @ 0..=159 => NUMBERS[usize::from(k) % 11],
            k @ 160..=199 => NUMBERS[usize::from(k) % 24],
            200..=227 => f64::from(self.byte() as i8) / 16.0,
            _ => f64::from_bits(u64::from_le_bytes(std::array::from_fn(|_| self.byte()))),
        }
    }

    fn vector(&mut self) -> Vec3 {
        Vec3(std::array::from_fn(|_| self.number()))
    }

    fn size(&mut self) -> f64 {
        let x = self.number();
        if self.below(16) == 0 { x } else { x.abs() }
    }

    fn frame(&mut self) -> SE3 {
        let rotation = match self.below(4) {
            0 => SO3::exp(self.vector()),
            1 => SO3::from_rpy(self.number(), self.number(), self.number()),
            _ => SO3::identity(),
        };
        SE3::new(rotation, self.vector())
    }

    fn inertia(&mut self) -> SpatialInertia {
        let [xx, yy, zz] = [self.size(), self.size(), self.size()];
        let [xy, xz, yz] = if self.below(4) == 0 { self.vector().0 } else { [0.0; 3] };
        let I = Sym3 { xx, xy, xz, yy, yz, zz };
        match self.below(4) {
            0 => SpatialInertia { mass: self.number(), mc: self.vector(), I },
            1 => SpatialInertia::zero(),
            _ => SpatialInertia::new(self.size(), self.vector(), I),
        }
    }

    fn name(&mut self, kind: &str, k: u8) -> String {
        match self.byte() {
            0 => String::new(),
            1 => format!("{kind}{}", self.byte()),
            _ => format!("{kind}{k}"),
        }
    }

    fn kind(&mut self) -> JointKind {
        let twist = Twist { w: self.vector(), v: self.vector() };
        match (self.below(6), ScrewAxis::normalize(twist)) {
            (0, _) => JointKind::Fixed,
            (1, Ok((screw, _))) => JointKind::Screw(screw),
            (2, _) => JointKind::Screw(ScrewAxis::prismatic([0.0, 0.0, 1.0]).expect("unit")),
            (k, _) => {
                let axis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]][usize::from(k) % 3];
                JointKind::Screw(ScrewAxis::from_line(axis, [0.0; 3], 0.0).expect("unit"))
            }
        }
    }

    fn description(&mut self) -> Description {
        let mut robot = Description::new("fuzz");
        let links = self.below(7);
        for k in 0..=links {
            let (name, inertia) = (self.name("l", k), self.inertia());
            robot = robot.link(name, inertia);
        }
        for k in 1..=links {
            // mostly a tree
            let parent = if self.byte() < 8 { self.below(8) } else { self.below(k) };
            let child = if self.byte() < 8 { self.below(8) } else { k };
            let (parent, child) = (self.name("l", parent), self.name("l", child));
            let (name, origin, kind) = (self.name("j", k), self.frame(), self.kind());
            let mut joint = Joint::new(name, parent, child, origin, kind);
            if self.below(3) == 0 {
                [joint.damping, joint.friction, joint.armature] = [self.size(), self.size(), self.size()];
                [joint.stiffness, joint.spring_reference] = [self.size(), self.size()];
            }
            if self.below(3) == 0 {
                let (a, b) = (self.number(), self.number());
                let position = Some(if self.below(8) == 0 { [a, b] } else { [a.min(b), a.max(b)] });
                joint.limits =
                    Limits { position, velocity: Some(self.size()), effort: Some(self.size()), ..Limits::default() };
            }
            if self.below(4) == 0 {
                let source = self.below(8);
                joint.mimic =
                    Some(Mimic { joint: self.name("j", source), ratio: self.number(), offset: self.number() });
            }
            robot = robot.joint(joint);
        }
        for k in 0..self.below(3) {
            let (name, on, T) = (self.name("f", k), self.below(8), self.frame());
            let link = self.name("l", on);
            robot = robot.frame(name, link, T);
        }
        if self.below(4) == 0 {
            let k = self.below(3);
            robot.end_effector = Some(self.name("f", k));
        }
        if self.below(8) == 0 {
            robot.gravity = self.vector().0;
        }
        robot
    }
}
