//! Properties of a robot: names, sizes, limits, parameters, the book's lists.

use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use mozzi::Freedom;
use mozzi::model::Bounds;
use pyo3::prelude::*;

/// A copy of the robot's numbers: a change of it would be lost.
fn read_only(array: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    array.call_method1("setflags", (false,))?;
    Ok(array)
}

#[pymethods]
impl PyModel {
    /// The robot's name.
    #[getter]
    fn name(&self) -> &str {
        &self.robot().model.description().name
    }

    /// Number of velocities: one of each independent joint, three of a ball, six of a free joint and a floating base.
    #[getter]
    fn n(&self) -> usize {
        self.robot().model.n()
    }

    /// Number of positions: n, plus one for each quaternion, of a floating base, a ball or a free joint.
    #[getter]
    fn nq(&self) -> usize {
        self.robot().model.nq()
    }

    /// Names of the independent joints, in the order of θ.
    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.robot().model.joint_names().collect()
    }

    /// Names of the nq positions: a joint's own name; `joint.qw` and so on for quaternions.
    ///
    /// A ball has `joint.qw` to `joint.qz`, a free joint `joint.qw` to `joint.z`, and a floating base, which comes
    /// first, `base.qw` to `base.z`.
    #[getter]
    fn position_names(&self) -> Vec<&str> {
        self.robot().model.position_names().collect()
    }

    /// Names of the n velocities and forces: a joint's own name; `joint.wx` and so on for balls.
    ///
    /// A ball has `joint.wx` to `joint.wz`, a free joint `joint.wx` to `joint.vz`, and a floating base, which comes
    /// first, `base.wx` to `base.vz`.
    #[getter]
    fn velocity_names(&self) -> Vec<&str> {
        self.robot().model.velocity_names().collect()
    }

    /// For each quaternion in θ: its index in θ, its joint's index in θ̇, and whether a position follows it.
    #[getter]
    fn _quaternions(&self) -> Vec<(usize, usize, bool)> {
        let places = self.robot().model.configuration_space().places();
        let turns = places.iter().filter(|place| place.freedom != Freedom::One);
        turns.map(|place| (place.q, place.j, place.freedom == Freedom::Free)).collect()
    }

    /// Names of the links, in the order of the file.
    #[getter]
    fn link_names(&self) -> Vec<&str> {
        self.robot().model.description().links.iter().map(|link| link.name.as_str()).collect()
    }

    /// Names of all frames: the links, and the frames that were added.
    #[getter]
    fn frames(&self) -> Vec<&str> {
        self.robot().model.frames().map(|(_, name)| name).collect()
    }

    /// Name of the end effector; None if there is no obvious one.
    #[getter]
    fn end_effector(&self) -> Option<&str> {
        self.robot().model.end_effector().ok().map(|frame| self.robot().model.frame_name(frame))
    }

    /// True if the base is floating.
    #[getter]
    fn is_floating(&self) -> bool {
        self.robot().model.is_floating()
    }

    /// Total mass of the moving links, kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.robot().model.mass()
    }

    /// Gravity in {s}, shape (3,), m/s².
    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        read_only(array(py, &[3], self.robot().model.gravity().0)?)
    }

    /// Lowest and highest position of each joint, shape (joints, 2), rad or m; infinite without a limit.
    ///
    /// The limits of its mimic joints restrict it, too. A ball's are those of its angle from 0.
    #[getter]
    fn position_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let limits = Bounds::of(&self.robot().model).joints;
        read_only(array(py, &[limits.len(), 2], limits.into_iter().flatten())?)
    }

    /// Maximum speed of each joint, shape (joints,), rad/s or m/s; infinite without a limit.
    ///
    /// The limits of its mimic joints restrict it, too.
    #[getter]
    fn velocity_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [limits, _] = Bounds::of_rates(&self.robot().model);
        read_only(array(py, &[limits.len()], limits)?)
    }

    /// Maximum torque or force of each joint, shape (joints,), N m or N; infinite without a limit.
    ///
    /// They are the file's limits of the joints; ranges of MJCF's actuators (ctrlrange, forcerange) are not read.
    #[getter]
    fn effort_limits<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let limits = self.robot().model.joints().map(|joint| joint.limits.effort.unwrap_or(f64::INFINITY));
        read_only(array(py, &[self.robot().model.joint_names().len()], limits)?)
    }

    /// A copy of the inertial parameters π: ten numbers a body, five a joint; see `regressor`.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let parameters = self.robot().model.parameters();
        array(py, &[parameters.len()], parameters)
    }

    /// Names of `parameters`.
    #[getter]
    fn parameter_names(&self) -> Vec<String> {
        self.robot().model.parameter_names()
    }

    /// Positions with all joints at 0 and a floating base at {s}, shape (nq,).
    #[getter]
    fn neutral_configuration<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let theta: Vec<f64> = self.robot().model.neutral_configuration();
        array(py, &[theta.len()], theta)
    }

    /// Return the book's lists of this robot: home frames, screw axes and spatial inertias of its N moving links.
    ///
    /// Returns
    /// -------
    /// ScrewLists
    ///     A named tuple, base to tips: `joints`, `links`, `parents`, `M` (N, 4, 4) and `M_relative`, `S`, `A` and `B`
    ///     (6, N), `G` (N, 6, 6), `end_effector` (name and home frame, or None).
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For a robot with a ball or a free joint, which have no single screw axis.
    fn screws<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let lists = self.robot().model.screws().map_err(of_model)?;
        let (poses, axes) = (
            |list: &[mozzi::SE3]| {
                array(py, &[list.len(), 4, 4], list.iter().flat_map(|M| M.to_matrix().into_iter().flatten()))
            },
            |list: &[mozzi::ScrewAxis]| {
                let columns: Vec<[f64; 6]> = list.iter().map(|axis| axis.twist().to_array()).collect();
                array(py, &[6, list.len()], (0..6).flat_map(|row| columns.iter().map(move |column| column[row])))
            },
        );
        let G = lists.G.iter().flat_map(|G| G.to_matrix().into_iter().flatten());
        let end_effector = match &lists.end_effector {
            Some((name, M)) => {
                (name, array(py, &[4, 4], M.to_matrix().into_iter().flatten())?).into_pyobject(py)?.into_any()
            }
            None => py.None().into_bound(py),
        };
        let fields = vec![
            lists.joints.clone().into_pyobject(py)?,
            lists.links.clone().into_pyobject(py)?,
            lists.parents.clone().into_pyobject(py)?,
            poses(&lists.M)?,
            poses(&lists.M_relative)?,
            axes(&lists.S)?,
            axes(&lists.A)?,
            axes(&lists.B)?,
            array(py, &[lists.G.len(), 6, 6], G)?,
            end_effector,
        ];
        named(py, "ScrewLists", fields)
    }
}
