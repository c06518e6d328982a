//! The smallest robot, state and environment that still differ.

use crate::campaign::case::Case;
use mozzi::model::description::JointKind;
use mozzi::{Base, SE3, ScrewAxis, Solid};

/// Largest number of trials of a smaller case.
const MOST_TRIALS: usize = 3000;

/// Makes a case smaller as long as `differs`: fewer joints, simpler joints, no features, zeros in the state.
pub fn shrink(case: &Case, differs: impl Fn(&Case) -> bool) -> Case {
    let (mut best, mut trials) = (case.clone(), 0);
    loop {
        let mut has_shrunk = false;
        let mut k = 0;
        while let Some(smaller) = step(&best, k) {
            k += 1;
            let Some(smaller) = smaller else { continue };
            trials += 1;
            if trials > MOST_TRIALS {
                return best;
            }
            if differs(&smaller) {
                (best, has_shrunk, k) = (smaller, true, k - 1);
            }
        }
        if !has_shrunk {
            return best;
        }
    }
}

type Edit = fn(&mut Case, usize);

/// Edits of the whole case.
const OF_CASE: [Edit; 13] = [
    |case, _| case.robot.constraints.clear(),
    |case, _| case.robot.rotors.clear(),
    |case, _| case.robot.base = Base::Fixed,
    |case, _| case.applied.clear(),
    |case, _| case.base_twist = [0.0; 6],
    |case, _| case.base_acceleration = [0.0; 6],
    |case, _| case.gravity = None,
    |case, _| case.robot.gravity = [0.0, 0.0, -9.81],
    |case, _| case.robot.gravity = [0.0; 3],
    |case, _| case.point = mozzi::Vec3::zero(),
    |case, _| case.w = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    |case, _| case.rows.truncate(1),
    |case, _| case.robot.links[0].inertia = simple(),
];

/// Edits of the k-th constraint, wrench, rotor, further frame.
const OF_LISTS: [Edit; 4] = [
    |case, k| drop_at(&mut case.robot.constraints, k),
    |case, k| drop_at(&mut case.applied, k),
    |case, k| drop_at(&mut case.robot.frames, k),
    |case, k| {
        let frame = case.robot.links.get(k).map(|link| link.name.clone());
        case.frame = frame.unwrap_or_default();
    },
];

/// Edits of the k-th joint.
const OF_JOINT: [Edit; 15] = [
    remove,
    |case, k| case.robot.joints[k].kind = JointKind::Fixed,
    |case, k| case.robot.joints[k].mimic = None,
    |case, k| case.robot.joints[k].kind = turn_about_z(),
    |case, k| case.robot.joints[k].damping = 0.0,
    |case, k| case.robot.joints[k].friction = 0.0,
    |case, k| case.robot.joints[k].armature = 0.0,
    |case, k| case.robot.joints[k].stiffness = 0.0,
    |case, k| case.robot.joints[k].spring_reference = 0.0,
    |case, k| case.robot.joints[k].origin = SE3::identity(),
    |case, k| case.robot.joints[k].origin = SE3::translation([0.5, 0.0, 0.0]),
    |case, k| {
        let child = case.robot.joints[k].child.clone();
        if let Some(link) = case.robot.links.iter_mut().find(|link| link.name == child) {
            link.inertia = simple();
        }
    },
    |case, k| with_motion(case, k, |motion| (motion.angle, motion.pose) = (0.0, SE3::identity().to_pose())),
    |case, k| with_motion(case, k, |motion| motion.rates = [[0.0; 6]; 3]),
    |case, k| with_motion(case, k, |motion| motion.rates[0] = [0.0; 6]),
];

/// Edits of a motion's rates, by index.
fn motion_edit(case: &mut Case, k: usize) {
    let (which, entry) = (k / 18, k % 18);
    if let Some(motion) = case.motions.values_mut().nth(which) {
        motion.rates[entry / 6][entry % 6] = 0.0;
    }
}

/// The k-th smaller case: None beyond the last, Some(None) if the edit changes nothing.
fn step(case: &Case, k: usize) -> Option<Option<Case>> {
    let (joints, lists) = (case.robot.joints.len(), 6_usize.max(case.robot.links.len()));
    let mut smaller = case.clone();
    let of_joints = OF_JOINT.len() * joints;
    let of_lists = OF_LISTS.len() * lists;
    if k < of_joints {
        OF_JOINT[k / joints](&mut smaller, joints - 1 - k % joints);
    } else if k - of_joints < OF_CASE.len() {
        OF_CASE[k - of_joints](&mut smaller, 0);
    } else if k - of_joints - OF_CASE.len() < of_lists {
        let k = k - of_joints - OF_CASE.len();
        OF_LISTS[k / lists](&mut smaller, k % lists);
    } else {
        let k = k - of_joints - OF_CASE.len() - of_lists;
        if k >= 18 * case.motions.len() {
            return None;
        }
        motion_edit(&mut smaller, k);
    }
    tidy(&mut smaller);
    Some((format!("{smaller:?}") != format!("{case:?}")).then_some(smaller))
}

