//! Causes of a difference between two libraries, and the same change made in mozzi.

use crate::compare::Result;
use crate::compare::answer::{Answer, Robot};
use crate::compare::bodies::{BodyChange, Reason};
use crate::compare::constants::{Constants, JointConstants, home};
use crate::compare::numbers::Side;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, ScrewAxis, SpatialInertia};

/// A joint's number on both sides.
#[derive(Clone, Debug)]
pub struct Change {
    pub joint: String,
    pub mozzi: f64,
    pub theirs: f64,
}

/// A mimic joint that is independent in the library.
#[derive(Clone, Debug)]
pub struct Freed {
    pub joint: String,
    pub source: String,
    /// The library couples it to its source joint by the force of a constraint.
    pub constrained: bool,
}

#[derive(Clone, Debug)]
pub enum Cause {
    Mimics(Vec<Freed>),
    /// These joints do not move in the library.
    Held(Vec<String>),
    Gravity {
        mozzi: [f64; 3],
        theirs: [f64; 3],
    },
    Armature(Vec<Change>),
    Damping(Vec<Change>),
    Friction(Vec<Change>),
    Stiffness(Vec<Change>),
    /// The forces of these constraints, which the library's τ contains.
    Constraints(Vec<String>),
    /// A force that the library's τ contains.
    Force(String),
    Bodies(Reason, Vec<BodyChange>),
    /// These joints have other axes in the library.
    Axes(Vec<(String, [f64; 6])>),
}

impl Cause {
    /// True if the cause is known, false if only the place of the difference is known.
    pub fn is_explanation(&self) -> bool {
        !matches!(self, Cause::Axes(_) | Cause::Bodies(Reason::Unknown, _))
    }

    /// Applies the library's behaviour to mozzi's description, and subtracts forces that mozzi does not compute from
    /// the library's results.
    pub fn apply(&self, robot: &mut Description, theirs: &mut Side, from: &Robot) -> Result<()> {
        let mut each = |changes: &[Change], set: fn(&mut Joint, f64)| {
            for change in changes {
                joints(robot, &change.joint).for_each(|joint| set(joint, change.theirs));
            }
        };
        match self {
            Cause::Armature(changes) => each(changes, |joint, value| joint.armature = value),
            Cause::Damping(changes) => each(changes, |joint, value| joint.damping = value),
            Cause::Friction(changes) => each(changes, |joint, value| joint.friction = value),
            Cause::Stiffness(changes) => each(changes, |joint, value| joint.stiffness = value),
            Cause::Mimics(list) => {
                list.iter().for_each(|freed| joints(robot, &freed.joint).for_each(|joint| joint.mimic = None));
            }
            Cause::Held(list) => {
                // they contain joints that are fixed from here on, and are not compared
                (robot.states, robot.start) = (Vec::new(), None);
                robot.constraints.clear();
                for joint in &mut robot.joints {
                    if list.contains(&joint.name) {
                        joint.kind = JointKind::Fixed;
                    }
                    if list.contains(&joint.name) || joint.mimic.as_ref().is_some_and(|m| list.contains(&m.joint)) {
                        joint.mimic = None;
                    }
                }
            }
            Cause::Gravity { theirs, .. } => robot.gravity = *theirs,
            // must come before other forces are subtracted: the causes are in this order
            Cause::Constraints(_) => {
                for (state, tau) in theirs.states.iter_mut().zip(&from.unconstrained) {
                    state.tau.copy_from(tau);
                }
            }
            Cause::Force(name) => {
                if name == "spring" {
                    robot.joints.iter_mut().for_each(|joint| joint.stiffness = 0.0); // in the force, too
                }
                for (state, force) in theirs.states.iter_mut().zip(from.forces.get(name).into_iter().flatten()) {
                    state.tau += force; // the library's inverse dynamics is less by this force
                }
            }
            Cause::Bodies(_, changes) => {
                let home = home(robot)?;
                for change in changes {
                    for (k, name) in change.links.iter().enumerate() {
                        let whole = change.theirs.transformed(home[name].inverse());
                        let inertia = if k == 0 { whole } else { SpatialInertia::zero() };
                        robot
                            .links
                            .iter_mut()
                            .filter(|link| link.name == *name)
                            .for_each(|link| link.inertia = inertia);
                    }
                }
            }
            Cause::Axes(changes) => {
                let home = home(robot)?;
                for (name, axis) in changes {
                    let Ok(S) = ScrewAxis::from_array(*axis) else { continue };
                    for joint in joints(robot, name) {
                        joint.kind = JointKind::Screw(S.transformed(home[&joint.child].inverse()));
                    }
                }
            }
        }
        Ok(())
    }
}

