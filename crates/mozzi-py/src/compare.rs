//! Comparison with other libraries on the same robot: `mozzi.compare`.

use crate::failure::{of_loader, of_model};
use crate::interrupt::waited;
use crate::load;
use crate::model::PyModel;
use mozzi_report::compare::{Comparison, Error, Options, Source, ask, compare};
use mozzi_urdf::LoadError;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::path::PathBuf;

fn of_comparison(error: Error) -> PyErr {
    match error {
        Error::Robot(error) => of_model(error),
        error @ (Error::Python { .. } | Error::NoLibrary { .. }) => PyRuntimeError::new_err(error.to_string()),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// Compare a robot with other libraries: text, JSON, and whether all results agree and are explained.
#[pyfunction]
pub fn _compare(
    py: Python<'_>,
    robot: &Bound<'_, PyAny>,
    states: usize,
    seed: u64,
    python: PathBuf,
    policy: &str,
) -> PyResult<(String, String, bool, bool)> {
    let options = Options { python, states, seed, time_limit: mozzi_report::compare::TIME_LIMIT };
    let report = |c: &Comparison| (c.text(), c.json().to_string(), c.agrees(), c.is_explained());
    if let Ok(model) = robot.cast::<PyModel>() {
        let (description, robot) = (model.get().robot().model.description(), model.clone().unbind());
        let source = Source::written(&description.name, description).map_err(of_comparison)?;
        let found = waited(py, move || compare(&robot.get().robot().model, source, &options))?;
        return found.map(|c| report(&c)).map_err(of_comparison);
    }
    let path: PathBuf = robot.extract()?;
    let name = path.to_string_lossy();
    if path.extension().is_some_and(|ending| ending == "json") {
        let model = load::any(robot, policy, false, &load::Xacro::default())?;
        let source = Source::written(&name, model.description()).map_err(of_comparison)?;
        let found = waited(py, move || compare(&model, source, &options))?;
        return found.map(|c| report(&c)).map_err(of_comparison);
    }
    match load::loaded(py, &name, policy)? {
        Ok(loaded) => {
            let model = load::build(py, Ok(loaded), false)?;
            let source = Source::read(&name, model.description()).map_err(of_comparison)?;
            let found = waited(py, move || compare(&model, source, &options))?;
            found.map(|c| report(&c)).map_err(of_comparison)
        }
        // the file exists but is invalid: report whether the other libraries load it
        Err(refusal @ LoadError::Refused { .. }) => {
            let source = Source::read(&name, &mozzi::Description::new("refused")).map_err(of_comparison)?;
            let found = waited(py, move || ask(source, &options))?.map_err(of_comparison)?;
            let (text, json, agrees, explained) = report(&found);
            Ok((format!("{refusal}\n{text}"), json, agrees, explained))
        }
        Err(error) => Err(of_loader(py, error)),
    }
}
