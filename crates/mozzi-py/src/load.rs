//! Loads robots from files, texts, names and the book's lists.

use crate::array::{Numbers, wrong_shape};
use crate::failure::{DynamicsWarning, LoadWarning, of_loader, of_model, warn};
use mozzi::model::Base;
use mozzi::spatial::NotAScrew;
use mozzi::{Description, HomeFrames, Model, SE3, ScrewAxis, Screws, SpatialInertia};
use mozzi_urdf::json;
use mozzi_urdf::{Consequence, LoadError, Loaded, Policy, Settings, XacroArguments};
use pyo3::exceptions::{PyFileNotFoundError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use std::path::PathBuf;

fn policy(name: &str) -> PyResult<Policy> {
    match name {
        "default" => Ok(Policy::Default),
        "strict" => Ok(Policy::Strict),
        "lenient" => Ok(Policy::Lenient),
        other => Err(PyValueError::new_err(format!("policy is '{other}', expected 'default', 'strict' or 'lenient'"))),
    }
}

/// An embedded robot by its name, or a file.
pub fn loaded(py: Python<'_>, name_or_path: &str, how: &str) -> PyResult<Result<Loaded, LoadError>> {
    let policy = policy(how)?;
    Ok(py.detach(|| mozzi_urdf::open_with(name_or_path, policy)))
}

/// The model; its warnings are raised as Python's, those that change the motion first.
pub fn build(py: Python<'_>, loaded: Result<Loaded, LoadError>, floating: bool) -> PyResult<Model> {
    let loaded = loaded.map_err(|error| of_loader(py, error))?;
    for warning in &loaded.warnings {
        match warning.consequence() {
            Consequence::Motion => warn::<DynamicsWarning>(py, &warning.to_string(), 2)?,
            _ => warn::<LoadWarning>(py, &warning.to_string(), 2)?,
        }
    }
    let model = loaded.build().map_err(|error| of_loader(py, error))?;
    if floating { model.with_base(Base::Floating).map_err(of_model) } else { Ok(model) }
}

/// Arguments for expanding a xacro file: values as text, as Python prints them, and package folders.
#[derive(Default)]
pub struct Xacro<'py> {
    pub values: Option<Bound<'py, PyDict>>,
    pub packages: Option<Bound<'py, PyDict>>,
}

impl Xacro<'_> {
    fn arguments(&self) -> PyResult<XacroArguments> {
        let mut arguments = XacroArguments::default();
        let wrong = |of: &str, found: &Bound<'_, PyAny>, expected| {
            PyTypeError::new_err(format!("{of} is {found:?}, expected {expected}"))
        };
        for (name, value) in self.values.iter().flatten() {
            let name = name.extract().map_err(|_| wrong("a name in xacro_args", &name, "a str"))?;
            arguments.values.push((name, value.str()?.extract()?));
        }
        for (name, folder) in self.packages.iter().flatten() {
            let name: String = name.extract().map_err(|_| wrong("a name in packages", &name, "a str"))?;
            let folder = folder.extract().map_err(|_| wrong(&format!("packages[{name:?}]"), &folder, "a folder"))?;
            arguments.packages.push((name, folder));
        }
        Ok(arguments)
    }
}

