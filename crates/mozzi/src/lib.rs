//! Dynamics of robots in the screw notation of Lynch and Park, *Modern Robotics*:
//!
//! > τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ, θ̇)
//!
//! ```
//! use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid};
//!
//! // a 2R arm of two rods, 1 m and 1 kg each, turning about y; frames at the centres of mass
//! let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
//! let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0])); // M_1, M_2, and the tip's
//! let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
//! let model = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
//!
//! let (theta, dtheta, ddtheta) = ([0.3, -0.5], [1.0, 0.2], [0.0, 2.0]);
//! let environment = model.environment(); // gravity −9.81 along z, base at rest, no applied wrenches
//! let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment)?;
//! let round_trip = model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &environment)?;
//! assert!((round_trip[1] - 2.0).abs() < 1e-12);
//! # Ok::<(), mozzi::Error>(())
//! ```
//!
//! - Robots: [`Description`] (from screw lists, by hand, or from a file with `mozzi-urdf`), built into a [`Model`].
//! - Quantities: methods of [`Model`], which check their arguments, allocate and return nalgebra's types; or the
//!   functions of [`dynamics`] and [`kinematics`], kernels on slices, generic over the number type, without allocation;
//!   or [`fast`], the kernels on `f64` with the machine's instruction set, for control loops.
//! - The book's intermediate results: [`Model::screws`], [`Model::closed_form`], [`Model::newton_euler`].
//! - Simulation: the crate `mozzi-sim`.
//! - Derivatives: along any direction, [`Model::directional_derivative`]; with respect to a robot's parameters,
//!   [`Model::with_parameter_tangent`]; the regressor, [`Model::regressor`].
//! - Conversions to and from Pinocchio and MuJoCo: [`conventions`].
//!
//! Six-vectors are angular first: twists (ω, v), wrenches (m, f). SI units. Applied wrenches are those of the robot on
//! the environment. Without the default feature `std` the crate is `no_std` with `alloc`, and uses `libm`.
#![cfg_attr(not(test), no_std)]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod accuracy;
pub mod constraints;
pub mod conventions;
pub mod dynamics;
pub mod fast;
pub mod kinematics;
pub mod lie;
pub mod linalg;
pub mod model;
pub mod quantities;
pub mod random;
pub mod scalar;
pub mod spatial;
pub mod spelling;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
mod workspace;

pub use constraints::{ConstrainedDynamics, ConstrainedForwardDynamicsDerivatives, ConstraintRank, Reduction};
pub use dynamics::results::*;
pub use dynamics::{BaseParameters, ClosedForm, Entry};
pub use kinematics::Jacobian;
pub use lie::{SE3, SO3};
pub use linalg::{Mat3, Sym3, Vec3};
pub use model::{
    Base, ConfigurationSpace, Description, Environment, Error, Frame, FrameId, Freedom, HomeFrames, Model, Pivots,
    Place, Screws, Task, TaskFrame, TaskMemory, least_is_clear,
};
pub use nalgebra;
pub use scalar::{Dual, Real, Scalar};
pub use spatial::solids::Solid;
pub use spatial::{ScrewAxis, SpatialInertia, Twist, Wrench};
pub use workspace::{ConstraintMemory, Workspace};
