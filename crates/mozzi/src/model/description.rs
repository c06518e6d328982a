//! A robot as its file tells it: plain data, nothing computed.

use super::{Base, Freedom};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::scalar::Real;
use crate::spatial::{ScrewAxis, SpatialInertia};
use alloc::string::String;
use alloc::vec::Vec;

/// Links, joints and frames in the order of the file. [`build`](Description::build) makes a [`Model`](crate::Model) with constants of
/// the same numbers: dual numbers give derivatives by what the file says, wide ones a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Description<C = f64> {
    /// The robot's name.
    pub name: String,
    /// Rigid bodies; exactly one of them, the base, is no joint's child.
    pub links: Vec<Link<C>>,
    /// Joints between them.
    pub joints: Vec<Joint<C>>,
    /// Further frames.
    pub frames: Vec<NamedFrame<C>>,
    /// The end-effector frame, where it was named.
    pub end_effector: Option<String>,
    /// Gravity in {s} coordinates, m/s².
    pub gravity: [C; 3],
    /// Is the base link fixed to {s}, or free?
    pub base: Base,
    /// What a file calls that from which a floating base is freed; says nothing about a fixed one.
    pub free_joint: FreeJoint,
}

/// The names of a floating base's joint and of {s}, which are neither a joint nor a link of the robot: kept so that a file is written
/// back as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeJoint {
    /// `floating_base` where no file gave it a name.
    pub name: String,
    /// `world` where no file gave it a name.
    pub parent: String,
}

impl Default for FreeJoint {
    fn default() -> Self {
        FreeJoint { name: "floating_base".into(), parent: "world".into() }
    }
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct Link<C = f64> {
    /// Unique among links and frames.
    pub name: String,
    /// In the link's frame; zero for a massless link.
    pub inertia: SpatialInertia<C>,
}

/// Its name.
impl<C> AsRef<str> for Link<C> {
    fn as_ref(&self) -> &str {
        &self.name
    }
}

/// A joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint<C = f64> {
    /// Unique among joints.
    pub name: String,
    /// The link that carries it.
    pub parent: String,
    /// The link that it moves.
    pub child: String,
    /// The child link's frame seen from the parent's when the joint is at 0.
    pub origin: SE3<C>,
    /// How it moves.
    pub kind: JointKind<C>,
    /// How far, how fast, how strong.
    pub limits: Limits,
    /// Viscous friction d ≥ 0: N m s/rad or N s/m.
    pub damping: C,
    /// Coulomb friction μ ≥ 0: N m or N.
    pub friction: C,
    /// Rotor inertia, seen at the joint: kg m² or kg.
    pub armature: C,
    /// Stiffness k ≥ 0 of a spring on the joint, which takes the force k(θ − θ₀): N m/rad or N/m. θ is not wrapped.
    pub stiffness: C,
    /// θ₀, where the spring is at rest: rad or m.
    pub spring_reference: C,
    /// The joint that it follows, if it follows one.
    pub mimic: Option<Mimic<C>>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind<C = f64> {
    /// Not at all.
    Fixed,
    /// About and along a unit screw axis, in the child link's frame: revolute, prismatic or helical.
    Screw(ScrewAxis<C>),
    /// About a point, seen from the child link's frame. Four positions, the unit quaternion (w, x, y, z) of the rotation that takes the child from its
    /// axes at 0; three velocities, the angular velocity of the child relative to the parent in the child's axes.
    Ball(Vec3<C>),
    /// Not held at all. Seven positions, the child's configuration seen from where it is at 0, as of a floating base: the quaternion (w, x, y, z)
    /// and the origin (x, y, z); six velocities, the child's twist (ω, v) relative to the parent in its own coordinates.
    Free,
}

/// Its name.
impl<C> AsRef<str> for Joint<C> {
    fn as_ref(&self) -> &str {
        &self.name
    }
}

impl JointKind {
    /// "fixed", "revolute", "prismatic", "helical", "ball" or "free".
    pub fn name(self) -> &'static str {
        match self {
            JointKind::Fixed => "fixed",
            JointKind::Screw(A) if A.is_prismatic() => "prismatic",
            JointKind::Screw(A) if A.pitch().abs() < 1e-12 => "revolute",
            JointKind::Screw(_) => "helical",
            JointKind::Ball(_) => "ball",
            JointKind::Free => "free",
        }
    }
}

impl<C> JointKind<C> {
    /// How many positions and velocities; none of a fixed joint.
    pub(crate) fn freedom(&self) -> Option<Freedom> {
        match self {
            JointKind::Fixed => None,
            JointKind::Screw(_) => Some(Freedom::One),
            JointKind::Ball(_) => Some(Freedom::Ball),
            JointKind::Free => Some(Freedom::Free),
        }
    }
}

/// Limits of a joint, each `None` where there is none. A revolute joint without position limits is continuous.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lowest and highest position: rad or m. Of a ball, 0 and the largest angle that it turns from 0; of a free joint none.
    pub position: Option<[f64; 2]>,
    /// rad/s or m/s.
    pub velocity: Option<f64>,
    /// N m or N.
    pub effort: Option<f64>,
}

/// θ = ratio · θ_source + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic<C = f64> {
    /// The joint that is followed.
    pub joint: String,
    /// The ratio.
    pub ratio: C,
    /// The offset: rad or m.
    pub offset: C,
}

