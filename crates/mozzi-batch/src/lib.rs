//! The dynamics of many states at once, on all cores: a quantity's program, recorded from [`mozzi`]'s kernel, as
//! machine code for 4 to 16 states in a register; the kernel itself, state by state, where there is no machine code or
//! too few states for it.
//!
//! ```
//! use mozzi::quantities::InverseDynamics;
//! use mozzi_batch::Batch;
//! # use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid};
//! # let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
//! # let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
//! # let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
//! # let model = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
//! let batch = Batch::new(&model); // all cores
//! let states = 1000;
//! let theta: Vec<f64> = (0..states * model.nq()).map(|k| (k as f64).sin()).collect(); // row-major: (1000, 2)
//! let (dtheta, ddtheta) = (vec![0.5; states * model.n()], vec![0.0; states * model.n()]);
//! let mut tau = vec![0.0; states * model.n()];
//! batch.compute(InverseDynamics, &[&theta, &dtheta, &ddtheta], &model.environment().into(), &mut [&mut tau])?;
//! let one = model.inverse_dynamics(&theta[8..10], &dtheta[8..10], &ddtheta[8..10], &model.environment())?;
//! assert!((tau[8] - one[0]).abs() < 1e-13 && (tau[9] - one[1]).abs() < 1e-13);
//! # Ok::<(), mozzi_batch::Error>(())
//! ```
//!
//! Results agree with those at one state to rounding; they do not depend on the number of threads. A NaN
//! or an infinity in a state gives NaN in that state's results and in no other's.

mod batch;
mod check;
mod chunk;
mod code;
mod compiled;
mod directional;
mod engine;
mod environment;
mod error;
mod kernels;
mod number;
mod once;
mod pool;
mod programs;
mod request;
mod rollout;
mod simulate;
mod threads;

pub use batch::Batch;
pub use compiled::{Compiled, compile};
pub use directional::Direction;
pub use engine::Engine;
pub use environment::BatchEnvironment;
pub use error::Error;
pub use number::Number;
pub use rollout::{BatchGradient, BatchRollout};
