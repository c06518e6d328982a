//! Writes MJCF text: a tree of bodies, without shapes, and what ties them.

mod equality;
mod keyframe;
mod losses;

use crate::text::scan::MOST_DEPTH;
use crate::urdf::write::{escaped, triple};
use crate::written::{NotWritten, Written};
use equality::Site;
use mozzi::linalg::Sym3;
use mozzi::model::description::{Joint, JointKind, Link, NamedState};
use mozzi::{Base, Description, SE3, ScrewAxis, SpatialInertia, Vec3};
use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// The MJCF text of a robot, which MuJoCo reads, too: bodies, joints, sites, mimic joints and constraints as
/// equalities, rotors as fixed tendons, named states as keys. A base link `world` is MuJoCo's own; another fixed base
/// is a body of it. Links without mass between joints become further joints of the next body, since MuJoCo refuses
/// them. A helical joint becomes a hinge and a slide that follows it.
///
/// # Errors
/// [`NotWritten`] if the robot would be another one: free joints inside the tree, control characters in names.
pub fn write(description: &Description) -> Result<Written, NotWritten> {
    let mut reasons = Vec::new();
    let d = description;
    let is_control = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    let names = (d.links.iter().map(|link| &link.name))
        .chain(d.joints.iter().map(|joint| &joint.name))
        .chain(d.constraints.iter().map(|constraint| &constraint.name))
        .chain(d.states.iter().map(|state| &state.name))
        .chain([&d.name]);
    reasons.extend(names.filter(|name| name.contains(is_control)).map(|name| format!("the name {name:?}")));
    let plan = Plan::of(d);
    for joint in d.joints.iter().filter(|joint| joint.kind == JointKind::Free) {
        if !(plan.is_world(&joint.parent) && joint.origin == SE3::identity()) {
            reasons.push(format!("joint `{}`: a free joint that does not begin at the world's origin", joint.name));
        }
    }
    if let Some(link) = d.links.iter().find(|link| link.name == "world" && !plan.is_world("world")) {
        reasons.push(format!("link `{}`, which has mass or moves", link.name));
    }
    let depth = plan.depth();
    if depth > DEEPEST {
        reasons.push(format!("{depth} bodies inside each other, expected at most {DEEPEST}"));
    }
    if !reasons.is_empty() {
        return Err(NotWritten { language: "MJCF", reasons });
    }
    let mut text = String::new();
    // writing to a String cannot fail
    let _ = mujoco(&mut text, &plan);
    Ok(Written { text, losses: losses::of(d, &plan), remarks: losses::refused_by_mujoco(d, &plan) })
}

/// Bodies inside each other that are read again: `<mujoco>`, `<worldbody>` and a body's own elements are around them.
const DEEPEST: usize = MOST_DEPTH - 3;

/// How the tree is written.
struct Plan<'d> {
    d: &'d Description,
    /// The joints on each link, in the order of the robot.
    below: BTreeMap<&'d str, Vec<&'d Joint>>,
    base: Option<&'d Link>,
    links: BTreeMap<&'d str, &'d Link>,
    /// The frames of constraints.
    sites: Vec<Site<'d>>,
}

/// One joint of a body, and its axis in the body's frame.
struct Placed<'d> {
    joint: &'d Joint,
    kind: JointKind,
}

impl<'d> Plan<'d> {
    fn of(d: &'d Description) -> Self {
        let mut below: BTreeMap<&str, Vec<&Joint>> = BTreeMap::new();
        let children: std::collections::BTreeSet<&str> = d.joints.iter().map(|joint| joint.child.as_str()).collect();
        d.joints.iter().for_each(|joint| below.entry(&joint.parent).or_default().push(joint));
        let base = d.links.iter().find(|link| !children.contains(link.name.as_str()));
        let links = d.links.iter().map(|link| (link.name.as_str(), link)).collect();
        Plan { d, below, base, links, sites: equality::sites(d) }
    }

    /// True for MuJoCo's world: a fixed, massless base named `world`.
    fn is_world(&self, link: &str) -> bool {
        let is_base = self.base.is_some_and(|base| base.name == link && base.inertia.mass == 0.0);
        link == "world" && is_base && self.d.base == Base::Fixed
    }

    /// How many bodies are inside each other.
    fn depth(&self) -> usize {
        let (mut open, mut deepest) = (Vec::from_iter(self.base.map(|base| (base.name.as_str(), 1))), 0);
        while let Some((link, depth)) = open.pop() {
            deepest = deepest.max(depth);
            open.extend(self.below.get(link).into_iter().flatten().map(|joint| (joint.child.as_str(), depth + 1)));
        }
        deepest
    }

