//! `<equality>` and the tendons that it ties: mimic joints, the travel of helical joints, and constraints.
//!
//! A point or a weld is between two sites. A hinge becomes two points of its axis. A sum of joints is a fixed tendon.

use super::{numbers, travel};
use crate::urdf::write::escaped;
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind, Gear, JointKind};
use mozzi::{Description, SE3};
use std::fmt::{self, Write};

/// Along the axis of a hinge, m: where its second point is.
const ALONG: f64 = 0.1;

/// A frame of a link, or of the world, that is written as a site.
pub(super) struct Site<'d> {
    /// None is the world.
    pub link: Option<&'d str>,
    pub name: String,
    pub T: SE3,
}

/// Two sites whose origins, or which, coincide.
struct Tie<'d> {
    element: &'static str,
    name: String,
    sites: [Site<'d>; 2],
}

/// The sites of constraints, without those that are frames of the robot.
pub(super) fn sites(d: &Description) -> Vec<Site<'_>> {
    let is_new = |site: &Site| d.frames.iter().all(|frame| frame.name != site.name);
    d.constraints.iter().flat_map(|one| ties(d, one)).flat_map(|tie| tie.sites).filter(is_new).collect()
}

fn ties<'d>(d: &'d Description, constraint: &'d Constraint) -> Vec<Tie<'d>> {
    let ConstraintKind::Frames { a, b, closure } = &constraint.kind else { return Vec::new() };
    let tie = |element: &'static str, name: String, along: f64| {
        let site = |anchor: &'d Anchor, end: &str| {
            let (link, T) = placed(d, anchor);
            let is_frame = along == 0.0 && anchor.T == SE3::identity();
            let frame = d.frames.iter().find(|frame| is_frame && Some(&frame.name) == anchor.frame.as_ref());
            let name = frame.map_or_else(|| format!("{name}.{end}"), |frame| frame.name.clone());
            Site { link, name, T: T * SE3::translation([0.0, 0.0, along]) }
        };
        let sites = [site(a, "a"), site(b, "b")];
        Tie { element, name, sites }
    };
    let name = constraint.name.clone();
    match closure {
        Closure::Point => vec![tie("connect", name, 0.0)],
        Closure::Weld => vec![tie("weld", name, 0.0)],
        Closure::Hinge => vec![tie("connect", name.clone(), 0.0), tie("connect", format!("{name}.axis"), ALONG)],
        Closure::Distance(_) | Closure::Rolling(_) => Vec::new(),
    }
}

/// The link of an anchor, None for the world, and its pose there.
fn placed<'d>(d: &'d Description, anchor: &'d Anchor) -> (Option<&'d str>, SE3) {
    let frame = d.frames.iter().find(|frame| Some(&frame.name) == anchor.frame.as_ref());
    match frame {
        Some(frame) => (Some(&frame.link), frame.T * anchor.T),
        None => (anchor.frame.as_deref(), anchor.T),
    }
}

/// The part of a constraint that MJCF cannot express.
pub(super) fn loss(constraint: &Constraint) -> Option<String> {
    let name = &constraint.name;
    match &constraint.kind {
        ConstraintKind::Frames { closure: Closure::Hinge, .. } => {
            Some(format!("constraint `{name}`: a hinge, written as two points of its axis"))
        }
        ConstraintKind::Frames { closure: closure @ (Closure::Distance(_) | Closure::Rolling(_)), .. } => {
            Some(format!("constraint `{name}`: {}, which MuJoCo has not", closure.name()))
        }
        _ => None,
    }
}

/// Mimic joints, the slides of helical joints, whose travel is the pitch times the turn, and constraints.
pub(super) fn equalities(text: &mut String, d: &Description) -> fmt::Result {
    let mut lines = String::new();
    for joint in &d.joints {
        let name = escaped(&joint.name);
        if let Some(A) = travel(joint.kind) {
            let c = numbers(&[0.0, A.pitch(), 0.0, 0.0, 0.0]);
            writeln!(lines, "    <joint joint1=\"{name}.travel\" joint2=\"{name}\" polycoef=\"{c}\"/>")?;
        }
        if let Some(mimic) = joint.mimic.as_ref().filter(|_| joint.kind != JointKind::Fixed) {
            let (source, c) = (escaped(&mimic.joint), numbers(&[mimic.offset, mimic.ratio, 0.0, 0.0, 0.0]));
            writeln!(lines, "    <joint joint1=\"{name}\" joint2=\"{source}\" polycoef=\"{c}\"/>")?;
        }
    }
    for constraint in &d.constraints {
        for Tie { element, name, sites: [a, b] } in ties(d, constraint) {
            let [name, a, b] = [name, a.name, b.name].map(|name| escaped(&name));
            writeln!(lines, "    <{element} name=\"{name}\" site1=\"{a}\" site2=\"{b}\"/>")?;
        }
        if let ConstraintKind::Joint { source, polynomial: c, .. } = &constraint.kind {
            let (name, c) = (escaped(&constraint.name), numbers(c));
            write!(lines, "    <tendon name=\"{name}\" tendon1=\"{name}\"")?;
            if !source.is_empty() {
                write!(lines, " tendon2=\"{name}.source\"")?;
            }
            writeln!(lines, " polycoef=\"{c}\"/>")?;
        }
    }
    if lines.is_empty() { Ok(()) } else { write!(text, "  <equality>\n{lines}  </equality>\n") }
}

/// Rotors, and the sums of joints that constraints tie, as fixed tendons.
pub(super) fn tendons(text: &mut String, d: &Description) -> fmt::Result {
    let mut lines = String::new();
    let mut tendon = |name: &str, armature: f64, gears: &[Gear]| {
        write!(lines, "    <fixed name=\"{}\"", escaped(name))?;
        if armature != 0.0 {
            write!(lines, " armature=\"{armature:?}\"")?;
        }
        lines.push_str(">\n");
        for gear in gears {
            writeln!(lines, "      <joint joint=\"{}\" coef=\"{:?}\"/>", escaped(&gear.joint), gear.ratio)?;
        }
        lines.write_str("    </fixed>\n")
    };
    for rotor in &d.rotors {
        tendon(&rotor.name, rotor.armature, &rotor.gears)?;
    }
    for constraint in &d.constraints {
        if let ConstraintKind::Joint { joints, source, .. } = &constraint.kind {
            tendon(&constraint.name, 0.0, joints)?;
            if !source.is_empty() {
                tendon(&format!("{}.source", constraint.name), 0.0, source)?;
            }
        }
    }
    if lines.is_empty() { Ok(()) } else { write!(text, "  <tendon>\n{lines}  </tendon>\n") }
}
