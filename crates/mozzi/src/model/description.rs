//! The content of a robot's file as plain data.

pub use super::constraint::{Anchor, Closure, Constraint, ConstraintKind};
pub use super::states::{BaseState, JointState, NamedState};
use super::{Base, Freedom};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::scalar::Real;
use crate::spatial::{ScrewAxis, SpatialInertia};
use alloc::string::String;
use alloc::vec::Vec;

/// Links, joints and frames in the order of the file. [`build`](Description::build) makes a [`Model`](crate::Model)
/// with constants of the same number type: dual numbers give derivatives with respect to the file's numbers, wide
/// numbers a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Description<C = f64> {
    /// The robot's name.
    pub name: String,
    /// Rigid bodies; exactly one of them, the base, is not the child of a joint.
    pub links: Vec<Link<C>>,
    /// Joints between them.
    pub joints: Vec<Joint<C>>,
    /// Rotors that several joints turn.
    pub rotors: Vec<Rotor<C>>,
    /// Further frames.
    pub frames: Vec<NamedFrame<C>>,
    /// Constraints that close loops, pin frames or couple joints.
    pub constraints: Vec<Constraint<C>>,
    /// The joints that have motors, for the inverse dynamics of robots with constraints; `None` means all joints.
    pub motors: Option<Vec<String>>,
    /// The name of the end-effector frame, if the file has one.
    pub end_effector: Option<String>,
    /// Gravity in {s} coordinates, m/s².
    pub gravity: [C; 3],
    /// Whether the base link is fixed in {s} or floating.
    pub base: Base,
    /// Names of a floating base's joint and of {s} in the file; unused for a fixed base.
    pub free_joint: FreeJoint,
    /// Named states of the file, such as MuJoCo's keyframes.
    pub states: Vec<NamedState>,
    /// The name of the initial state; `None` means at rest in the neutral configuration.
    pub start: Option<String>,
}

/// The names of a floating base's joint and of {s}. They are neither a joint nor a link of the robot, and are kept for
/// round trips of files.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeJoint {
    /// `floating_base` by default.
    pub name: String,
    /// `world` by default.
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
    /// Configuration of the child link's frame relative to the parent's at joint position 0.
    pub origin: SE3<C>,
    /// How it moves.
    pub kind: JointKind<C>,
    /// Limits of position, velocity and effort.
    pub limits: Limits,
    /// Viscous friction d ≥ 0: N m s/rad or N s/m.
    pub damping: C,
    /// Coulomb friction μ ≥ 0: N m or N.
    pub friction: C,
    /// Rotor inertia (armature) at the joint: kg m² or kg.
    pub armature: C,
    /// Stiffness k ≥ 0 of the joint's spring, with the force k(θ − θ₀): N m/rad or N/m. θ is not wrapped.
    pub stiffness: C,
    /// Rest position θ₀ of the spring: rad or m.
    pub spring_reference: C,
    /// For a mimic joint, its source joint and the coupling.
    pub mimic: Option<Mimic<C>>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind<C = f64> {
    /// Does not move.
    Fixed,
    /// Moves along a unit screw axis in the child link's frame: revolute, prismatic or helical.
    Screw(ScrewAxis<C>),
    /// Rotates about a point, given in the child link's frame. Four positions: the unit quaternion (w, x, y, z) of the
    /// child's rotation relative to its orientation at 0. Three velocities: the angular velocity of the child relative
    /// to the parent, in the child's axes.
    Ball(Vec3<C>),
    /// A free joint: six degrees of freedom, as for a floating base. Seven positions: the child's configuration
    /// relative to its configuration at 0, as quaternion (w, x, y, z) and origin (x, y, z). Six velocities: the child's
    /// twist (ω, v) relative to the parent, in the child's coordinates.
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
    /// The numbers of positions and velocities; `None` for a fixed joint.
    pub(crate) fn freedom(&self) -> Option<Freedom> {
        match self {
            JointKind::Fixed => None,
            JointKind::Screw(_) => Some(Freedom::One),
            JointKind::Ball(_) => Some(Freedom::Ball),
            JointKind::Free => Some(Freedom::Free),
        }
    }
}

/// Limits of a joint; `None` means unlimited. A revolute joint without position limits is continuous.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lowest and highest position: rad or m. For a ball, 0 and the largest angle from 0; always `None` for a free
    /// joint.
    pub position: Option<[f64; 2]>,
    /// rad/s or m/s.
    pub velocity: Option<f64>,
    /// N m or N.
    pub effort: Option<f64>,
    /// rad/s² or m/s²: the smaller of URDF 1.2's `acceleration` and `deceleration`.
    pub acceleration: Option<f64>,
}