    /// A link, and those that fixed joints attach to it.
    fn fixed_to(&self, link: &str) -> Vec<&'d Link> {
        let (mut open, mut found) = (vec![link], Vec::new());
        while let Some(link) = open.pop() {
            found.extend(self.links.get(link));
            let fixed = self.below.get(link).into_iter().flatten().filter(|joint| joint.kind == JointKind::Fixed);
            open.extend(fixed.map(|joint| joint.child.as_str()));
        }
        found
    }

    /// The joint after a link without mass and frames, which MuJoCo could not have between two joints. A ball is the
    /// last one, and a body has at most six freedoms.
    fn next(&self, joint: &Joint) -> Option<&'d Joint> {
        let next = self.after(joint)?;
        let mut freedoms = if matches!(next.kind, JointKind::Ball(_)) { 3 } else { 1 };
        let mut first = joint;
        while let Some(before) = self.d.joints.iter().find(|other| other.child == first.parent) {
            if self.after(before).is_none_or(|after| after.name != first.name) {
                break;
            }
            (first, freedoms) = (before, freedoms + 1);
        }
        (freedoms < 6).then_some(next)
    }

    fn after(&self, joint: &Joint) -> Option<&'d Joint> {
        let link = self.links.get(joint.child.as_str()).filter(|link| link.inertia == SpatialInertia::zero())?;
        let &[next] = self.below.get(link.name.as_str())?.as_slice() else { return None };
        let both = matches!((joint.kind, next.kind), (JointKind::Screw(_), JointKind::Screw(_) | JointKind::Ball(_)));
        let has_frame = self.d.frames.iter().any(|frame| frame.link == link.name)
            || self.sites.iter().any(|site| site.link == Some(&link.name));
        (both && !has_frame).then_some(next)
    }

    /// The body whose joint this is, if a joint follows it there.
    fn body_of(&self, joint: &Joint) -> Option<&'d str> {
        let mut last = self.next(joint)?;
        while let Some(next) = self.next(last) {
            last = next;
        }
        Some(&last.child)
    }
}

fn mujoco(text: &mut String, plan: &Plan) -> fmt::Result {
    let d = plan.d;
    writeln!(text, "<mujoco model=\"{}\">\n  <compiler angle=\"radian\"/>", escaped(&d.name))?;
    writeln!(text, "  <option gravity=\"{}\"/>\n  <worldbody>", triple(Vec3(d.gravity)))?;
    for site in plan.sites.iter().filter(|site| site.link.is_none()) {
        self::site(text, &site.name, site.T, 2)?;
    }
    match plan.base {
        Some(base) if plan.is_world(&base.name) => inside(text, plan, &base.name, 2)?,
        Some(base) => {
            let start = start(d).and_then(|state| state.base);
            let T = start.map_or_else(SE3::identity, |base| SE3::from_pose(base.pose));
            open(text, &base.name, T, 2)?;
            if d.base == Base::Floating {
                writeln!(text, "      <freejoint name=\"{}\"/>", escaped(&d.free_joint.name))?;
            }
            body(text, plan, base, 2)?;
        }
        None => {}
    }
    text.write_str("  </worldbody>\n")?;
    equality::tendons(text, d)?;
    equality::equalities(text, d)?;
    keyframe::keyframe(text, plan)?;
    text.write_str("</mujoco>\n")
}

/// The tags of a body up to its content.
fn open(text: &mut String, name: &str, T: SE3, depth: usize) -> fmt::Result {
    write!(text, "{}<body name=\"{}\"", "  ".repeat(depth), escaped(name))?;
    if T.p != Vec3::zero() {
        write!(text, " pos=\"{}\"", triple(T.p))?;
    }
    if T.R != SE3::identity().R {
        let (w, v) = T.R.quaternion();
        write!(text, " quat=\"{w:?} {}\"", triple(v))?;
    }
    text.write_str(">\n")
}

/// The inertia and the children of a body, and its end.
fn body(text: &mut String, plan: &Plan, link: &Link, depth: usize) -> fmt::Result {
    let indent = "  ".repeat(depth);
    let G = link.inertia;
    if G != SpatialInertia::zero() {
        let (c, I) = (G.center_of_mass(), G.about_center_of_mass());
        // in a body that does not move MuJoCo refuses moments of 0 only as a full inertia
        let inertia = match is_full(I) {
            false => format!("diaginertia=\"{}\"", numbers(&[I.xx, I.yy, I.zz])),
            true => format!("fullinertia=\"{}\"", numbers(&[I.xx, I.yy, I.zz, I.xy, I.xz, I.yz])),
        };
        writeln!(text, "{indent}  <inertial pos=\"{}\" mass=\"{:?}\" {inertia}/>", triple(c), G.mass)?;
    }
    inside(text, plan, &link.name, depth + 1)?;
    writeln!(text, "{indent}</body>")
}

/// True for an inertia that is written with its products.
fn is_full(I: Sym3) -> bool {
    [I.xy, I.xz, I.yz] != [0.0; 3]
}

