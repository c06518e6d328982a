//! The declaration of a quantity: its name and formula, inputs and outputs.

use super::Subject;
use crate::model::{Environment, Model};
use crate::scalar::Scalar;

/// Name, formula, inputs and outputs of one quantity. See [`Quantity`](super::Quantity).
#[derive(Clone, Copy, Debug)]
pub struct Declaration {
    /// The name of the Rust method, Python's method and the emitted function; with hyphens, of the command line's
    /// quantity.
    pub name: &'static str,
    /// Its formula and a description.
    pub formula: &'static str,
    /// Its inputs, in this order.
    pub inputs: &'static [Input],
    /// Its outputs, in this order; matrices by rows.
    pub outputs: &'static [Output],
    first_output: usize,
    /// The frame, task or point that it refers to.
    pub of: Of,
    /// The parts of the environment that it depends on.
    pub uses: Uses,
    /// Whether its kernel's other inputs are zeros.
    pub is_at_rest: bool,
    /// Whether it divides by pivots, of the mass matrix or of the task.
    pub divides: bool,
    /// Whether it divides by the robot's mass.
    pub needs_mass: bool,
    /// Whether the robot's constraints act in it.
    pub is_constrained: bool,
    /// Whether it is equal for two robots with the same joint forces in every motion: see [`Model::reduced`]. False for
    /// energies and momenta.
    pub is_of_forces: bool,
}

impl Declaration {
    pub(crate) const fn new(
        name: &'static str,
        formula: &'static str,
        inputs: &'static [Input],
        outputs: &'static [Output],
    ) -> Self {
        let (of, uses) = (Of::Robot, Uses::NOTHING);
        Declaration {
            name,
            formula,
            inputs,
            outputs,
            first_output: 0,
            of,
            uses,
            is_at_rest: false,
            divides: false,
            needs_mass: false,
            is_constrained: false,
            is_of_forces: true,
        }
    }
    pub(crate) const fn of(self, of: Of) -> Self {
        Declaration { of, ..self }
    }
    pub(crate) const fn uses(self, uses: Uses) -> Self {
        Declaration { uses, ..self }
    }
    pub(crate) const fn at_rest(self) -> Self {
        Declaration { is_at_rest: true, ..self }
    }
    pub(crate) const fn divides(self) -> Self {
        Declaration { divides: true, ..self }
    }
    pub(crate) const fn needs_mass(self) -> Self {
        Declaration { needs_mass: true, is_of_forces: false, ..self }
    }
    pub(crate) const fn is_constrained(self) -> Self {
        Declaration { is_constrained: true, ..self }
    }
    pub(crate) const fn is_of_masses(self) -> Self {
        Declaration { is_of_forces: false, ..self }
    }
    pub(crate) const fn with_first_output(self, first_output: usize) -> Self {
        Declaration { first_output, ..self }
    }
    /// True if it refers to a frame {b}.
    pub fn needs_frame(&self) -> bool {
        matches!(self.of, Of::Frame | Of::Task)
    }
    /// The kernel's output that is this quantity's first one.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn first_output(&self) -> usize {
        self.first_output
    }
}

/// The frame, task or point that a quantity refers to, besides the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// The robot alone.
    Robot,
    /// A frame {b}.
    Frame,
    /// Rows of a frame's twist: see [`Task`](crate::Task).
    Task,
    /// A point of {s}, by default its origin.
    Point,
}

/// The length of an array's axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dim {
    /// n, the number of velocities.
    N,
    /// nq, the number of positions.
    Nq,
    /// [`Model::parameter_count`].
    Parameters,
    /// The moving links, a floating base first: those with ten parameters each.
    Bodies,
    /// The robot's frames.
    Frames,
    /// The task's rows.
    Rows,
    /// m, the rows of the robot's constraints.
    Constraints,
    /// A constant.
    Is(usize),
}

impl Dim {
    /// The number for this robot.
    pub fn size<C: Scalar>(self, model: &Model<C>, of: &Subject) -> usize {
        match self {
            Dim::N => model.n(),
            Dim::Nq => model.nq(),
            Dim::Parameters => model.parameter_count(),
            Dim::Bodies => model.bodies().count(),
            Dim::Frames => model.frames().len(),
            Dim::Rows => of.rows.len(),
            Dim::Constraints => model.constraint_rows(),
            Dim::Is(size) => size,
        }
    }
}

impl core::fmt::Display for Dim {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Dim::N => f.write_str("n"),
            Dim::Nq => f.write_str("nq"),
            Dim::Parameters => f.write_str("p"),
            Dim::Bodies => f.write_str("b"),
            Dim::Frames => f.write_str("frames"),
            Dim::Rows => f.write_str("k"),
            Dim::Constraints => f.write_str("m"),
            Dim::Is(size) => write!(f, "{size}"),
        }
    }
}

/// An input of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input {
    /// Its name in every interface.
    pub name: &'static str,
    /// Its symbol.
    pub symbol: &'static str,
    /// Its length.
    pub dim: Dim,
    /// Its unit for revolute joints, then for prismatic ones.
    pub unit: &'static str,
    /// A short description.
    pub about: &'static str,
}

