//! Identification from logs: `mozzi.identify`, `mozzi.excite`.

use crate::array::list;
use crate::failure::of_model;
use crate::interrupt::Interrupt;
use crate::model::{PyModel, array};
use crate::motion::limits::one_or_each;
use mozzi::Model;
use mozzi_identify::excite::{ExciteOptions, excite};
use mozzi_identify::judgement::judge;
use mozzi_identify::signals::{Acceleration, Cutoff, Filter};
use mozzi_identify::{Choice, Error, Limits, Log, Options, Sensor, describe, identify, predict};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

fn of_identification(error: Error) -> PyErr {
    match error {
        Error::Model(error) => of_model(error),
        other => PyValueError::new_err(other.to_string().replace("--trust-log fits", "trust_log=True fits")),
    }
}

/// The names of a log, beside wrenches.
const KEYS: [&str; 6] = ["t", "theta", "dtheta", "ddtheta", "tau", "target"];

/// A log from a mapping of arrays: t, theta, tau, and dtheta, ddtheta, target, `wrench` of the end effector or
/// `wrench_FRAME` if they are there. Of a floating base, tau may have the joints' columns alone.
fn log(model: &Model, given: &Bound<'_, PyAny>, number: usize) -> PyResult<Log> {
    let need = |name: &str| {
        given
            .get_item(name)
            .map_err(|_| PyValueError::new_err(format!("log {number} has no '{name}', expected t, theta and tau")))
    };
    let t = need("t")?;
    let rows = t.len()?;
    let optional = |name: &'static str| -> PyResult<Option<Vec<f64>>> {
        match given.contains(name)? {
            true => list(name, &given.get_item(name)?, &[rows, model.n()]).map(Some),
            false => Ok(None),
        }
    };
    let target = optional("target")?;
    if target.is_some() && !model.configuration_space().is_flat() {
        let expected = "expected joints of one axis on a fixed base";
        return Err(PyValueError::new_err(format!("log {number} has a 'target', {expected}")));
    }
    let mut wrenches = Vec::new();
    for name in given.call_method0("keys")?.try_iter()? {
        let name: String = name?.extract()?;
        let frame = match name.strip_prefix("wrench_") {
            Some(frame) => model.frame(frame),
            None if name == "wrench" => model.end_effector(),
            None if KEYS.contains(&name.as_str()) => continue,
            None => {
                // a table of the joints under another name; energies and the like are no matter
                let width = given.get_item(&name)?.getattr("shape").and_then(|shape| shape.extract::<(usize, usize)>());
                if width.is_ok_and(|(_, width)| [model.n(), model.nq()].contains(&width)) {
                    let keys = KEYS.join(", ");
                    let text = format!("log {number} has '{name}', expected {keys}, wrench or wrench_FRAME");
                    return Err(PyValueError::new_err(text));
                }
                continue;
            }
        };
        wrenches.push((frame.map_err(of_model)?, list("wrench", &given.get_item(&name)?, &[rows, 6])?));
    }
    let (n, base) = (model.n(), model.base().velocities());
    let tau = need("tau")?;
    let width = tau.getattr("shape").and_then(|shape| shape.extract::<(usize, usize)>());
    let tau = match base > 0 && width.is_ok_and(|(_, width)| width == n - base) {
        true => {
            let (joints, zeros) = (list("tau", &tau, &[rows, n - base])?, vec![0.0; base]);
            joints.chunks_exact((n - base).max(1)).flat_map(|row| [&zeros[..], row].concat()).collect()
        }
        false => list("tau", &tau, &[rows, n])?,
    };
    Ok(Log {
        name: format!("log {number}"),
        t: list("t", &t, &[rows])?,
        theta: list("theta", &need("theta")?, &[rows, model.nq()])?,
        dtheta: optional("dtheta")?,
        ddtheta: optional("ddtheta")?,
        tau,
        target,
        wrenches,
        ..Log::default()
    })
}

/// The value of an option; None if it is missing or None.
fn option<'py, T>(options: &Bound<'py, PyDict>, name: &str) -> PyResult<Option<T>>
where
    T: for<'a> FromPyObject<'a, 'py, Error = PyErr>,
{
    match options.get_item(name)? {
        Some(value) if !value.is_none() => value.extract().map(Some),
        _ => Ok(None),
    }
}

