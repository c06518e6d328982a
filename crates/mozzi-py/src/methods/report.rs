//! HTML report of a robot and its motion.

use crate::array::list;
use crate::failure::{LoadWarning, of_file, of_loader, warn};
use crate::model::PyModel;
use crate::results::named;
use crate::simulate::contacts::Fixed;
use mozzi::Vec3;
use mozzi_report::{Drawing, Meshes, Motion, Touches};
use mozzi_sim::Trajectory;
use mozzi_sim::{ContactChange, ContactEvent, ContactForce, Energy, Sample};
use mozzi_urdf::XacroArguments;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::PathBuf;

fn meshes(name: &str) -> PyResult<Meshes> {
    match name {
        "visual" => Ok(Meshes::Visual),
        "collision" => Ok(Meshes::Collision),
        "none" => Ok(Meshes::None),
        other => Err(PyValueError::new_err(format!("meshes is '{other}', expected 'visual', 'collision' or 'none'"))),
    }
}

/// An error if an argument was given that needs another.
fn without_effect(is_given: bool, name: &str, needs: &str) -> PyResult<()> {
    match is_given {
        true => Err(PyValueError::new_err(format!("{name} is given without {needs}: it would have no effect"))),
        false => Ok(()),
    }
}

/// The shapes of a file; a warning for each that is left out.
pub(super) fn drawing(
    py: Python<'_>,
    shapes: Option<PathBuf>,
    meshes: &str,
    mesh_root: Option<PathBuf>,
) -> PyResult<Drawing> {
    let meshes = self::meshes(meshes)?;
    if let Some(folder) = mesh_root.as_deref().filter(|folder| !folder.is_dir()) {
        return Err(PyValueError::new_err(format!("mesh_root is '{}', expected a folder", folder.display())));
    }
    let Some(file) = shapes else {
        without_effect(meshes != Meshes::Visual, "meshes", "shapes")?;
        without_effect(mesh_root.is_some(), "mesh_root", "shapes")?;
        return Ok(Drawing::default());
    };
    let xacro = XacroArguments::default();
    let drawing = Drawing::of_file_below(&file.to_string_lossy(), &xacro, meshes, mesh_root.as_deref())
        .map_err(|error| of_loader(py, error))?;
    for note in &drawing.notes {
        warn::<LoadWarning>(py, note, 2)?;
    }
    Ok(drawing)
}

/// The numbers of an attribute.
fn column(of: &Bound<'_, PyAny>, name: &'static str, shape: &[usize]) -> PyResult<Vec<f64>> {
    list(name, &of.getattr(name)?, shape)
}

/// Row k of a table.
fn row(table: &[f64], k: usize, width: usize) -> &[f64] {
    &table[k * width..][..width]
}

/// The contacts of a row of forces that are not 0.
fn carrying(forces: &[f64]) -> Vec<ContactForce> {
    let all = forces.as_chunks().0.iter().map(|f| Vec3(*f)).enumerate();
    all.filter(|(_, f)| *f != Vec3::zero()).map(|(pair, f)| ContactForce { pair, f }).collect()
}

/// Python's `Trajectory` as the library's.
fn trajectory(model: &mozzi::Model, given: &Bound<'_, PyAny>) -> PyResult<Trajectory> {
    let (n, nq, rows) = (model.n(), model.nq(), given.getattr("t")?.len()?);
    let t = column(given, "t", &[rows])?;
    let theta = column(given, "theta", &[rows, nq])?;
    let [dtheta, ddtheta, tau] = ["dtheta", "ddtheta", "tau"].map(|name| column(given, name, &[rows, n]));
    let (dtheta, ddtheta, tau) = (dtheta?, ddtheta?, tau?);
    let energy = |name| column(given, name, &[rows]);
    let (kinetic, potential) = (energy("kinetic_energy")?, energy("potential_energy")?);
    let (motor, friction, applied) = (energy("motor_work")?, energy("friction_loss")?, energy("applied_work")?);
    let pairs = given.getattr("contact_names")?.len()?;
    let forces = column(given, "contact_forces", &[rows, pairs, 3])?;
    let mut trajectory = Trajectory::new(model);
    for k in 0..rows {
        let energy = Energy {
            kinetic: kinetic[k],
            potential: potential[k],
            motor_work: motor[k],
            friction_loss: friction[k],
            applied_work: applied[k],
        };
        trajectory.record(Sample {
            t: t[k],
            theta: row(&theta, k, nq),
            dtheta: row(&dtheta, k, n),
            ddtheta: row(&ddtheta, k, n),
            tau: row(&tau, k, n),
            energy,
            contact_forces: &carrying(row(&forces, k, 3 * pairs)),
        });
    }
    Ok(trajectory)
}

