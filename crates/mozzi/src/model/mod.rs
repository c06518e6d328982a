//! The robot: the content of its file ([`Description`]), and the constants of the kernels ([`Model`]).

mod arguments;
mod base;
mod bounds;
mod build;
mod check;
mod configuration;
mod constraint;
mod contact_point;
mod couples;
mod described;
pub mod description;
mod edit;
mod environment;
mod error;
mod frame;
mod link;
mod parameters;
mod pivots;
mod places;
mod problem;
mod provenance;
mod reduced;
mod rotor;
mod screws;
mod spring;
mod states;
mod task;
mod tie;
mod traverse;
mod variation;

use crate::linalg::{Vec3, ldlt::Pattern};
use crate::scalar::Scalar;
use crate::spatial::SpatialInertia;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;

pub(crate) use arguments::{check_length, check_unit};
pub use base::Base;
pub use bounds::{Bounds, UNLIMITED};
pub use configuration::{ConfigurationSpace, difference, integrate, rate_of_logarithm, seed_direction};
pub use contact_point::{ContactPoint, Support};
pub use description::Description;
pub use environment::Environment;
pub use error::Error;
pub use frame::{Frame, FrameId};
pub(crate) use link::{Lifted, Link, Motion};
pub(crate) use parameters::JOINT_PARAMETERS;
pub use pivots::{Pivots, least_is_clear};
pub use places::{Freedom, Place};
pub use problem::{Element, Problem, Severity};
pub use provenance::FoldedBody;
pub(crate) use rotor::Rotor;
pub use screws::{HomeFrames, ScrewLists, Screws};
pub(crate) use spring::Spring;
pub use states::State;
pub use task::{Task, TaskFrame, TaskMemory};
pub(crate) use tie::{End, Own, Tie, TieKind, Ties, Way};
pub use variation::Variation;

/// A robot's constants, in the screw normal form: every moving link has a frame whose z-axis is its joint's screw axis;
/// fixed joints are folded away, and every frame of the file remains as a [`Frame`].
///
/// The constants have type `C`; states can have any [`Scalar`] type `S: From<C>`. A model is immutable and can be
/// shared.
#[derive(Clone, Debug)]
pub struct Model<C = f64> {
    /// Moving links, parents before children; slot i of the kernels is `links[i - 1]`, slot 0 the base.
    pub(crate) links: Vec<Link<C>>,
    /// Inertia of the base link and all links fixed to it, in the base frame.
    pub(crate) base_inertia: SpatialInertia<C>,
    /// Rotor inertia of each of the n velocities, 0 for a floating base's; as felt at the joint, mimic joints included:
    /// Σ ratio² · armature.
    pub(crate) armature: Vec<C>,
    /// The rotors that several joints turn.
    pub(crate) rotors: Vec<Rotor<C>>,
    /// Viscous friction likewise: Σ ratio² · d.
    pub(crate) damping: Vec<C>,
    /// Coulomb friction likewise: Σ |ratio| · μ.
    pub(crate) friction: Vec<C>,
    /// The springs of joints that have one, directly or through a mimic joint.
    pub(crate) springs: Vec<Spring<C>>,
    /// The springs' energy at θ = 0, Σ ½k(θ₀ − offset)².
    pub(crate) spring_energy: C,
    pub(crate) frames: Vec<Frame<C>>,
    pub(crate) ties: Ties<C>,
    pub(crate) gravity: Vec3<C>,
    pub(crate) base: Base,
    /// See [`solves_by_mass_matrix`](Self::solves_by_mass_matrix()).
    pub(crate) solves_by_mass_matrix: bool,
    /// False if parameters of the description were replaced.
    pub(crate) is_described: bool,
    pub(crate) structure: Arc<Structure>,
}

