//! Writes URDF text.

use crate::text::xacro::has_expression;
use crate::urdf::floating::frees_the_base;
use crate::urdf::inertial::element;
use crate::urdf::limit::UNLIMITED;
use crate::written::of_free_joint;
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind, Joint, JointKind, Limits, Link};
use mozzi::{Base, Description, SE3, ScrewAxis, SpatialInertia, Vec3};
use std::fmt::{self, Write};

/// The parts of a description that URDF cannot express.
#[derive(Clone, Debug, PartialEq)]
pub struct NotUrdf {
    /// Each with its element: "joint `a`: a helical joint".
    pub reasons: Vec<String>,
}

impl fmt::Display for NotUrdf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "URDF cannot express {}", self.reasons.join(", nor "))
    }
}

impl std::error::Error for NotUrdf {}

/// The URDF text of a robot, which urdfdom reads, too. A round trip gives the same description up to rounding (inertias
/// are converted to the centre of mass, orientations to roll, pitch and yaw), without the named states and the start,
/// which URDF cannot express.
///
/// Springs and armature are attributes of `<dynamics>` that other readers ignore. urdfdom requires limits of effort and
/// velocity, and bounds of prismatic joints: limits that do not exist are written as 1.7976931348623157e308.
///
/// # Errors
/// [`NotUrdf`] with everything that would be lost: balls, helical joints, axes that miss the child's frame, rotors of
/// several joints, further frames, constraints, a list of motors, a named end effector, gravity other than (0, 0,
/// −9.81), control characters in names, names that xacro would evaluate. [`expressible`](crate::expressible)
/// replaces most of them. A constraint that was a `<drake:ball_constraint>` is written as one.
pub fn write(description: &Description) -> Result<String, NotUrdf> {
    let reasons = not_urdf(description);
    if !reasons.is_empty() {
        return Err(NotUrdf { reasons });
    }
    let mut text = String::new();
    // writing to a String cannot fail
    let _ = robot(&mut text, description);
    Ok(text)
}

fn not_urdf(d: &Description) -> Vec<String> {
    let mut reasons = Vec::new();
    for (i, joint) in d.joints.iter().enumerate() {
        let name = &joint.name;
        match joint.kind {
            JointKind::Screw(A) if !A.is_prismatic() && A.twist().v != Vec3::zero() => {
                reasons.push(match joint.kind.name() {
                    "helical" => format!("joint `{name}`: a helical joint"),
                    _ => format!("joint `{name}`: an axis that misses the child's frame"),
                });
            }
            JointKind::Ball(_) => reasons.push(format!("joint `{name}`: a ball")),
            JointKind::Free if d.base == Base::Fixed && frees_the_base(i, d) => {
                reasons.push(format!(
                    "joint `{name}`: a free joint on an empty base, which would be read as a floating base"
                ));
            }
            JointKind::Free => reasons.extend(of_free_joint(joint)),
            _ => {}
        }
    }
    let names = d.links.iter().map(|link| &link.name).chain(d.joints.iter().map(|joint| &joint.name)).chain([
        &d.name,
        &d.free_joint.name,
        &d.free_joint.parent,
    ]);
    let is_control =
        |c: char| c.is_control() && !matches!(c, '\t' | '\n' | '\r') || matches!(c, '\u{fffe}' | '\u{ffff}');
    let is_lost = |name: &&String| name.contains(is_control) || has_expression(name); // xacro would evaluate it
    reasons.extend(names.filter(is_lost).map(|name| format!("the name {name:?}")));
    reasons.extend(d.frames.iter().map(|frame| format!("frame `{}`", frame.name)));
    reasons.extend(d.rotors.iter().map(|rotor| format!("rotor `{}`", rotor.name)));
    reasons.extend(constraint_losses(d));
    if d.motors.is_some() {
        reasons.push("the list of motors".to_string());
    }
    reasons.extend(d.end_effector.iter().map(|name| format!("the end effector `{name}`")));
    if d.gravity != [0.0, 0.0, -9.81] {
        reasons.push(format!("gravity {:?}", d.gravity));
    }
    reasons
}

