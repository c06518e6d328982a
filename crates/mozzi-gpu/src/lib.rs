//! The dynamics of very many states on NVIDIA GPUs.
//!
//! A [`Source`] is a quantity of a robot as CUDA C: `mozzi-engine`'s program, one thread for each state. An [`Nvrtc`],
//! NVIDIA's run-time compiler, makes a [`Binary`] of it, for which no GPU is needed. A [`Device`] loads it as a
//! [`Kernel`], which reads and writes arrays where they are, on the caller's stream.
//!
//! The driver and NVRTC are loaded when they are first used: nothing of CUDA is needed to build a program that depends
//! on this crate, and without a GPU its calls return [`Error::NoDriver`] or [`Error::NoDevice`].
//!
//! ```
//! use mozzi::quantities::InverseDynamics;
//! use mozzi_gpu::{Device, Error, Form, Source};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let model = mozzi_urdf::open("ur5")?.build()?;
//! let source = Source::new(&model, InverseDynamics, Form::default())?; // f32, by rows
//! assert!(source.text().contains("ur5_inverse_dynamics_rows"));
//! match Device::first() {
//!     Ok(device) => {
//!         let kernel = device.kernel(&source)?;
//!         let (theta, dtheta, ddtheta) = (vec![0.1_f32; 6000], vec![0.2; 6000], vec![0.3; 6000]); // 1000 states
//!         let tau = &kernel.compute(&[&theta, &dtheta, &ddtheta])?[0];
//!         assert_eq!(tau.len(), 6000);
//!     }
//!     Err(Error::NoDriver { .. } | Error::NoDevice { .. }) => println!("no CUDA device"),
//!     Err(error) => return Err(error.into()),
//! }
//! # Ok(()) }
//! ```
//!
//! A state gives NaN where the CPU's ways return an error or have another way to compute it: if its mass matrix is
//! singular to rounding, or if an angle is beyond [`largest_angle`](mozzi_engine::Precision::largest_angle).

mod arch;
mod binary;
mod cache;
mod driver;
mod error;
mod guarded;
mod manifold;
mod number;
mod nvrtc;
mod order;
mod rollout;
mod source;

pub use arch::Arch;
pub use binary::{Binary, Resources};
pub use driver::{Device, DeviceArray, Kernel, Rollout, RolloutArrays, RolloutInputs, Steps, Stream};
pub use error::Error;
pub use number::Number;
pub use nvrtc::Nvrtc;
pub use source::{Argument, Form, Source};
