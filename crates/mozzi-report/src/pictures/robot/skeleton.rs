//! Rigid bodies of a robot, its bones and the axes of its joints.

use mozzi::model::description::{Joint, JointKind};
use mozzi::{Error, Model, SE3, Vec3};
use std::collections::BTreeMap;

/// The robot at a configuration.
pub(super) struct Skeleton<'m> {
    model: &'m Model,
    poses: BTreeMap<&'m str, SE3>,
    moving: Vec<&'m Joint>,
}

/// An axis of a joint in {s}.
pub(super) struct Axis {
    pub point: Vec3,
    /// `None` for a ball.
    pub direction: Option<Vec3>,
    pub is_sliding: bool,
}

/// A bone, from joint to joint or from a joint to a tip.
pub(super) struct Bone<'m> {
    /// The root link of its body.
    pub body: &'m str,
    pub ends: [Vec3; 2],
}

impl<'m> Skeleton<'m> {
    pub fn new(model: &'m Model, theta: &[f64]) -> Result<Self, Error> {
        let mut poses = BTreeMap::new();
        for (frame, name) in model.frames() {
            poses.insert(name, model.forward_kinematics(theta, frame)?);
        }
        Ok(Skeleton { model, poses, moving: model.moving_joints().collect() })
    }

    /// The pose of a link or a frame in {s}.
    pub fn pose(&self, name: &str) -> Option<SE3> {
        self.poses.get(name).copied()
    }

    pub fn moving_joints(&self) -> &[&'m Joint] {
        &self.moving
    }

    /// The first link of a rigid body: that which a moving joint carries, or the base.
    pub fn root<'a>(&'a self, mut link: &'a str) -> &'a str {
        let joints = &self.model.description().joints;
        while self.moving.iter().all(|joint| joint.child != link)
            && let Some(joint) = joints.iter().find(|joint| joint.child == link)
        {
            link = &joint.parent;
        }
        link
    }

    /// A point of a joint's axis.
    fn point(&self, joint: &Joint) -> Option<Vec3> {
        let T = self.pose(&joint.child)?;
        Some(match joint.kind {
            JointKind::Screw(A) => T * A.twist().w.cross(A.twist().v),
            JointKind::Ball(center) => T * center,
            JointKind::Fixed | JointKind::Free => T.p,
        })
    }

    /// The axes of all moving joints except free ones, in their order.
    pub fn axes(&self) -> Vec<Axis> {
        let axis = |joint: &&Joint| {
            let (T, point) = (self.pose(&joint.child)?, self.point(joint)?);
            let direction = match joint.kind {
                JointKind::Screw(A) if A.is_prismatic() => Some(T.R * A.twist().v),
                JointKind::Screw(A) => Some(T.R * A.twist().w),
                _ => None,
            };
            let is_sliding = joint.kind.name() == "prismatic";
            (!matches!(joint.kind, JointKind::Free)).then_some(Axis { point, direction, is_sliding })
        };
        self.moving.iter().filter_map(axis).collect()
    }

    /// A bone to each moving joint that its body carries; of a body that carries none, one to its farthest frame or
    /// centre of mass.
    pub fn bones(&self) -> Vec<Bone<'_>> {
        let robot = self.model.description();
        let mut bones = Vec::new();
        for joint in self.moving.iter().filter(|joint| !matches!(joint.kind, JointKind::Free)) {
            let body = self.root(&joint.parent);
            if let (Some(from), Some(to)) = (self.start(body), self.point(joint)) {
                bones.push(Bone { body, ends: [from, to] });
            }
        }
        for link in &robot.links {
            let body = self.root(&link.name);
            let is_root = body == link.name;
            let Some(from) = self.start(body).filter(|_| is_root && bones.iter().all(|bone| bone.body != body)) else {
                continue;
            };
            let links = robot.links.iter().filter(|link| self.root(&link.name) == body);
            let centers = links.clone().filter(|link| link.inertia.mass > 0.0);
            let centers = centers.filter_map(|link| Some(self.pose(&link.name)? * link.inertia.center_of_mass()));
            let frames = robot.frames.iter().filter(|frame| self.root(&frame.link) == body).map(|frame| &*frame.name);
            let origins = links.map(|link| &*link.name).chain(frames).filter_map(|name| Some(self.pose(name)?.p));
            let far = origins.chain(centers).max_by(|a, b| (*a - from).norm().total_cmp(&(*b - from).norm()));
            bones.extend(far.map(|to| Bone { body, ends: [from, to] }));
        }
        bones
    }

    /// Where a body's bones begin: at the joint that carries it, or at the base's origin.
    fn start(&self, root: &str) -> Option<Vec3> {
        let carrier = self.moving.iter().find(|joint| joint.child == root);
        carrier.map_or_else(|| Some(self.pose(root)?.p), |joint| self.point(joint))
    }
}