fn choice(model: &Model, options: &Bound<'_, PyDict>) -> PyResult<Choice> {
    let torque: String = option(options, "torque")?.unwrap_or_else(|| "motor".into());
    let sensor = match torque.as_str() {
        "motor" => Sensor::Motor,
        "link" => Sensor::Link,
        other => return Err(PyValueError::new_err(format!("torque is '{other}', expected 'motor' or 'link'"))),
    };
    let only: Option<String> = option(options, "only")?;
    if let (Some(frame), false) = (option::<String>(options, "payload")?, only.as_deref() == Some("payload")) {
        return Err(PyValueError::new_err(format!("payload is '{frame}', which only=\"payload\" estimates alone")));
    }
    let mut choice = match only.as_deref() {
        None => Choice::all(sensor),
        Some("friction") => Choice::only_friction(sensor),
        Some("payload") => {
            let frame = match option::<String>(options, "payload")? {
                Some(name) => model.frame(&name),
                None => model.end_effector(),
            };
            Choice::only_payload(frame.map_err(of_model)?, sensor)
        }
        Some(other) => {
            return Err(PyValueError::new_err(format!("only is '{other}', expected 'payload' or 'friction'")));
        }
    };
    choice.width = option(options, "width")?.unwrap_or(choice.width);
    choice.stribeck = option(options, "stribeck")?;
    choice.stiffness = option(options, "springs")?.unwrap_or(false);
    choice.offset = option(options, "offsets")?.unwrap_or(true);
    Ok(choice)
}