fn joints<'r>(robot: &'r mut Description, name: &str) -> impl Iterator<Item = &'r mut Joint> {
    robot.joints.iter_mut().filter(move |joint| joint.name == name)
}

/// Every cause that the two sides' constants suggest; each is tested afterwards. `coupled`: the library was called with
/// coupled mimic joints.
pub fn suspects(robot: &Description, answer: &Answer, from: &Robot, coupled: bool) -> Result<Vec<Cause>> {
    let (theirs, mut causes) = (&from.constants, Vec::new());
    let mine = Constants::of(robot)?;
    let there = |name: &str| {
        let nv = mine.joint(name).map(|joint| joint.nv);
        nv.is_some() && theirs.joint(name).map(|joint| joint.nv) == nv
    };
    let mimic = |name: &str| robot.joints.iter().find(|joint| joint.name == name)?.mimic.as_ref();

    let held: Vec<String> = (mine.joints.iter())
        .filter(|joint| !(there(&joint.name) || coupled && mimic(&joint.name).is_some()))
        .map(|joint| joint.name.clone())
        .collect();
    let mut robot = robot.clone();
    if !held.is_empty() {
        let cause = Cause::Held(held);
        cause.apply(&mut robot, &mut from.side.clone(), from)?;
        causes.push(cause);
    }
    let mine = Constants::of(&robot)?; // the bodies of fixed joints are merged into their parent bodies
    let freed = |joint: &Joint| {
        let source = joint.mimic.as_ref()?.joint.clone();
        let constrained = from.couplings.iter().any(|(mimic_joint, _)| *mimic_joint == joint.name);
        there(&joint.name).then(|| Freed { joint: joint.name.clone(), source, constrained })
    };
    let freed: Vec<Freed> = robot.joints.iter().filter_map(freed).collect();
    if !freed.is_empty() {
        causes.push(Cause::Mimics(freed));
    }
    let apart = |a: f64, b: f64| (a - b).abs() > 1e-12 * a.abs().max(b.abs());
    if (0..3).any(|k| apart(mine.gravity[k], theirs.gravity[k])) {
        causes.push(Cause::Gravity { mozzi: mine.gravity, theirs: theirs.gravity });
    }

    let pairs: Vec<_> = mine.joints.iter().filter_map(|joint| Some((joint, theirs.joint(&joint.name)?))).collect();
    type Number = fn(&JointConstants) -> f64;
    let changes = |pick: Number, ignored: bool| -> Vec<Change> {
        let change = |joint: &JointConstants| {
            // a mimic joint that the library couples has no numbers of its own; a term that τ omits is omitted for all
            // joints
            let theirs = if ignored { 0.0 } else { pick(theirs.joint(&joint.name)?) };
            let mozzi = pick(joint);
            apart(mozzi, theirs).then(|| Change { joint: joint.name.clone(), mozzi, theirs })
        };
        mine.joints.iter().filter_map(change).collect()
    };
    // Pinocchio stores damping and friction but omits them from its inverse dynamics, and has no springs; MuJoCo models
    // dry friction as a constraint. A library that reports no spring forces, such as MuJoCo of a URDF, has no springs
    let pinocchio = answer.library == "Pinocchio";
    type Make = fn(Vec<Change>) -> Cause;
    let has_springs = from.forces.contains_key("spring");
    let stiffness = if has_springs { Vec::new() } else { changes(|joint| joint.stiffness, true) };
    let lists: [(Make, Vec<Change>); 4] = [
        (Cause::Armature, changes(|joint| joint.armature, false)),
        (Cause::Damping, changes(|joint| joint.damping, pinocchio)),
        (Cause::Friction, changes(|joint| joint.friction, true)),
        (Cause::Stiffness, stiffness),
    ];
    causes.extend(lists.into_iter().filter(|(_, list)| !list.is_empty()).map(|(cause, list)| cause(list)));
    if !from.constraints.is_empty() {
        causes.push(Cause::Constraints(from.constraints.iter().cloned().collect()));
    }
    causes.extend(from.forces.keys().map(|name| Cause::Force(name.clone())));

    let turned = |(a, b): &(&JointConstants, &JointConstants)| {
        let ([a], [b]) = (&a.axes[..], &b.axes[..]) else { return None };
        let far = a.iter().zip(b).any(|(x, y)| (x - y).abs() > 1e-9 * (1.0 + x.abs()));
        far.then_some(*b)
    };
    let axes: Vec<_> = pairs.iter().filter_map(|pair| Some((pair.0.name.clone(), turned(pair)?))).collect();
    if !axes.is_empty() {
        causes.push(Cause::Axes(axes));
    }
    causes.extend(crate::compare::bodies::suspects(&robot, answer, from)?);
    Ok(causes)
}