/// A frame fixed to a link.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFrame<C = f64> {
    /// Unique among links and frames.
    pub name: String,
    /// The link.
    pub link: String,
    /// The frame seen from the link's.
    pub T: SE3<C>,
}

impl Description {
    /// An empty robot, with gravity (0, 0, −9.81).
    pub fn new(name: impl Into<String>) -> Self {
        Description {
            name: name.into(),
            links: Vec::new(),
            joints: Vec::new(),
            frames: Vec::new(),
            end_effector: None,
            gravity: [0.0, 0.0, -9.81],
            base: Base::Fixed,
            free_joint: FreeJoint::default(),
        }
    }

    /// The same robot with a floating base.
    pub fn floating(mut self) -> Self {
        self.base = Base::Floating;
        self
    }

    /// The same robot under another gravity, in {s} coordinates, m/s².
    pub fn with_gravity(mut self, gravity: [f64; 3]) -> Self {
        self.gravity = gravity;
        self
    }

    /// Adds a link, its inertia in its own frame.
    pub fn link(mut self, name: impl Into<String>, inertia: SpatialInertia) -> Self {
        self.links.push(Link { name: name.into(), inertia });
        self
    }

    /// Adds a joint.
    pub fn joint(mut self, joint: Joint) -> Self {
        self.joints.push(joint);
        self
    }

    /// Adds a frame, seen from a link's.
    pub fn frame(mut self, name: impl Into<String>, link: impl Into<String>, T: SE3) -> Self {
        self.frames.push(NamedFrame { name: name.into(), link: link.into(), T });
        self
    }
}

/// The independent joint that a joint follows in the end, itself where it follows none: θ = ratio · θ_source + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source<C = f64> {
    /// Its place among the joints.
    pub joint: usize,
    /// The ratio, of the whole chain of mimic joints.
    pub ratio: C,
    /// The offset likewise.
    pub offset: C,
}

impl<C: Real> Description<C> {
    /// The same robot in numbers of another type.
    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Description<U> {
        let joint = |joint: &Joint<C>| Joint {
            name: joint.name.clone(),
            parent: joint.parent.clone(),
            child: joint.child.clone(),
            origin: joint.origin.map(f),
            kind: match joint.kind {
                JointKind::Fixed => JointKind::Fixed,
                JointKind::Screw(A) => JointKind::Screw(A.map(f)),
                JointKind::Ball(center) => JointKind::Ball(center.map(f)),
                JointKind::Free => JointKind::Free,
            },
            limits: joint.limits,
            damping: f(joint.damping),
            friction: f(joint.friction),
            armature: f(joint.armature),
            stiffness: f(joint.stiffness),
            spring_reference: f(joint.spring_reference),
            mimic: joint.mimic.as_ref().map(|mimic| Mimic {
                joint: mimic.joint.clone(),
                ratio: f(mimic.ratio),
                offset: f(mimic.offset),
            }),
        };
        let link = |link: &Link<C>| Link { name: link.name.clone(), inertia: link.inertia.map(f) };
        let frame = |frame: &NamedFrame<C>| NamedFrame {
            name: frame.name.clone(),
            link: frame.link.clone(),
            T: frame.T.map(f),
        };
        Description {
            name: self.name.clone(),
            links: self.links.iter().map(link).collect(),
            joints: self.joints.iter().map(joint).collect(),
            frames: self.frames.iter().map(frame).collect(),
            end_effector: self.end_effector.clone(),
            gravity: self.gravity.map(f),
            base: self.base,
            free_joint: self.free_joint.clone(),
        }
    }

    /// The source joint of the joint at this place, by its place; `find` is the place of the joint of a name.
    pub(crate) fn source_by(&self, joint: usize, find: impl Fn(&str) -> Option<usize>) -> Source<C> {
        let mut source = Source { joint, ratio: C::one(), offset: C::zero() };
        // ratio · (r θ + o) + offset
        while let Some(mimic) = &self.joints[source.joint].mimic {
            let Some(next) = find(&mimic.joint) else { break };
            let offset = source.offset + source.ratio * mimic.offset;
            source = Source { joint: next, ratio: source.ratio * mimic.ratio, offset };
        }
        source
    }

    /// The source joint of the joint of this name, by its place in [`joints`](Self::joints), through chains of mimic joints. None where there
    /// is no such joint. Of a robot that [`check`](Self::check) passes; where mimic joints follow each other in a circle it does not end.
    pub fn source_of(&self, name: &str) -> Option<Source<C>> {
        let find = |name: &str| self.joints.iter().position(|joint| joint.name == name);
        Some(self.source_by(find(name)?, find))
    }
}

impl Joint {
    /// A joint without limits, friction, armature or spring. `origin` is the child's frame seen from the parent's at 0.
    pub fn new(
        name: impl Into<String>,
        parent: impl Into<String>,
        child: impl Into<String>,
        origin: SE3,
        kind: JointKind,
    ) -> Self {
        Joint {
            name: name.into(),
            parent: parent.into(),
            child: child.into(),
            origin,
            kind,
            limits: Limits::default(),
            damping: 0.0,
            friction: 0.0,
            armature: 0.0,
            stiffness: 0.0,
            spring_reference: 0.0,
            mimic: None,
        }
    }
}