fn robot(text: &mut String, d: &Description) -> fmt::Result {
    let drake = if d.constraints.is_empty() { "" } else { " xmlns:drake=\"https://drake.mit.edu\"" };
    // limits of acceleration are URDF's from version 1.2 on
    let is_later = d.joints.iter().any(|joint| joint.limits.acceleration.is_some());
    let version = if is_later { " version=\"1.2\"" } else { "" };
    writeln!(text, "<?xml version=\"1.0\"?>\n<robot name=\"{}\"{version}{drake}>", escaped(&d.name))?;
    // the parent of a floating base is an empty link
    let taken = |name: &str| d.links.iter().any(|link| link.name == name);
    let space = free(&d.free_joint.parent, taken);
    if d.base == Base::Floating {
        writeln!(text, "  <link name=\"{}\"/>", escaped(&space))?;
    }
    for each in &d.links {
        link(text, each)?;
    }
    if d.base == Base::Floating {
        let name = free(&d.free_joint.name, |name| d.joints.iter().any(|joint| joint.name == name));
        let is_base = |link: &&Link| !d.joints.iter().any(|joint| joint.child == link.name);
        let base = d.links.iter().find(is_base).map_or("", |link| &link.name);
        writeln!(text, "  <joint name=\"{}\" type=\"floating\">", escaped(&name))?;
        writeln!(
            text,
            "    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n  </joint>",
            escaped(&space),
            escaped(base)
        )?;
    }
    for each in &d.joints {
        joint(text, each)?;
    }
    for each in &d.constraints {
        const TAG: &str = "drake:ball_constraint";
        let Some(ends) = ball_constraint(d, each) else { continue }; // it was refused
        writeln!(text, "  <{TAG}>")?;
        for ([body, point], (link, p)) in [["A", "p_AP"], ["B", "p_BQ"]].into_iter().zip(ends) {
            writeln!(text, "    <{TAG}_body_{body} name=\"{}\"/>", escaped(link))?;
            writeln!(text, "    <{TAG}_{point} value=\"{}\"/>", triple(p))?;
        }
        writeln!(text, "  </{TAG}>")?;
    }
    text.write_str("</robot>\n")
}

/// The constraints that are lost, or whose names are: Drake's element has none.
pub(crate) fn constraint_losses(d: &Description) -> Vec<String> {
    let (mut lost, mut count) = (Vec::new(), 0);
    for each in &d.constraints {
        if ball_constraint(d, each).is_none() {
            lost.push(format!("constraint `{}`", each.name));
            continue;
        }
        if each.name != ball_name(count) {
            lost.push(format!("the name of constraint `{}`, which is read as `{}`", each.name, ball_name(count)));
        }
        count += 1;
    }
    lost
}

/// Leaves out the constraints that Drake's element cannot describe, and gives the others the names that they are read
/// by. Returns the names of the first, and old and new names of the others.
pub fn only_ball_constraints(d: &mut Description) -> (Vec<String>, Vec<[String; 2]>) {
    let all = core::mem::take(&mut d.constraints);
    let (mut dropped, mut renamed) = (Vec::new(), Vec::new());
    for mut each in all {
        if ball_constraint(d, &each).is_none() {
            dropped.push(each.name);
            continue;
        }
        let name = ball_name(d.constraints.len());
        if each.name != name {
            renamed.push([core::mem::replace(&mut each.name, name.clone()), name]);
        }
        d.constraints.push(each);
    }
    (dropped, renamed)
}

/// The name of the k-th of Drake's elements.
pub(crate) fn ball_name(k: usize) -> String {
    format!("ball_constraint{k}")
}

/// The links and points of a constraint that Drake's element describes.
pub(crate) fn ball_constraint<'d>(d: &Description, constraint: &'d Constraint) -> Option<[(&'d str, Vec3); 2]> {
    let ConstraintKind::Frames { a, b, closure: Closure::Point } = &constraint.kind else { return None };
    let end = |anchor: &'d Anchor| {
        let name = anchor.frame.as_deref()?;
        let is_link = d.links.iter().any(|link| link.name == name);
        (is_link && anchor.T.R == SE3::identity().R).then_some((name, anchor.T.p))
    };
    Some([end(a)?, end(b)?])
}

/// The name, or a similar one that is not taken.
pub(crate) fn free(name: &str, taken: impl Fn(&str) -> bool) -> String {
    let mut name = name.to_string();
    while taken(&name) {
        name.push('\'');
    }
    name
}

fn link(text: &mut String, link: &Link) -> fmt::Result {
    let (name, G) = (escaped(&link.name), link.inertia);
    if G == SpatialInertia::zero() {
        return writeln!(text, "  <link name=\"{name}\"/>");
    }
    let inertial = element(G, |x| format!("{x:?}"), "\n      ", "\n    ");
    writeln!(text, "  <link name=\"{name}\">\n    {inertial}\n  </link>")
}

