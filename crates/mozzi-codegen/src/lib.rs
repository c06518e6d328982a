//! A robot's dynamics as a straight-line program, and the program as machine code.
//!
//! - [`compile`] a robot: an object with the model's methods, for one state and for many, that runs machine code made for this robot, where
//!   the processor is an x86-64 with AVX2 and FMA, or AVX-512; elsewhere the kernels. [`Compiled::engine`] says which.
//! - [`Quantity::record`] a program: `mozzi`'s own kernel, run once on the scalar [`Traced`], without all that the robot's zeros and ones make
//!   superfluous, every operation once. [`Arguments`] tells which numbers of the robot stay inputs. A [`Program`] is printed, read, counted and
//!   evaluated in any [`Scalar`](mozzi::Scalar).
//! - [`emit`] source text of programs: Rust without `std`, C99, CUDA C; [`emit_into`] a folder, for `build.rs`. Without the feature `batch`,
//!   which build scripts do not need, there is no [`compile`], and nothing of `mozzi-batch` is built.
//! - [`record`] any computation on scalars, and make a [`Kernel`] of it.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mozzi_codegen::{Arguments, Quantity};
//! let model = mozzi_urdf::open("ur5")?.build()?;
//! let program = Quantity::InverseDynamics.record(&model, Arguments::default());
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

#[cfg(feature = "batch")]
mod batch;
#[cfg(feature = "batch")]
mod compiled;
mod count;
mod emit;
mod function;
mod jit;
mod program;
mod quantity;
mod record;
#[cfg(feature = "batch")]
mod simulate;
mod tape;
mod text;
mod traced;

#[cfg(feature = "batch")]
pub use compiled::{Compiled, Engine, compile};
pub use count::Count;
pub use emit::{EmitError, Language, Precision, SourceFile, emit, emit_into, emit_programs};
pub use function::Function;
pub use jit::{Kernel, LONGEST_CODE, Refusal, Shape};
pub use program::{Array, Output, Program, Step, Value};
pub use quantity::{Arguments, Quantity};
pub use record::record;
pub use text::NotAProgram;
pub use traced::Traced;
