//! Rewrites a robot with only the elements that URDF has.

use crate::urdf::write::free;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};

/// Rewrites a robot for [`write`](crate::write): every further frame is a link without mass on a fixed joint, and a
/// revolute joint whose axis misses the child's frame turns a new link on its axis, to which the child is fixed. Joints
/// keep their names and order; the motion of all links is the same.
pub fn expressible(description: &Description) -> Description {
    let mut robot = Description { joints: Vec::new(), frames: Vec::new(), ..description.clone() };
    for joint in &description.joints {
        match axis_point(joint) {
            Some(point) => turn_on_axis(joint, point, description, &mut robot),
            None => robot.joints.push(joint.clone()),
        }
    }
    for frame in &description.frames {
        robot = robot.link(&frame.name, SpatialInertia::zero());
        let name = joint_name(&frame.name, description, &robot);
        robot = robot.joint(Joint::new(name, &frame.link, &frame.name, frame.T, JointKind::Fixed));
    }
    robot
}

/// The point of a revolute joint's axis that is nearest to the child's frame, if it is not its origin: ω × v.
fn axis_point(joint: &Joint) -> Option<Vec3> {
    let JointKind::Screw(A) = joint.kind else { return None };
    let is_revolute = joint.kind.name() == "revolute";
    (is_revolute && A.twist().v != Vec3::zero()).then(|| A.twist().w.cross(A.twist().v))
}

/// M exp(Aθ) = M Trans(q) · exp((ω, 0)θ) · Trans(−q)
fn turn_on_axis(joint: &Joint, q: Vec3, before: &Description, robot: &mut Description) {
    let JointKind::Screw(A) = joint.kind else { return };
    let Ok(axis) = ScrewAxis::new(A.twist().w.0, [0.0; 3]) else { return };
    let taken = |name: &str| {
        [before, robot].iter().any(|d| d.links.iter().any(|link| link.name == name))
            || before.frames.iter().any(|frame| frame.name == name)
    };
    let link = free(&format!("{}_axis", joint.name), taken);
    let name = joint_name(&link, before, robot);
    robot.joints.push(Joint {
        origin: joint.origin * SE3::translation(q.0),
        kind: JointKind::Screw(axis),
        child: link.clone(),
        ..joint.clone()
    });
    robot.joints.push(Joint::new(name, &link, &joint.child, SE3::translation((-q).0), JointKind::Fixed));
    robot.links.push(mozzi::model::description::Link { name: link, inertia: SpatialInertia::zero() });
}

/// A name for the fixed joint of a link.
fn joint_name(link: &str, before: &Description, robot: &Description) -> String {
    free(&format!("{link}_joint"), |name| {
        [before, robot].iter().any(|d| d.joints.iter().any(|joint| joint.name == name))
    })
}