const fn input(name: &'static str, symbol: &'static str, unit: &'static str, about: &'static str) -> Input {
    Input { name, symbol, dim: Dim::N, unit, about }
}
/// θ.
pub const THETA: Input = Input { dim: Dim::Nq, ..input("theta", "θ", "rad or m", "positions") };
/// θ̇.
pub const DTHETA: Input = input("dtheta", "θ̇", "rad/s or m/s", "velocities");
/// θ̈.
pub const DDTHETA: Input = input("ddtheta", "θ̈", "rad/s² or m/s²", "accelerations");
/// τ.
pub const TAU: Input = input("tau", "τ", FORCE, "joint forces and torques");
/// A constant vector.
pub const CONSTANT_VECTOR: Input = input("x", "x", ANY, "a constant vector");
/// A constant vector for something with six components, (angular, linear).
pub const CONSTANT_SIX: Input =
    Input { dim: Dim::Is(6), ..input("w", "w", ANY, "a constant vector for (angular, linear)") };

/// All inputs that quantities have.
pub const INPUTS: [Input; 6] = [THETA, DTHETA, DDTHETA, TAU, CONSTANT_VECTOR, CONSTANT_SIX];

/// An output of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its name in every interface.
    pub name: &'static str,
    /// Its shape; no axis for a number.
    pub dims: &'static [Dim],
    /// Its unit, if it has one, for revolute joints, then for prismatic ones.
    pub unit: &'static str,
    /// True for symmetric matrices, whose row- and column-major storage agree.
    pub is_symmetric: bool,
}

impl Output {
    /// Its shape for this robot.
    pub fn shape<C: Scalar>(&self, model: &Model<C>, of: &Subject) -> impl Iterator<Item = usize> {
        self.dims.iter().map(|dim| dim.size(model, of))
    }
    /// Its length for this robot.
    pub fn length<C: Scalar>(&self, model: &Model<C>, of: &Subject) -> usize {
        self.shape(model, of).product()
    }
}

pub(crate) const fn output(name: &'static str, dims: &'static [Dim], unit: &'static str) -> Output {
    Output { name, dims, unit, is_symmetric: false }
}
pub(crate) const fn symmetric(name: &'static str, dims: &'static [Dim], unit: &'static str) -> Output {
    Output { is_symmetric: true, ..output(name, dims, unit) }
}

pub(crate) const FORCE: &str = "N m or N";
pub(crate) const ACCELERATION: &str = DDTHETA.unit;
/// A unit that depends on that of a given vector.
pub(crate) const ANY: &str = "any";
/// The unit of ∂τ and of ∂θ̈.
pub(crate) const D_FORCE: &str = "N m or N, each per unit of its column";
pub(crate) const D_ACCELERATION: &str = "rad/s² or m/s², each per unit of its column";
pub(crate) const INERTIA: &str = "kg m², kg m or kg";
pub(crate) const NUMBER: &[Dim] = &[];
pub(crate) const VECTOR: &[Dim] = &[Dim::N];
pub(crate) const MATRIX: &[Dim] = &[Dim::N, Dim::N];
pub(crate) const SIX: &[Dim] = &[Dim::Is(6)];
pub(crate) const THREE: &[Dim] = &[Dim::Is(3)];
/// Angular rows first.
pub(crate) const JACOBIAN: &[Dim] = &[Dim::Is(6), Dim::N];
/// One Jacobian for each velocity.
pub(crate) const JACOBIANS: &[Dim] = &[Dim::N, Dim::Is(6), Dim::N];

/// Parts of the environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Uses(u8);

impl Uses {
    /// No part.
    pub const NOTHING: Uses = Uses(0);
    /// Gravity.
    pub const GRAVITY: Uses = Uses(1);
    /// Wrenches that frames apply to the environment.
    pub const WRENCHES: Uses = Uses(2);
    /// The twist of {s}.
    pub const BASE_TWIST: Uses = Uses(4);
    /// The acceleration of {s}.
    pub const BASE_ACCELERATION: Uses = Uses(8);
    /// All parts.
    pub const ALL: Uses = Uses(15);

    /// The union of both.
    pub const fn and(self, other: Uses) -> Uses {
        Uses(self.0 | other.0)
    }
    /// Whether it contains all parts of the other.
    pub const fn has(self, other: Uses) -> bool {
        self.0 & other.0 == other.0
    }
    /// The environment with these parts only; the others are zero gravity, rest, and no applied wrenches.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn of<'a, S: Scalar>(self, environment: &Environment<'a, S>) -> Environment<'a, S> {
        let nothing = Environment::with_gravity(crate::Vec3::zero());
        Environment {
            gravity: if self.has(Uses::GRAVITY) { environment.gravity } else { nothing.gravity },
            applied: if self.has(Uses::WRENCHES) { environment.applied } else { &[] },
            base_twist: if self.has(Uses::BASE_TWIST) { environment.base_twist } else { nothing.base_twist },
            base_acceleration: match self.has(Uses::BASE_ACCELERATION) {
                true => environment.base_acceleration,
                false => nothing.base_acceleration,
            },
        }
    }
}