/// Removes a joint and its link; what the link carried is carried by its parent.
fn remove(case: &mut Case, k: usize) {
    let removed = case.robot.joints.remove(k);
    for joint in case.robot.joints.iter_mut().filter(|joint| joint.parent == removed.child) {
        joint.parent.clone_from(&removed.parent);
    }
    case.robot.links.retain(|link| link.name != removed.child);
}

/// Drops what refers to links and joints that are gone.
fn tidy(case: &mut Case) {
    let robot = &mut case.robot;
    let links: Vec<String> = robot.links.iter().map(|link| link.name.clone()).collect();
    robot.frames.retain(|frame| links.contains(&frame.link));
    let names: Vec<String> = links.iter().cloned().chain(robot.frames.iter().map(|frame| frame.name.clone())).collect();
    let moving = |joint: &&mozzi::model::description::Joint| matches!(joint.kind, JointKind::Screw(_));
    let of_one_axis: Vec<String> = robot.joints.iter().filter(moving).map(|joint| joint.name.clone()).collect();
    for joint in &mut robot.joints {
        let is_known = joint.mimic.as_ref().is_some_and(|mimic| of_one_axis.contains(&mimic.joint));
        if !is_known || !matches!(joint.kind, JointKind::Screw(_)) {
            joint.mimic = None;
        }
        if !matches!(joint.kind, JointKind::Screw(_)) {
            joint.spring_reference = 0.0;
        }
    }
    for rotor in &mut robot.rotors {
        rotor.gears.retain(|gear| of_one_axis.contains(&gear.joint));
    }
    robot.rotors.retain(|rotor| !rotor.gears.is_empty());
    let has =
        |anchor: &mozzi::model::description::Anchor| anchor.frame.as_ref().is_none_or(|name| names.contains(name));
    robot.constraints.retain(|constraint| match &constraint.kind {
        mozzi::model::description::ConstraintKind::Frames { a, b, .. } => has(a) && has(b),
        mozzi::model::description::ConstraintKind::Joint { joints, source, .. } => {
            joints.iter().chain(source).all(|gear| of_one_axis.contains(&gear.joint))
        }
    });
    case.applied.retain(|(name, _)| names.contains(name));
    if !names.contains(&case.frame) {
        case.frame.clone_from(&names[names.len() - 1]);
    }
    let joints: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    case.motions.retain(|name, _| name.is_empty() || joints.contains(&name.as_str()));
}

fn with_motion(case: &mut Case, k: usize, change: impl Fn(&mut crate::campaign::case::Motion)) {
    let name = case.robot.joints[k].name.clone();
    case.motions.entry(name).and_modify(change);
}

fn drop_at<T>(list: &mut Vec<T>, k: usize) {
    if k < list.len() {
        list.remove(k);
    }
}

fn turn_about_z() -> JointKind {
    JointKind::Screw(ScrewAxis::from_line([0.0, 0.0, 1.0], [0.0; 3], 0.0).expect("a unit axis"))
}

fn simple() -> mozzi::SpatialInertia {
    Solid::Sphere { radius: 0.5 }.inertia(1.0)
}

#[cfg(test)]
mod tests {
    use super::shrink;
    use crate::campaign::generate;

    #[test]
    fn a_case_that_differs_by_its_damping_shrinks_to_one_joint() {
        let has_damping = |case: &crate::campaign::case::Case| {
            case.robot.clone().build().is_ok() && case.robot.joints.iter().any(|joint| joint.damping > 0.0)
        };
        let many = |seed: &u64| {
            let case = generate::case(*seed);
            case.robot.joints.len() > 5 && has_damping(&case)
        };
        let seed = (0..1000).find(many).expect("one of a thousand");
        let small = shrink(&generate::case(seed), has_damping);
        let one = &small.robot.joints[0];
        assert_eq!((small.robot.joints.len(), small.robot.links.len()), (1, 2));
        assert!(one.damping > 0.0 && one.friction == 0.0 && one.stiffness == 0.0 && small.is_alone());
        assert!(small.robot.constraints.is_empty() && small.motions[&one.name].rates == [[0.0; 6]; 3]);
    }
}