/// The parts of a model that do not depend on the number type.
#[derive(Debug)]
pub(crate) struct Structure {
    pub description: Description,
    /// The link of the description that no joint moves.
    pub base: usize,
    /// The joint of the description that moves slot i, at i − 1; a ball moves three slots.
    pub moving_joints: Vec<usize>,
    /// The link of the description that it moves.
    pub moving_links: Vec<usize>,
    /// The independent joints of the description, in the order of θ.
    pub joints: Vec<usize>,
    /// A floating base's place, then those joints'.
    pub space: ConfigurationSpace,
    /// Names of the positions and of the velocities.
    pub names: [Vec<String>; 2],
    /// The first frames are those of the description's links, in its order; then its further frames.
    pub end_effector: Option<FrameId>,
    /// Candidates, if the end effector must be named.
    pub leaves: Vec<FrameId>,
    pub pattern: Pattern,
    /// True if the robot has a mimic joint.
    pub has_mimic_joints: bool,
    /// For each slot the first slot of the links that a joint and its mimic joints on the same link move, 0 for a joint
    /// that moves a link alone; empty without mimic joints, and if one and its source joint are on different links.
    pub siblings: Vec<usize>,
    /// The first index in θ̇ of each free joint.
    pub free: Vec<usize>,
    /// True if no joints are coupled and the limbs are so long that ∂θ̈ is faster by articulated bodies.
    pub has_long_limbs: bool,
    /// For each slot: true if a link other than that of the next slot is attached to its link.
    pub forks: Vec<bool>,
    /// No joint is a ball or free.
    pub of_one_axis: bool,
}

