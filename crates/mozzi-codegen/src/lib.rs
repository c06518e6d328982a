//! A robot's dynamics as a straight-line program, and the program as machine code.
//!
//! - [`record_quantity`] a program: `mozzi`'s own kernel, run once on the scalar [`Traced`], without the operations
//!   that the robot's zeros and ones make superfluous, every operation once. [`Arguments`] name the numbers of the
//!   robot that stay inputs. A [`Program`] is printed, read, counted and evaluated in any [`Scalar`](mozzi::Scalar).
//! - [`Kernel`]: a program as machine code, for one state and for several, where the processor is an x86-64 with AVX2
//!   and FMA, or AVX-512. `mozzi_batch::compile` makes a robot of it.
//! - [`emit`] source text of programs: Rust without `std`, C99, CUDA C; [`emit_into`] a folder, for `build.rs`.
//! - [`record`] any computation on scalars, and make a [`Kernel`] of it.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use mozzi::quantities::InverseDynamics;
//! use mozzi_codegen::{Arguments, record_quantity};
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

mod arguments;
mod count;
mod emit;
mod estimate;
mod function;
mod jit;
mod needed;
mod program;
mod rates;
mod record;
mod robot_number;
mod tape;
mod text;
mod traced;

pub use arguments::{Arguments, Rates, pivot_names, record_quantity};
pub use count::Count;
pub use emit::{Block, CudaLayout, EmitError, Language, Precision, SourceFile, emit, emit_into, emit_programs};
pub use estimate::{LONGEST_TEXT, estimate, is_too_long};
pub use function::Function;
pub use jit::{Extent, Form, Kernel, MOST_ARRAYS, Refusal, Shape};
pub use program::{Array, Output, Program, Step, Value};
pub use record::record;
pub use text::NotAProgram;
pub use traced::Traced;
