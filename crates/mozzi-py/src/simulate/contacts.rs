//! Contact points and planes from Python.

use crate::arguments::Given;
use crate::failure::of_model;
use crate::numpy::Fresh;
use mozzi::{Model, SE3, Vec3};
use mozzi_sim::{ContactPoint, Contacts, Plane, PlaneMotion, Support, Trajectory};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};

/// The forces of all contacts in all rows of motions, a NumPy array whose shape ends with (contacts, 3).
pub fn forces<'py, 'a>(
    py: Python<'py>,
    shape: &[usize],
    motions: impl Iterator<Item = &'a Trajectory>,
) -> PyResult<Bound<'py, PyAny>> {
    let mut fresh = Fresh::<f64>::new(py, shape)?;
    let (width, numbers) = (3 * shape[shape.len() - 2], fresh.numbers());
    for (row, sample) in motions.flat_map(Trajectory::samples).enumerate() {
        for force in sample.contact_forces {
            numbers[row * width + 3 * force.pair..][..3].copy_from_slice(&force.f.0);
        }
    }
    Ok(fresh.into_array())
}

/// Contact points and planes that do not turn, which threads can share.
#[derive(Default)]
pub struct Fixed {
    points: Vec<ContactPoint>,
    /// Name, configuration, and the velocity of a belt.
    planes: Vec<(String, SE3, Option<Vec3>)>,
}

impl Fixed {
    /// Those of `contacts` and `planes`.
    pub fn new(model: &Model, points: Given, planes: Given) -> PyResult<Self> {
        let Some(points) = points else {
            return match planes {
                Some(_) => Err(PyValueError::new_err("planes are given without contacts, expected both")),
                None => Ok(Fixed::default()),
            };
        };
        let mut found = Fixed::default();
        for given in points.try_iter()? {
            found.points.push(point(model, &given?)?);
        }
        match planes {
            None => found.planes.push((Plane::ground().name, SE3::identity(), None)),
            Some(planes) => {
                for given in planes.try_iter()? {
                    found.planes.push(plane(&given?, found.planes.len())?);
                }
            }
        }
        Ok(found)
    }

    /// For a simulation.
    pub fn contacts(&self) -> Contacts<'static> {
        let plane = |(name, T, velocity): &(String, SE3, Option<Vec3>)| {
            let motion = velocity.map_or(PlaneMotion::Fixed(*T), |velocity| PlaneMotion::Belt(*T, velocity));
            Plane { name: name.clone(), motion }
        };
        Contacts { points: self.points.clone(), planes: self.planes.iter().map(plane).collect() }
    }
}

/// A list of what an iterable gives, which can be read twice; of one name or dictionary.
pub fn listed<'py>(name: &str, given: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let is_one = given.is_instance_of::<PyString>() || given.is_instance_of::<PyDict>();
    let wrong = |_| PyTypeError::new_err(format!("{name} is {given}, expected a list of names or dictionaries"));
    let entries = match is_one {
        true => vec![given.clone()],
        false => given.try_iter().map_err(wrong)?.collect::<PyResult<Vec<_>>>()?,
    };
    Ok(PyList::new(given.py(), entries)?.into_any())
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

fn plane(given: &Bound<'_, PyAny>, k: usize) -> PyResult<(String, SE3, Option<Vec3>)> {
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
    let velocity = entries.get_item("velocity")?.map(|velocity| velocity.extract()).transpose()?;
    let name = name.unwrap_or_else(|| format!("plane {}", k + 1));
    Ok((name, SE3::from_pose(pose), velocity.map(Vec3)))
}
