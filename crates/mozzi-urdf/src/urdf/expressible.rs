//! Rewrites a robot with only the elements that URDF has.

use crate::urdf::write::free;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};
use std::collections::BTreeSet;

/// Rewrites a robot for [`write`](crate::write): every further frame is a link without mass on a fixed joint, and a
/// revolute joint whose axis misses the child's frame turns a new link on its axis, to which the child is fixed. Joints
/// keep their names and order; the motion of all links is the same.
pub fn expressible(description: &Description) -> Description {
    let mut robot = Description { joints: Vec::new(), frames: Vec::new(), ..description.clone() };
    let mut names = Names::of(description);
    for joint in &description.joints {
        match axis_point(joint) {
            Some(point) => turn_on_axis(joint, point, &mut names, &mut robot),
            None => robot.joints.push(joint.clone()),
        }
    }
    for frame in &description.frames {
        robot = robot.link(&frame.name, SpatialInertia::zero());
        let name = names.joint(&format!("{}_joint", frame.name));
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
fn turn_on_axis(joint: &Joint, q: Vec3, names: &mut Names, robot: &mut Description) {
    let JointKind::Screw(A) = joint.kind else { return };
    let Ok(axis) = ScrewAxis::new(A.twist().w.0, [0.0; 3]) else { return };
    let link = names.link(&format!("{}_axis", joint.name));
    let name = names.joint(&format!("{link}_joint"));
    robot.joints.push(Joint {
        origin: joint.origin * SE3::translation(q.0),
        kind: JointKind::Screw(axis),
        child: link.clone(),
        ..joint.clone()
    });
    robot.joints.push(Joint::new(name, &link, &joint.child, SE3::translation((-q).0), JointKind::Fixed));
    robot.links.push(mozzi::model::description::Link { name: link, inertia: SpatialInertia::zero() });
}

/// The names that are taken.
struct Names {
    /// Links and frames.
    links: BTreeSet<String>,
    joints: BTreeSet<String>,
}

impl Names {
    fn of(d: &Description) -> Self {
        let links = d.links.iter().map(|link| &link.name).chain(d.frames.iter().map(|frame| &frame.name));
        Names { links: links.cloned().collect(), joints: d.joints.iter().map(|joint| joint.name.clone()).collect() }
    }

    /// A name for a new link.
    fn link(&mut self, name: &str) -> String {
        let name = free(name, |name| self.links.contains(name));
        self.links.insert(name.clone());
        name
    }

    /// A name for a new joint.
    fn joint(&mut self, name: &str) -> String {
        let name = free(name, |name| self.joints.contains(name));
        self.joints.insert(name.clone());
        name
    }
}