/// The coupling of a mimic joint: θ = ratio · θ_source + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic<C = f64> {
    /// The source joint.
    pub joint: String,
    /// The ratio.
    pub ratio: C,
    /// The offset: rad or m.
    pub offset: C,
}

/// A rotor that several one-axis joints turn, such as in a differential or on a tendon. Its rate is r = Σ ratio θ̇, its
/// energy ½ armature r². Model a rotor that a single joint turns by that joint's armature, times the square of the
/// ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor<C = f64> {
    /// Unique among rotors.
    pub name: String,
    /// Its inertia: kg m², or kg for linear motion.
    pub armature: C,
    /// The joints that turn it, with their ratios.
    pub gears: Vec<Gear<C>>,
}

/// How a joint turns a rotor.
#[derive(Clone, Debug, PartialEq)]
pub struct Gear<C = f64> {
    /// The joint; mimic joints are allowed.
    pub joint: String,
    /// The rotor's rate over the joint's; in a constraint the joint's part of a sum.
    pub ratio: C,
}

impl<C: Copy> Gear<C> {
    /// A copy with its number converted by `f`.
    pub(super) fn map<U>(&self, f: impl Fn(C) -> U) -> Gear<U> {
        Gear { joint: self.joint.clone(), ratio: f(self.ratio) }
    }
}

/// A frame fixed to a link.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFrame<C = f64> {
    /// Unique among links and frames.
    pub name: String,
    /// The link.
    pub link: String,
    /// Configuration of the frame relative to the link's.
    pub T: SE3<C>,
}

impl Description {
    /// An empty robot, with gravity (0, 0, −9.81).
    pub fn new(name: impl Into<String>) -> Self {
        Description {
            name: name.into(),
            links: Vec::new(),
            joints: Vec::new(),
            rotors: Vec::new(),
            frames: Vec::new(),
            constraints: Vec::new(),
            motors: None,
            end_effector: None,
            gravity: [0.0, 0.0, -9.81],
            base: Base::Fixed,
            free_joint: FreeJoint::default(),
            states: Vec::new(),
            start: None,
        }
    }

    /// Makes the base floating.
    pub fn floating(mut self) -> Self {
        self.base = Base::Floating;
        self
    }

    /// Sets the gravity, in {s} coordinates, m/s².
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

    /// Adds a frame with configuration `T` relative to a link's frame.
    pub fn frame(mut self, name: impl Into<String>, link: impl Into<String>, T: SE3) -> Self {
        self.frames.push(NamedFrame { name: name.into(), link: link.into(), T });
        self
    }

    /// Adds a constraint.
    pub fn constraint(mut self, constraint: Constraint) -> Self {
        self.constraints.push(constraint);
        self
    }
}

/// The independent joint at the end of a chain of mimic joints, or the joint itself if it is independent: θ = ratio ·
/// θ_source + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source<C = f64> {
    /// Its index among the joints.
    pub joint: usize,
    /// The ratio, of the whole chain of mimic joints.
    pub ratio: C,
    /// The offset, of the whole chain likewise.
    pub offset: C,
}

impl<C: Real> Description<C> {
    /// A copy with all numbers converted by `f`.
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
        let rotor = |rotor: &Rotor<C>| Rotor {
            name: rotor.name.clone(),
            armature: f(rotor.armature),
            gears: rotor.gears.iter().map(|gear| gear.map(f)).collect(),
        };
        let frame = |frame: &NamedFrame<C>| NamedFrame {
            name: frame.name.clone(),
            link: frame.link.clone(),
            T: frame.T.map(f),
        };
        Description {
            name: self.name.clone(),
            links: self.links.iter().map(link).collect(),
            joints: self.joints.iter().map(joint).collect(),
            rotors: self.rotors.iter().map(rotor).collect(),
            frames: self.frames.iter().map(frame).collect(),
            constraints: self.constraints.iter().map(|constraint| constraint.map(f)).collect(),
            motors: self.motors.clone(),
            end_effector: self.end_effector.clone(),
            gravity: self.gravity.map(f),
            base: self.base,
            free_joint: self.free_joint.clone(),
            states: self.states.clone(),
            start: self.start.clone(),
        }
    }

    /// The source joint of the joint with this index; `find` returns the index of a name.
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

    /// The source joint of the joint of this name, by its index in [`joints`](Self::joints), through chains of mimic
    /// joints; `None` if there is no such joint. The robot must pass [`check`](Self::check): with a cycle of mimic
    /// joints this does not terminate.
    pub fn source_of(&self, name: &str) -> Option<Source<C>> {
        let find = |name: &str| self.joints.iter().position(|joint| joint.name == name);
        Some(self.source_by(find(name)?, find))
    }
}

impl Joint {
    /// A joint without limits, friction, armature or spring. `origin` is the child's frame relative to the parent's at
    /// 0.
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