impl<C: Scalar> Model<C> {
    /// The number n of velocities: the length of θ̇, θ̈ and τ. One for each independent joint, three for a ball, six
    /// for a free joint, after six of a floating base.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn n(&self) -> usize {
        self.armature.len()
    }

    /// The number of positions: the length of θ. n, and one more for a floating base, each ball and each free joint: a
    /// quaternion has four entries.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn nq(&self) -> usize {
        self.structure.names[0].len()
    }

    /// Rotor inertia of each of the n velocities as felt at the joint, mimic joints included: Σ ratio² · armature, kg
    /// m² or kg.
    pub fn armature(&self) -> &[C] {
        &self.armature
    }

    /// Viscous friction of each velocity likewise: Σ ratio² · d, N m s/rad or N s/m.
    pub fn damping(&self) -> &[C] {
        &self.damping
    }

    /// Coulomb friction of each velocity likewise: Σ |ratio| · μ, N m or N.
    pub fn friction(&self) -> &[C] {
        &self.friction
    }

    /// Stiffness of each velocity of joints of one freedom likewise: Σ ratio² · k, N m/rad or N/m.
    pub fn stiffness(&self) -> Vec<C> {
        let mut k = alloc::vec![C::zero(); self.n()];
        for spring in self.springs.iter().filter(|spring| spring.place.freedom == Freedom::One) {
            k[spring.place.j] += spring.stiffness;
        }
        k
    }

    /// Which entries of M and of its factors are not zero.
    pub fn pattern(&self) -> &Pattern {
        &self.structure.pattern
    }

    /// The mass of the moving links and of a floating base, kg.
    pub fn mass(&self) -> C {
        let base = if self.is_floating() { self.base_inertia.mass } else { C::zero() };
        self.links.iter().fold(base, |sum, link| sum + link.G.mass)
    }

    /// The number N of moving links; mimic joints count.
    pub fn moving_links(&self) -> usize {
        self.moving_slots().count()
    }

    /// True if these slots, inner ≤ outer, are axes of one ball or free joint.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn is_one_joint(&self, inner: usize, outer: usize) -> bool {
        // the axes of one joint are consecutive: each but the first is a next one
        self.links[inner..outer].iter().all(|link| link.motion == Motion::Next)
    }

    /// The slots of moving links; for a ball or a free joint, that of the last axis, which carries the link.
    pub(crate) fn moving_slots(&self) -> impl Iterator<Item = usize> {
        (1..).zip(&self.links).filter(|(_, link)| link.is_last).map(|(slot, _)| slot)
    }

    /// Whether the robot has mimic joints.
    pub fn has_mimic_joints(&self) -> bool {
        self.structure.has_mimic_joints
    }

    /// Whether forward dynamics factors the mass matrix: if several joints turn a rotor, or if a mimic joint and its
    /// source joint are not on the same link. Else it is by articulated bodies.
    pub fn solves_by_mass_matrix(&self) -> bool {
        self.solves_by_mass_matrix
    }

    /// Makes forward dynamics factor the mass matrix; in machine code for a small robot this can need fewer operations.
    pub fn solving_by_mass_matrix(self) -> Self {
        Model { solves_by_mass_matrix: true, ..self }
    }

    /// The first slot of the links that one joint and its mimic joints move, 0 for a joint that moves a link alone.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn first_sibling(&self, slot: usize) -> usize {
        self.structure.siblings.get(slot).copied().unwrap_or_default()
    }

    /// The constraints, as described.
    pub fn constraints(&self) -> &[description::Constraint] {
        &self.structure.description.constraints
    }

    /// The number m of rows of all constraints: the length of λ. 0 for a tree.
    pub fn constraint_rows(&self) -> usize {
        self.ties.rows
    }

    /// The names of the m rows: `constraint.vx` and so on.
    pub fn constraint_row_names(&self) -> impl Iterator<Item = String> {
        self.constraints()
            .iter()
            .flat_map(|one| one.row_names().iter().map(move |row| alloc::format!("{}.{row}", one.name)))
    }

    /// Gravity in {s} coordinates, m/s².
    pub fn gravity(&self) -> Vec3<C> {
        self.gravity
    }

    /// The description from which the model was built.
    pub fn description(&self) -> &Description {
        &self.structure.description
    }

    /// The names of the independent joints, in the order of θ.
    pub fn joint_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.joints().map(|joint| joint.name.as_str())
    }

    /// The independent joints as described, in the order of θ: limits, damping, friction, armature, springs.
    pub fn joints(&self) -> impl ExactSizeIterator<Item = &description::Joint> {
        self.structure.joints.iter().map(|&joint| &self.structure.description.joints[joint])
    }

    /// The joint of each moving link as described, base to tips, mimic joints included.
    pub fn moving_joints(&self) -> impl Iterator<Item = &description::Joint> {
        let joint = |slot: usize| &self.structure.description.joints[self.structure.moving_joints[slot - 1]];
        self.moving_slots().map(joint)
    }

    /// The source joint of each moving joint (itself if independent), by its index in
    /// [`joint_names`](Self::joint_names), in the order of [`moving_joints`](Self::moving_joints).
    pub fn sources(&self) -> impl Iterator<Item = description::Source<C>> {
        let joint_of = |j: usize| self.places().partition_point(|place| place.j <= j) - 1;
        self.moving_slots().map(move |slot| {
            let link = &self.links[slot - 1];
            description::Source { joint: joint_of(link.j), ratio: link.ratio, offset: link.offset }
        })
    }

    /// The source joint of the moving joint of this name: see [`sources`](Self::sources).
    pub fn source_of(&self, name: &str) -> Option<description::Source<C>> {
        let joint = self.moving_joints().position(|joint| joint.name == name)?;
        self.sources().nth(joint)
    }

    /// A copy with all constants converted by `f`: `model.map(f32::from_f64)`, `model.map(Dual::constant)`.
    pub fn map<U>(&self, f: impl Fn(C) -> U + Copy) -> Model<U> {
        let list = |constants: &[C]| constants.iter().map(|&c| f(c)).collect();
        Model {
            links: self.links.iter().map(|link| link.map(f)).collect(),
            base_inertia: self.base_inertia.map(f),
            armature: list(&self.armature),
            rotors: self.rotors.iter().map(|rotor| rotor.map(f)).collect(),
            damping: list(&self.damping),
            friction: list(&self.friction),
            springs: self.springs.iter().map(|spring| spring.map(f)).collect(),
            spring_energy: f(self.spring_energy),
            frames: self.frames.iter().map(|frame| Frame { slot: frame.slot, T: frame.T.map(f) }).collect(),
            ties: self.ties.map(f),
            gravity: self.gravity.map(f),
            base: self.base,
            solves_by_mass_matrix: self.solves_by_mass_matrix,
            is_described: self.is_described,
            structure: Arc::clone(&self.structure),
        }
    }

    /// Asserts that θ and slices of one number per velocity have their lengths: a wrong one is a bug of the caller.
    ///
    /// # Panics
    /// If one has not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[track_caller]
    pub fn assert_lengths<const K: usize>(&self, positions: usize, velocities: [usize; K]) {
        assert!(positions == self.nq(), "theta has {positions} entries, expected {}", self.nq());
        for found in velocities {
            assert!(
                found == self.n(),
                "a slice has {found} entries, expected one for each of the {} velocities",
                self.n()
            );
        }
    }
}

impl Model {
    /// True if dry friction acts on any joint, mimic joints included.
    pub fn has_dry_friction(&self) -> bool {
        self.friction.iter().any(|&friction| friction != 0.0)
    }
}
