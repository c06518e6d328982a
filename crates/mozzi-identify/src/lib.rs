//! The robot that you have, from its own log.
mod choice;
mod columns;
mod compress;
mod describe;
mod error;
pub mod estimate;
pub mod excite;
mod finding;
mod identify;
pub mod judgement;
mod log;
mod payload;
mod predict;
mod setup;
pub mod signals;

pub use choice::{Choice, Sensor};
pub use columns::{Columns, Equations, Kind, Unknown};
pub use compress::{Compressed, Evidence, Pattern, Triangle, stacked};
pub use describe::describe;
pub use error::Error;
pub use finding::{Finding, Level};
pub use identify::{Errors, Identification, Options, identify};
pub use log::{Log, Rows};
pub use payload::Carried;
pub use predict::{identified, parameters, predict};
pub use setup::{Estimates, Limits, Setup};