/// An embedded robot by its name, a file of JSON of `mozzi convert`, or any [`file`].
pub fn any(given: &Bound<'_, PyAny>, how: &str, floating: bool, xacro: &Xacro) -> PyResult<Model> {
    let Ok(path) = given.extract::<PathBuf>() else { return file(given, how, floating, xacro) };
    let py = given.py();
    if let Some(name) = path.to_str().filter(|name| mozzi_urdf::embedded::unless_file(name).is_some()) {
        policy(how)?;
        if xacro.values.as_ref().is_some_and(|values| !values.is_empty()) {
            return Err(PyValueError::new_err(format!(
                "xacro_args is given, expected none: '{name}' is an embedded URDF"
            )));
        }
        return embedded(py, name, floating);
    }
    // a name without a folder and an ending that is no file
    if path.extension().is_none() && path.components().count() == 1 && !path.exists() {
        let error = LoadError::NoSuchRobot { name: path.display().to_string() };
        return Err(PyFileNotFoundError::new_err(error.to_string()));
    }
    if path.extension().is_none_or(|ending| ending != "json") {
        return file(given, how, floating, xacro);
    }
    let name = path.display().to_string();
    let text = std::fs::read_to_string(&path)
        .map_err(|source| of_loader(py, LoadError::File { path: path.clone(), source }))?;
    let wrong = |error: json::Misplaced| PyValueError::new_err(error.to_string());
    let robot = json::read(&json::File::parse(&name, &text).map_err(wrong)?);
    let robot = robot.map_err(|errors| {
        PyValueError::new_err(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    })?;
    let model = robot.build().map_err(of_model)?;
    if floating { model.with_base(Base::Floating).map_err(of_model) } else { Ok(model) }
}

/// A path, or an object with `read`.
pub fn file(given: &Bound<'_, PyAny>, how: &str, floating: bool, xacro: &Xacro) -> PyResult<Model> {
    let (py, settings) = (given.py(), Settings { policy: policy(how)?, xacro: xacro.arguments()? });
    if let Ok(read) = given.getattr("read") {
        let name = given.getattr("name").and_then(|name| name.extract::<String>());
        return self::text(&read.call0()?, &name.unwrap_or_else(|_| "robot".into()), how, floating, xacro);
    }
    let path: PathBuf = given.extract().map_err(|_| {
        let kind = given.get_type();
        PyTypeError::new_err(format!("the file is a {kind}, expected a path, or a file to read"))
    })?;
    let loaded = py.detach(|| mozzi_urdf::load_with(path, settings));
    build(py, loaded, floating)
}

/// A str or bytes.
pub fn text(given: &Bound<'_, PyAny>, name: &str, how: &str, floating: bool, xacro: &Xacro) -> PyResult<Model> {
    let (py, settings) = (given.py(), Settings { policy: policy(how)?, xacro: xacro.arguments()? });
    let loaded = if let Ok(text) = given.cast::<PyString>() {
        mozzi_urdf::parse_with(name, text.to_cow()?.as_bytes(), settings)
    } else if let Ok(bytes) = given.cast::<PyBytes>() {
        mozzi_urdf::parse_with(name, bytes.as_bytes(), settings)
    } else {
        return Err(PyTypeError::new_err(format!("the text is a {}, expected str or bytes", given.get_type())));
    };
    build(py, loaded, floating)
}

/// One of the embedded robots.
pub fn embedded(py: Python<'_>, name: &str, floating: bool) -> PyResult<Model> {
    match mozzi_urdf::embedded::text(name) {
        Some(text) => build(py, mozzi_urdf::parse(&format!("{name}.urdf"), text), floating),
        None => Err(of_loader(py, LoadError::NoSuchRobot { name: name.into() })),
    }
}

/// A serial chain of the book's lists.
pub fn screws(
    name: &str,
    [M_list, G_list, S_list]: [&Bound<'_, PyAny>; 3],
    frames: &str,
    axes: &str,
) -> PyResult<Model> {
    let mut S = Numbers::new("S_list", S_list)?;
    let [6, n] = S.shape[..] else {
        return Err(wrong_shape("S_list", &S.shape, "(6, n): a screw axis (ω, v) in each column"));
    };
    S.spread::<f64>(&[], 2)?;
    let S = S.slice::<f64>()?;
    let screws = (0..n)
        .map(|j| {
            ScrewAxis::from_array(std::array::from_fn(|row| S[row * n + j]))
                .map_err(|error| PyValueError::new_err(format!("S_list, column {j}: {}", not_a_screw(error))))
        })
        .collect::<PyResult<Vec<_>>>()?;
    let home =
        matrices::<4>("M_list", M_list, n + 1, "(n + 1, 4, 4): a home frame for each link, and the end effector's")?;
    let home = home
        .into_iter()
        .enumerate()
        .map(|(k, M)| {
            let not_a_pose = |error| PyValueError::new_err(format!("M_list[{k}]: {error}"));
            SE3::from_rounded_matrix(M).map_err(not_a_pose)
        })
        .collect::<PyResult<Vec<SE3>>>()?;
    let inertias = matrices::<6>("G_list", G_list, n, "(n, 6, 6): a spatial inertia for each link")?;
    let inertias = inertias
        .into_iter()
        .enumerate()
        .map(|(k, G)| {
            SpatialInertia::from_matrix(G).map_err(|error| PyValueError::new_err(format!("G_list[{k}]: {error}")))
        })
        .collect::<PyResult<Vec<SpatialInertia>>>()?;
    let home = match frames {
        "relative" => HomeFrames::Relative(&home),
        "base" => HomeFrames::Base(&home),
        other => return Err(PyValueError::new_err(format!("frames is '{other}', expected 'relative' or 'base'"))),
    };
    let screws = match axes {
        "space" => Screws::Space(&screws),
        "body" => Screws::Body(&screws),
        "link" => Screws::Link(&screws),
        other => return Err(PyValueError::new_err(format!("axes is '{other}', expected 'space', 'body' or 'link'"))),
    };
    Description::from_screws(name, home, &inertias, screws).and_then(Description::build).map_err(of_model)
}

/// The error, with a remedy in Python's words.
fn not_a_screw(NotAScrew { angular, linear }: NotAScrew) -> String {
    let remedy = match angular > 0.0 && angular.is_finite() {
        true => "; divide the column by ‖ω‖, then θ is in radians",
        false => "",
    };
    format!("not a unit screw axis: ‖ω‖ = {angular} and ‖v‖ = {linear}, expected ‖ω‖ = 1, or ω = 0 and ‖v‖ = 1{remedy}")
}

fn matrices<const K: usize>(
    name: &'static str,
    given: &Bound<'_, PyAny>,
    count: usize,
    expected: &'static str,
) -> PyResult<Vec<[[f64; K]; K]>> {
    let mut table = Numbers::new(name, given)?;
    if table.shape != [count, K, K] {
        return Err(wrong_shape(name, &table.shape, expected));
    }
    table.spread::<f64>(&[], 3)?;
    let (rows, _) = table.slice::<f64>()?.as_chunks::<K>();
    Ok(rows.as_chunks::<K>().0.to_vec())
}
