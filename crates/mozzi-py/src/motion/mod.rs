//! Motions: `mozzi.InverseKinematics`, `mozzi.trajectories`, `mozzi.controllers`, computed by `mozzi-motion`.

mod controller;
mod frame_path;
mod goals;
mod instants;
mod inverse_kinematics;
pub mod limits;
mod path;
mod profile;
mod reference;
mod repr;
mod saturated;
mod solutions;
mod standing;
mod states;
mod tracking;

pub use instants::Instants;
use pyo3::prelude::*;
pub use saturated::check_motors;

/// The classes, in the compiled part.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<inverse_kinematics::PyInverseKinematics>()?;
    module.add_class::<profile::PyProfile>()?;
    module.add_class::<path::PyPath>()?;
    module.add_class::<path::PyLine>()?;
    module.add_class::<path::PySpline>()?;
    module.add_class::<path::PyCartesian>()?;
    module.add_function(wrap_pyfunction!(frame_path::poses_between, module)?)?;
    module.add_class::<reference::PyReference>()?;
    module.add_class::<reference::PyTimed>()?;
    module.add_class::<reference::PyRecorded>()?;
    module.add_class::<reference::PyHold>()?;
    module.add_class::<reference::PyOfJoints>()?;
    module.add_class::<controller::PyController>()?;
    module.add_class::<controller::PyPdGravity>()?;
    module.add_class::<controller::PyComputedTorque>()?;
    module.add_class::<controller::PyTaskSpace>()?;
    module.add_class::<controller::PyImpedance>()?;
    module.add_class::<standing::PyStanding>()?;
    module.add_class::<saturated::PySaturated>()?;
    module.add_function(wrap_pyfunction!(tracking::tracking_error, module)?)
}
