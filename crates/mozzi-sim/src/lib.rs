//! Simulation: forward dynamics, integrated (Modern Robotics, section 8.5).
//!
//! > q̇₁ = q₂,  q̇₂ = FD(q₁, q₂, τ, F),  with q₁ = θ and q₂ = θ̇
//!
//! [`simulate`] takes a start, an [`Input`] (τ and the wrenches on the environment, by functions or tables) and
//! [`Options`], and returns a [`Trajectory`] with its energies. {s} is at rest. Dry friction
//! sticks, see [`Friction`]; planes stop [`Contacts`].
//!
//! | [`Method`] | order | step | for |
//! |---|---|---|---|
//! | `Euler`, `SemiImplicitEuler`, `RungeKutta4` | 1, 1, 4 | fixed | the book's loop; real time |
//! | `DormandPrince` | 5 | adaptive | smooth motions, to a tolerance |
//! | `Midpoint` | 2 | fixed | long motions: the energy's error is bounded |
//! | `MoreauJean` | 2 | fixed | dry friction, stops, contacts: `Automatic` is it for them, else `RungeKutta4` |
//!
//! A robot with [constraints](mozzi::constraints) moves by its constrained forward dynamics, and is brought back onto
//! the constraints after each step: [`Ending::closing`] reports by how much.
//!
//! Dry friction, stops and contacts are solved for as impulses of a step ([`one_sided`]), by
//! `MoreauJean` alone; other methods are for smooth motions, and refuse them. A step ends where a joint with dry
//! friction comes to rest. [`Ending::one_sided`] reports the residuals.
//!
//! Gradients of a loss through N steps, by start, torques and parameters: [`Rollout`].
//!
//! All methods integrate on SE(3) if the base floats, and all run in one loop, [`Simulation`]. It locates [`Event`]s,
//! zeros of functions of (t, θ, θ̇), on the polynomial between two steps, treats the joints' limits by a [`Policy`],
//! and passes each row to a [`Recorder`], so that a long motion need not be kept in memory.
#![cfg_attr(not(test), no_std)]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

mod closing;
mod contacts;
mod course;
mod drift;
mod driven;
mod equation;
mod error;
mod events;
mod factored_mass;
mod friction;
mod impulses;
mod inputs;
mod methods;
pub mod one_sided;
mod options;
mod recorder;
mod rollout;
mod sensitivity;
mod simulation;
mod stall;
mod state;
#[cfg(test)]
mod tests;
mod trajectory;

pub use closing::{Closer, Closing};
pub use contacts::{ContactChange, ContactEvent, ContactForce, Contacts, Plane, PlaneMotion};
pub use equation::{Equation, ForwardDynamics, Powers, forward_dynamics_of};
pub use error::Error;
pub use events::{Direction, Event, EventFunction, Occurrence, Policy, Stopped};
pub use impulses::OneSidedAccount;
pub use inputs::{GravityCompensation, Input, Outside, Table, TorqueTable, WrenchTable, Zero, applied, torque};
pub use methods::{Explicit, Method, Motion, dormand_prince_by_equal_steps};
pub use mozzi::model::{ContactPoint, Support};
pub use options::{Friction, LARGEST, Options};
pub use recorder::{Account, Recorder, Thinned, stride};
pub use rollout::{
    Cotangents, ExplicitSteps, ParameterGradient, Rollout, RolloutGradient, RolloutStates, Stage, StageDynamics,
    StartGradient, Stepper, Steps, Tables,
};
pub use sensitivity::{EndSensitivity, StepSensitivity, held_step, sensitivities, step_sensitivity};
pub use simulation::{Ending, Run, Simulation, simulate};
pub use trajectory::{Energy, Sample, Trajectory};
