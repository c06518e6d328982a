//! Contact points and planes from Python.

use crate::arguments::Given;
use crate::failure::of_model;
use mozzi::simulation::{ContactPoint, Contacts, Plane, PlaneMotion, Support};
use mozzi::{Model, SE3, Vec3};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

/// The contacts of `contacts` and `planes`.
pub fn contacts(model: &Model, points: Given, planes: Given) -> PyResult<Contacts<'static>> {
    let Some(points) = points else {
        return match planes {
            Some(_) => Err(PyValueError::new_err("planes are given without contacts, expected both")),
            None => Ok(Contacts::default()),
        };
    };
    let mut found = Contacts::default();
    for given in points.try_iter()? {
        found.points.push(point(model, &given?)?);
    }
    for given in planes.map(|planes| planes.try_iter()).transpose()?.into_iter().flatten() {
        found.planes.push(plane(&given?, found.planes.len())?);
    }
    if planes.is_none() {
        found.planes.push(Plane::ground());
    }
    Ok(found)
}

/// The entries of a dictionary, all of which must be known.
fn entries<'a, 'py>(given: &'a Bound<'py, PyAny>, what: &str, known: &[&str]) -> PyResult<&'a Bound<'py, PyDict>> {
    let wrong = |found: String| PyTypeError::new_err(format!("{what} has {found}, expected {}", known.join(", ")));
    let found = given.cast::<PyDict>().map_err(|_| wrong(format!("an entry `{given}`")))?;
    for key in found.keys() {
        let key: String = key.extract()?;
        if !known.contains(&&*key) {
            return Err(wrong(format!("an unknown `{key}`")));
        }
    }
    Ok(found)
}

fn point(model: &Model, given: &Bound<'_, PyAny>) -> PyResult<ContactPoint> {
    let named = |name: &str| -> PyResult<ContactPoint> {
        let frame = model.frame(name).map_err(of_model)?;
        Ok(ContactPoint::new(name, frame, Vec3::zero(), 0.7))
    };
    if given.is_instance_of::<PyString>() {
        return named(&given.extract::<String>()?);
    }
    let known = ["frame", "at", "radius", "friction", "restitution", "name"];
    let entries = entries(given, "contacts", &known)?;
    let frame = entries.get_item("frame")?.ok_or_else(|| PyValueError::new_err("a contact has no 'frame'"))?;
    let mut found = named(&frame.extract::<String>()?)?;
    if let Some(at) = entries.get_item("at")? {
        found.center = Vec3(at.extract()?);
    }
    if let Some(radius) = entries.get_item("radius")? {
        found.support = Support::Sphere { radius: radius.extract()? };
    }
    if let Some(mu) = entries.get_item("friction")? {
        found.mu = mu.extract()?;
    }
    if let Some(restitution) = entries.get_item("restitution")? {
        found.restitution = restitution.extract()?;
    }
    if let Some(name) = entries.get_item("name")? {
        found.name = name.extract()?;
    }
    Ok(found)
}

fn plane(given: &Bound<'_, PyAny>, k: usize) -> PyResult<Plane<'static>> {
    let entries = entries(given, "planes", &["name", "pose", "velocity"])?;
    let name = entries.get_item("name")?.map(|name| name.extract()).transpose()?;
    let pose: [f64; 7] = match entries.get_item("pose")? {
        Some(pose) => pose.extract()?,
        None => SE3::identity().to_pose(),
    };
    let size: f64 = pose[..4].iter().map(|x| x * x).sum();
    if !((size - 1.0).abs() < 2e-3) {
        return Err(PyValueError::new_err(format!("a plane's pose is {pose:?}, expected a unit quaternion first")));
    }
    let T = SE3::from_pose(pose);
    let motion = match entries.get_item("velocity")? {
        Some(velocity) => PlaneMotion::Belt(T, Vec3(velocity.extract()?)),
        None => PlaneMotion::Fixed(T),
    };
    Ok(Plane { name: name.unwrap_or_else(|| format!("plane {}", k + 1)), motion })
}