fn joint(text: &mut String, joint: &Joint) -> fmt::Result {
    let is_bounded = joint.limits.position.is_some();
    let kind = match joint.kind {
        JointKind::Fixed => "fixed",
        JointKind::Screw(A) if A.is_prismatic() => "prismatic",
        JointKind::Screw(_) if is_bounded => "revolute",
        JointKind::Screw(_) => "continuous",
        JointKind::Ball(_) | JointKind::Free => "floating", // a ball was refused
    };
    writeln!(text, "  <joint name=\"{}\" type=\"{kind}\">", escaped(&joint.name))?;
    writeln!(text, "    <parent link=\"{}\"/>", escaped(&joint.parent))?;
    writeln!(text, "    <child link=\"{}\"/>", escaped(&joint.child))?;
    origin(text, "    ", joint.origin)?;
    if let JointKind::Screw(A) = joint.kind {
        writeln!(text, "    <axis xyz=\"{}\"/>", triple(direction(A)))?;
        limit(text, joint)?;
    }
    dynamics(text, joint)?;
    if let Some(mimic) = &joint.mimic {
        let (source, ratio, offset) = (escaped(&mimic.joint), mimic.ratio, mimic.offset);
        writeln!(text, "    <mimic joint=\"{source}\" multiplier=\"{ratio:?}\" offset=\"{offset:?}\"/>")?;
    }
    text.write_str("  </joint>\n")
}

/// A spring with SDF's names, the armature with MJCF's: other readers of URDF ignore both.
fn dynamics(text: &mut String, joint: &Joint) -> fmt::Result {
    let is_springy = joint.stiffness != 0.0 || joint.spring_reference != 0.0;
    if joint.damping == 0.0 && joint.friction == 0.0 && joint.armature == 0.0 && !is_springy {
        return Ok(());
    }
    write!(text, "    <dynamics damping=\"{:?}\" friction=\"{:?}\"", joint.damping, joint.friction)?;
    if is_springy {
        let (k, rest) = (joint.stiffness, joint.spring_reference);
        write!(text, " spring_stiffness=\"{k:?}\" spring_reference=\"{rest:?}\"")?;
    }
    if joint.armature != 0.0 {
        write!(text, " armature=\"{:?}\"", joint.armature)?;
    }
    text.write_str("/>\n")
}

/// Written if urdfdom requires a limit or the joint has one; urdfdom then requires effort and velocity.
fn limit(text: &mut String, joint: &Joint) -> fmt::Result {
    let Limits { position, velocity, effort, acceleration } = joint.limits;
    let has_bounds = position.is_some() || matches!(joint.kind, JointKind::Screw(A) if A.is_prismatic());
    if !has_bounds && velocity.is_none() && effort.is_none() && acceleration.is_none() {
        return Ok(());
    }
    text.write_str("    <limit")?;
    let [lower, upper] = position.unwrap_or([-UNLIMITED, UNLIMITED]);
    let bounds = [("lower", Some(lower)), ("upper", Some(upper))].into_iter().filter(|_| has_bounds);
    for (name, limit) in bounds.chain([("effort", effort), ("velocity", velocity)]) {
        write!(text, " {name}=\"{:?}\"", limit.unwrap_or(UNLIMITED).clamp(-UNLIMITED, UNLIMITED))?;
    }
    if let Some(limit) = acceleration {
        write!(text, " acceleration=\"{limit:?}\"")?;
    }
    text.write_str("/>\n")
}

/// Nothing for the identity.
fn origin(text: &mut String, indent: &str, T: SE3) -> fmt::Result {
    let mut attributes = String::new();
    if T.p != Vec3::zero() {
        write!(attributes, " xyz=\"{}\"", triple(T.p))?;
    }
    if T.R != SE3::identity().R {
        write!(attributes, " rpy=\"{}\"", triple(Vec3(T.R.to_rpy())))?;
    }
    if attributes.is_empty() { Ok(()) } else { writeln!(text, "{indent}<origin{attributes}/>") }
}

fn direction(A: ScrewAxis) -> Vec3 {
    if A.is_prismatic() { A.twist().v } else { A.twist().w }
}

pub(crate) fn triple(v: Vec3) -> String {
    let [x, y, z] = v.0;
    format!("{x:?} {y:?} {z:?}")
}

/// As an attribute's value.
pub(crate) fn escaped(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '"' => text.push_str("&quot;"),
            '\n' => text.push_str("&#10;"),
            '\r' => text.push_str("&#13;"),
            '\t' => text.push_str("&#9;"),
            c => text.push(c),
        }
    }
    text
}
