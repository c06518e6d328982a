//! mozzi in a web page: a robot is loaded from text, its inputs are set, and quantities are read by name.
//!
//! The page of `--report` and `view` computes with this crate, compiled to WebAssembly without imports. [`Session`]
//! holds the robots, [`abi`] is its interface for JavaScript. There are two kinds of quantities: those of
//! [`mozzi::quantities::LIST`], and those of [`drawn::LIST`], which only a picture needs (such as the velocities of
//! the bodies' centres of mass in {s}). Both are requested by name and have the same inputs.
//!
//! Numbers are exchanged in arrays that stay in place, everything else as JSON. Errors are texts.
pub mod abi;
mod about;
mod applied;
mod bodies;
pub mod drawn;
#[cfg(feature = "play")]
mod play;
mod request;
mod robot;
mod session;

pub use robot::Robot;
pub use session::Session;
