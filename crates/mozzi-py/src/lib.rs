//! mozzi in Python: converts and checks arguments, calls the library, converts errors. No mathematics.

mod arguments;
mod array;
mod call;
mod command_line;
mod compare;
mod conventions;
mod counts;
mod derivation;
mod describe;
mod environment;
mod failure;
mod gpu;
mod html;
mod identify;
mod interrupt;
mod jax;
mod load;
mod methods;
mod model;
mod modern_robotics;
mod motion;
mod numpy;
mod results;
mod robot;
mod signature;
mod simulate;
mod threads;

use pyo3::prelude::*;

/// The compiled part of mozzi.
#[pymodule(name = "_mozzi")]
fn python_module(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    numpy::prepare(py)?;
    robot::remember_process();
    module.add_class::<model::PyModel>()?;
    methods::add_to(&py.get_type::<model::PyModel>())?;
    module.add_class::<derivation::PyDerivation>()?;
    module.add_class::<gpu::GpuKernel>()?;
    module.add_class::<gpu::GpuRollout>()?;
    module.add_class::<conventions::Pinocchio>()?;
    module.add_class::<conventions::MuJoCo>()?;
    module.add_function(wrap_pyfunction!(compare::_compare, module)?)?;
    module.add_function(wrap_pyfunction!(identify::_identify, module)?)?;
    module.add_function(wrap_pyfunction!(identify::_excite, module)?)?;
    module.add_function(wrap_pyfunction!(identify::_edited_files, module)?)?;
    module.add_function(wrap_pyfunction!(command_line::_command_line, module)?)?;
    jax::add_to(module)?;
    motion::add_to(module)?;
    modern_robotics::add_to(module)?;
    module.add("LoadError", py.get_type::<failure::LoadError>())?;
    module.add("LoadWarning", py.get_type::<failure::LoadWarning>())?;
    module.add("DynamicsWarning", py.get_type::<failure::DynamicsWarning>())?;
    module.add("SingularError", py.get_type::<failure::SingularError>())?;
    module.add("DivergedError", py.get_type::<failure::DivergedError>())?;
    module.add("MotionError", py.get_type::<failure::MotionError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    let embedded: Vec<&str> = mozzi_urdf::embedded::names().collect();
    module.add("_embedded_names", embedded)
}
