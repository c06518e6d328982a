//! The dynamics of many states at once: [`mozzi`]'s kernels, unchanged, on registers that hold one number of 2 to 16
//! states, and on all cores.
//!
//! ```
//! use mozzi::quantities::InverseDynamics;
//! use mozzi_batch::Batch;
//! # use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid};
//! # let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
//! # let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
//! # let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
//! # let model = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
//! let batch = Batch::new(&model); // the machine's widest registers, all its cores
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
//! Results agree with those at one state to rounding, on [`InstructionSet::Portable`] bit for bit; they do not depend
//! on the number of threads. A NaN or an infinity in a state gives NaN in that state's results and in no other's.

mod batch;
mod chunk;
mod columns;
mod compiled;
mod directional;
mod engine;
mod environment;
mod error;
mod in_place;
mod instruction_set;
mod interpreter;
mod lanes;
mod number;
mod pool;
mod programmed;
mod registers;
mod request;
mod rollout;
mod run;
mod simulate;
mod threads;
mod worker;

pub use batch::Batch;
pub use columns::Layout;
pub use compiled::{Compiled, compile};
pub use directional::Direction;
pub use engine::Engine;
pub use environment::BatchEnvironment;
pub use error::Error;
pub use instruction_set::InstructionSet;
pub use lanes::Lane;
pub use number::Number;
pub use rollout::{BatchGradient, BatchRollout};