/// The sites and the child bodies of a link.
fn inside(text: &mut String, plan: &Plan, link: &str, depth: usize) -> fmt::Result {
    for frame in plan.d.frames.iter().filter(|frame| frame.link == link) {
        site(text, &frame.name, frame.T, depth)?;
    }
    for of_constraint in plan.sites.iter().filter(|site| site.link == Some(link)) {
        site(text, &of_constraint.name, of_constraint.T, depth)?;
    }
    for first in plan.below.get(link).into_iter().flatten() {
        // the joints of one body, one after the other; earlier axes move to the frame of the last
        let (mut row, mut T) = (vec![Placed { joint: first, kind: first.kind }], first.origin);
        while let Some(next) = plan.next(row[row.len() - 1].joint) {
            let back = next.origin.inverse();
            for placed in &mut row {
                if let JointKind::Screw(A) = placed.kind {
                    placed.kind = JointKind::Screw(if next.origin == SE3::identity() { A } else { A.moved(back) });
                }
            }
            T = T * next.origin;
            row.push(Placed { joint: next, kind: next.kind });
        }
        let last = row[row.len() - 1].joint;
        let Some(child) = plan.links.get(last.child.as_str()) else { continue };
        let start = if last.kind == JointKind::Free { start_of(plan.d, &last.name) } else { T };
        open(text, &child.name, start, depth)?;
        for placed in &row {
            joint(text, placed, depth + 1)?;
        }
        body(text, plan, child, depth)?;
    }
    Ok(())
}

fn site(text: &mut String, name: &str, T: SE3, depth: usize) -> fmt::Result {
    let (indent, name, (w, v)) = ("  ".repeat(depth), escaped(name), T.R.quaternion());
    writeln!(text, "{indent}<site name=\"{name}\" pos=\"{}\" quat=\"{w:?} {}\"/>", triple(T.p), triple(v))
}

/// Numbers of an attribute.
fn numbers(list: &[f64]) -> String {
    list.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(" ")
}

/// The state in which the robot starts.
fn start(d: &Description) -> Option<&NamedState> {
    d.states.iter().find(|state| Some(&state.name) == d.start.as_ref())
}

/// The pose of a free joint in the state in which the robot starts.
fn start_of(d: &Description, joint: &str) -> SE3 {
    let found = start(d).and_then(|state| state.joints.iter().find(|one| one.name == joint));
    let pose: Option<[f64; 7]> = found.and_then(|one| one.positions.as_slice().try_into().ok());
    pose.map_or_else(SE3::identity, SE3::from_pose)
}

fn joint(text: &mut String, placed: &Placed, depth: usize) -> fmt::Result {
    let (joint, indent) = (placed.joint, "  ".repeat(depth));
    let name = escaped(&joint.name);
    match placed.kind {
        JointKind::Fixed => return Ok(()),
        JointKind::Free => write!(text, "{indent}<joint name=\"{name}\" type=\"free\"")?,
        JointKind::Ball(center) => {
            write!(text, "{indent}<joint name=\"{name}\" type=\"ball\" pos=\"{}\"", triple(center))?
        }
        JointKind::Screw(A) if A.is_prismatic() => {
            write!(text, "{indent}<joint name=\"{name}\" type=\"slide\" axis=\"{}\"", triple(A.twist().v))?;
        }
        JointKind::Screw(A) => {
            let (w, v) = (A.twist().w, A.twist().v);
            write!(text, "{indent}<joint name=\"{name}\" axis=\"{}\" pos=\"{}\"", triple(w), triple(w.cross(v)))?;
        }
    }
    if let Some([low, high]) = joint.limits.position {
        write!(text, " range=\"{low:?} {high:?}\"")?;
    }
    if let Some(effort) = joint.limits.effort.filter(|effort| *effort > 0.0) {
        write!(text, " actuatorfrcrange=\"{:?} {effort:?}\"", -effort)?;
    }
    for (word, x) in [
        ("damping", joint.damping),
        ("frictionloss", joint.friction),
        ("armature", joint.armature),
        ("stiffness", joint.stiffness),
        ("springref", joint.spring_reference),
    ] {
        if x != 0.0 {
            write!(text, " {word}=\"{x:?}\"")?;
        }
    }
    text.write_str("/>\n")?;
    match travel(placed.kind) {
        Some(A) => {
            writeln!(text, "{indent}<joint name=\"{name}.travel\" type=\"slide\" axis=\"{}\"/>", triple(A.twist().w))
        }
        None => Ok(()),
    }
}

/// The axis of a helical joint.
fn travel(kind: JointKind) -> Option<ScrewAxis> {
    match kind {
        JointKind::Screw(A) if kind.name() == "helical" => Some(A),
        _ => None,
    }
}
