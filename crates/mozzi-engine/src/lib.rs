//! Quantities of many states at once, and of one robot as fast as its machine allows.
//!
//! A quantity's **program** is [`mozzi`]'s own kernel, run once on a number that records its operations. The program is
//! evaluated in any number, differentiated, written as Rust, C or CUDA, and becomes machine code on an x86-64 with AVX2
//! and FMA, or AVX-512, and on AArch64. A [`Batch`] does this by itself, as soon as it pays; without machine code it
//! runs the kernel, state by state, on all cores.
//!
//! ```
//! use mozzi::quantities::InverseDynamics;
//! use mozzi_engine::Batch;
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
//! # Ok::<(), mozzi_engine::Error>(())
//! ```
//!
//! Results agree with those at one state to rounding; they do not depend on the number of threads. A NaN
//! or an infinity in a state gives NaN in that state's results and in no other's.
//!
//! - [`record_quantity`] a program: without the operations that the robot's zeros and ones make superfluous, every
//!   operation once. [`Arguments`] name the numbers of the robot that stay inputs; [`record`] takes any computation.
//! - [`compile`] a robot's quantities for one state and for many; a [`Kernel`] is one program as machine code.
//! - [`emit`] source text of programs: Rust without `std`, C99, CUDA C; [`emit_into`] a folder, for `build.rs`;
//!   [`emit_casadi`] functions and Jacobians for `casadi.external`.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mozzi::quantities::InverseDynamics;
//! use mozzi_engine::{Arguments, record_quantity};
//! let model = mozzi_urdf::open("ur5")?.build()?;
//! let program = record_quantity(&model, InverseDynamics, Arguments::default())?;
//! let before = program.count_before_folding().ok_or("recorded here")?;
//! println!("{before}\n{}", program.count()); // 1710 flops, of which 380 are left
//! assert!(program.count().flops() < before.flops() / 4);
//! let tau = program.evaluate(&[&[0.1; 6], &[0.2; 6], &[0.3; 6]]);
//! let reference = model.inverse_dynamics(&[0.1; 6], &[0.2; 6], &[0.3; 6], &model.environment())?;
//! assert!(tau[0].iter().zip(&reference).all(|(a, b)| (a - b).abs() < 1e-12));
//! # Ok(()) }
//! ```
//!
//! `unsafe` is in one module, with its argument: `jit/executable.rs`.

mod emit;
mod jit;
mod many;
mod program;

pub use emit::{
    Block, CudaLayout, EmitError, Language, Precision, SourceFile, emit, emit_casadi, emit_into, emit_programs,
};
pub use jit::{Extent, Form, Kernel, Listing, MOST_ARRAYS, Refusal, Shape, Tally};
pub use many::{
    Batch, BatchEnvironment, BatchGradient, BatchRollout, Compiled, Direction, Engine, Error, Number, compile,
};
pub use program::{
    Arguments, Array, Count, Derivative, Function, LONGEST_TEXT, NotAProgram, Output, Product, Program, Step, TooLong,
    Traced, Value, estimate, is_too_long, pivot_names, record, record_numbers, record_quantity,
};