/// Identify a robot from logs; `mozzi.identify` names the results.
///
/// Returns the report as JSON and as HTML, the identified robot, and the times, measured and predicted forces, N × n,
/// of the samples that were used of each log.
#[pyfunction]
#[allow(clippy::type_complexity)] // a tuple for Python, which names its parts
pub fn _identify<'py>(
    py: Python<'py>,
    model: &Bound<'py, PyModel>,
    logs: Vec<Bound<'py, PyAny>>,
    validate: Vec<Bound<'py, PyAny>>,
    options: &Bound<'py, PyDict>,
) -> PyResult<(String, String, PyModel, Vec<[Bound<'py, PyAny>; 3]>)> {
    let whole = &model.get().robot().model;
    let locks: Vec<(String, f64)> = option(options, "lock")?.unwrap_or_default();
    let locks: Vec<(&str, f64)> = locks.iter().map(|(name, position)| (name.as_str(), *position)).collect();
    let robot = if locks.is_empty() { whole.clone() } else { whole.with_locked_joints(&locks).map_err(of_model)? };
    let read = |all: &[Bound<'py, PyAny>]| -> PyResult<Vec<Log>> {
        all.iter().enumerate().map(|(k, given)| log(&robot, given, k + 1)).collect()
    };
    let (logs, validate) = (read(&logs)?, read(&validate)?);
    let cutoff = match option::<f64>(options, "cutoff")? {
        Some(f64::INFINITY) => Cutoff::None,
        Some(f) => Cutoff::Hz(f),
        None => Cutoff::Automatic,
    };
    let spline: bool = option(options, "spline")?.unwrap_or(false);
    let acceleration = if spline { Acceleration::Spline } else { Acceleration::Differences };
    let total_mass: Option<(f64, f64)> = option(options, "total_mass")?;
    let fit: f64 = option(options, "fit")?.unwrap_or(1.0);
    if !(fit > 0.0 && fit <= 1.0 && (10.0 * fit - (10.0 * fit).round()).abs() < 1e-9) {
        return Err(PyValueError::new_err(format!("fit is {fit}, expected a part of the log: 0.1, 0.2, … or 1")));
    }
    let settings = Options {
        choice: choice(&robot, options)?,
        filter: Filter { cutoff, acceleration, ..Filter::default() },
        prior: option(options, "prior")?.unwrap_or(0.3),
        robust: option(options, "robust")?.unwrap_or(false),
        limits: Limits { total_mass: total_mass.map(|(m, d)| [m, d]), ..Limits::default() },
        tenths: (10.0 * fit).round() as usize,
        trust_log: option(options, "trust_log")?.unwrap_or(false),
    };
    let interrupt = Interrupt::new();
    let stop = || interrupt.stop();
    let work = || -> Result<_, Error> {
        let found = identify(&robot, &logs, &settings, &stop)?;
        let mut judged = judge(&found, &logs)?;
        let mut validations = Vec::new();
        for (k, log) in validate.iter().enumerate() {
            let (errors, _, findings) = found.validate(log, &settings.filter)?;
            judged.findings.extend(findings);
            validations.push((format!("validation {}", k + 1), errors));
        }
        let x = &found.estimates.consistent.x;
        let (description, findings) = describe(&found.setup.columns, x, whole.description())?;
        judged.findings.extend(findings);
        let json = mozzi_report::fit_json(&found, &judged, &validations).to_string();
        let html = mozzi_report::fit_html(&found, &judged, &validations);
        let mut series = Vec::new();
        for samples in &found.samples {
            series.push((
                samples.t.clone(),
                samples.tau.clone(),
                predict(&found.setup.columns, &found.estimates.consistent.predicting(), samples)?,
            ));
        }
        Ok((json, html, description, series))
    };
    let found = py.detach(work);
    interrupt.check()?;
    let (json, html, description, series) = found.map_err(of_identification)?;
    let n = robot.n();
    let mut tables = Vec::new();
    for (t, measured, predicted) in series {
        let N = t.len();
        tables.push([array(py, &[N], t)?, array(py, &[N, n], measured)?, array(py, &[N, n], predicted)?]);
    }
    Ok((json, html, PyModel::built(description.build())?, tables))
}

/// Find an exciting motion; `mozzi.excite` names the results.
///
/// Returns t, θ, θ̇ and θ̈, the condition number and that of a random motion, and the base parameters with their
/// expected standard deviations.
#[pyfunction]
#[allow(clippy::type_complexity)] // a tuple for Python, which names its parts
pub fn _excite<'py>(
    py: Python<'py>,
    model: &Bound<'py, PyModel>,
    duration: f64,
    step: f64,
    options: &Bound<'py, PyDict>,
) -> PyResult<([Bound<'py, PyAny>; 4], f64, f64, Vec<(String, f64, f64)>)> {
    let robot = &model.get().robot().model;
    let mut settings = ExciteOptions::new(robot, duration);
    if !(step > 0.0 && step <= duration && duration / step < 1e7) {
        let expected = "a number of seconds from a ten-millionth of the duration to the duration";
        return Err(PyValueError::new_err(format!("step is {step} and duration {duration}, expected {expected}")));
    }
    let n = robot.n();
    let limits = &mut settings.limits;
    for (name, place) in [
        ("velocity", &mut limits.velocity),
        ("acceleration", &mut limits.acceleration),
        ("torque_limit", &mut limits.torque),
        ("noise", &mut settings.noise),
    ] {
        if let Some(given) = options.get_item(name)?.filter(|given| !given.is_none()) {
            *place = one_or_each(name, &given, n)?;
        }
    }
    settings.harmonics = option(options, "harmonics")?.unwrap_or(settings.harmonics);
    settings.rate = option(options, "rate")?.unwrap_or(settings.rate);
    settings.choice = choice(robot, options)?;
    let interrupt = Interrupt::new();
    let stop = || interrupt.stop();
    let found = py.detach(|| excite(robot, &settings, &stop));
    interrupt.check()?;
    let found = found.map_err(of_identification)?;
    let t = mozzi_motion::trajectories::times(step, duration);
    let mut tables: [Vec<f64>; 3] = Default::default();
    for &t in &t {
        tables.iter_mut().zip(found.at(t)).for_each(|(table, row)| table.extend(row));
    }
    let [theta, dtheta, ddtheta] = tables;
    let shape = [t.len(), n];
    let arrays = [
        array(py, &shape[..1], t)?,
        array(py, &shape, theta)?,
        array(py, &shape, dtheta)?,
        array(py, &shape, ddtheta)?,
    ];
    Ok((arrays, found.condition, found.condition_of_random, found.parameters))
}

/// Return the names and texts of the files that hold this robot's numbers, edited.
#[pyfunction]
pub fn _edited_files(
    name: &str,
    text: &str,
    model: &Bound<'_, PyModel>,
    old_values: bool,
) -> PyResult<Vec<(String, String)>> {
    let robot = model.get().robot().model.description();
    let files = mozzi_urdf::edit_files(name, text, robot, old_values, &mozzi_urdf::Settings::default());
    let files = files.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(files.into_iter().map(|file| (file.name, file.text)).collect())
}