/// The contacts of Python's `Trajectory`, if it has any.
fn touches(model: &mozzi::Model, given: &Bound<'_, PyAny>, motion: &Trajectory) -> PyResult<Option<Touches>> {
    let [points, planes] = ["contacts", "planes"].map(|name| given.getattr(name));
    let (points, planes) = (points?, planes?);
    let [points, planes] = [&points, &planes].map(|given| Some(given).filter(|given| !given.is_none()));
    let contacts = Fixed::new(model, points, planes)?.contacts();
    if contacts.is_empty() {
        return Ok(None);
    }
    let event = |event: Bound<'_, PyAny>| -> PyResult<ContactEvent> {
        let name: String = event.getattr("change")?.extract()?;
        let change = ContactChange::ALL.into_iter().find(|change| change.name() == name);
        let change = change.ok_or_else(|| PyValueError::new_err(format!("a contact event's change is '{name}'")))?;
        Ok(ContactEvent { t: event.getattr("t")?.extract()?, contact: event.getattr("contact")?.extract()?, change })
    };
    let events =
        given.getattr("contact_events")?.try_iter()?.map(|found| event(found?)).collect::<PyResult<Vec<_>>>()?;
    let found = Touches::new(model, &contacts, motion, &events);
    found.map(Some).map_err(|error| PyValueError::new_err(error.to_string()))
}

#[pymethods]
impl PyModel {
    /// Write the robot, and a motion of it, as one HTML file that needs nothing but a browser.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     The file to write.
    /// trajectory : Trajectory, optional
    ///     A result of `simulate`. Default: the page has a slider for each joint.
    /// shapes : path or str, optional
    ///     The robot's file, or the name of an embedded robot, for its shapes. Default: a skeleton.
    /// meshes : {'visual', 'collision', 'none'}
    ///     Meshes of that file to embed in the page.
    /// mesh_root : path, optional
    ///     A folder above meshes outside of the file's own folder and package; they are embedded as well. Meshes that
    ///     are not found elsewhere are searched there.
    /// title : str
    ///     A short description of the motion.
    /// rows : int, optional
    ///     Maximum number of rows of the motion, at equal times; None for all.
    ///
    /// Returns
    /// -------
    /// ReportSize
    ///     A named tuple: `rows` on the page, `all_rows` of the motion, and `bytes` of the file.
    ///
    /// Warns
    /// -----
    /// LoadWarning
    ///     For each shape that is left out.
    #[pyo3(signature = (path, trajectory=None, *, shapes=None, meshes="visual", mesh_root=None, title="simulated", rows=Some(mozzi_report::ROWS)))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn report<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        trajectory: Option<&Bound<'py, PyAny>>,
        shapes: Option<PathBuf>,
        meshes: &str,
        mesh_root: Option<PathBuf>,
        title: &str,
        rows: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        if trajectory.is_none() {
            without_effect(title != "simulated", "title", "trajectory")?;
            without_effect(rows != Some(mozzi_report::ROWS), "rows", "trajectory")?;
        }
        let drawing = drawing(py, shapes, meshes, mesh_root)?;
        let motion = trajectory.map(|given| self::trajectory(model, given)).transpose()?;
        let all_rows = motion.as_ref().map_or(0, Trajectory::len);
        let touches =
            (trajectory.zip(motion.as_ref())).map(|(given, motion)| touches(model, given, motion)).transpose()?;
        let contacts = touches.flatten();
        let motion = motion.map(|motion| Motion { contacts, ..Motion::simulated(title, &motion) });
        let motion = motion.map(|motion| motion.thinned(rows.unwrap_or(usize::MAX)));
        let page = mozzi_report::html(model, &drawing, motion.as_ref());
        let page = page.map_err(|error| PyValueError::new_err(error.to_string()))?;
        mozzi_report::whole_file::save(&path, page.as_bytes()).map_err(|error| of_file(&path, &error))?;
        let rows = motion.map_or(0, |motion| motion.t.len());
        let numbers = [rows, all_rows, page.len()].map(|x| x.into_pyobject(py).map(Bound::into_any));
        named(py, "ReportSize", numbers.into_iter().collect::<Result<_, _>>()?)
    }
}
