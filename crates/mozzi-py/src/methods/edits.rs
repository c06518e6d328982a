//! Modified copies of a robot: with a payload, a frame, another gravity or base, locked joints, a part of it.

use crate::arguments::Given;
use crate::array::Numbers;
use crate::describe::{pose, refused};
use crate::failure::{LoadWarning, warn};
use crate::model::PyModel;
use mozzi::SpatialInertia;
use mozzi::model::Base;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyModel {
    /// Return a copy with a payload fixed to a frame.
    ///
    /// Parameters
    /// ----------
    /// frame : str
    ///     A link or frame.
    /// inertia : float, or array_like of shape (6, 6)
    ///     Mass of a point, kg, or spatial inertia in the frame: kg m², kg m, kg. One that no body has is used with a
    ///     warning, as in a robot's file.
    /// center_of_mass : array_like, shape (3,), optional
    ///     Position of the point mass in the frame, m. Default: the frame's origin.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5 = mozzi.models.ur5()
    /// >>> round(ur5.with_payload("tool0", 2.0).mass - ur5.mass, 9)
    /// 2.0
    #[pyo3(signature = (frame, inertia, center_of_mass=None))]
    fn with_payload(
        &self,
        py: Python<'_>,
        frame: &str,
        inertia: &Bound<'_, PyAny>,
        center_of_mass: Given<'_, '_>,
    ) -> PyResult<Self> {
        let center = |given| Numbers::fixed("center_of_mass", given, "(3,): m");
        let inertia = match inertia.extract::<f64>() {
            Ok(mass) => {
                let center = center_of_mass.map_or(Ok([0.0; 3]), center)?;
                SpatialInertia::point_mass(mass, mozzi::Vec3(center))
            }
            Err(_) if center_of_mass.is_some() => {
                let why = "center_of_mass is given, expected None: a spatial inertia contains its centre of mass";
                return Err(refused(why));
            }
            Err(_) => {
                let G = Numbers::matrix::<6, 6>("inertia", inertia, "(6, 6), or a mass in kg")?;
                SpatialInertia::from_matrix(G).map_err(refused)?
            }
        };
        let loaded = Self::built(self.robot().model.with_payload(self.frame(Some(frame))?, inertia))?;
        let verdict = inertia.verdict();
        if inertia.mass >= 0.0 && !verdict.is_physical() {
            // a negative mass takes a payload away
            warn::<LoadWarning>(py, &format!("inertia: {verdict}"), 1)?;
        }
        Ok(loaded)
    }

    /// Return a copy with an additional frame at a pose relative to an existing one.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the new frame.
    /// on : str
    ///     The existing frame, to whose link the new one is fixed.
    /// T : array_like, shape (4, 4)
    ///     Pose of the new frame in the existing one.
    ///
    /// Returns
    /// -------
    /// Model
    fn with_frame(&self, name: &str, on: &str, T: &Bound<'_, PyAny>) -> PyResult<Self> {
        let T = pose(Numbers::matrix("T", T, "(4, 4)")?)?;
        Self::built(self.robot().model.with_frame(name, self.frame(Some(on))?, T))
    }

    /// Return a copy with this frame as its end effector, the default of all `frame` arguments.
    ///
    /// Parameters
    /// ----------
    /// frame : str
    ///     A link or frame.
    ///
    /// Returns
    /// -------
    /// Model
    fn with_end_effector(&self, frame: &str) -> PyResult<Self> {
        Self::built(self.robot().model.with_end_effector(self.frame(Some(frame))?))
    }

    /// Return a copy with another gravity.
    ///
    /// Parameters
    /// ----------
    /// gravity : array_like, shape (3,), or float
    ///     In the axes of {s}, m/s². One number points down: 9.81 is (0, 0, −9.81).
    ///
    /// Returns
    /// -------
    /// Model
    fn with_gravity(&self, gravity: &Bound<'_, PyAny>) -> PyResult<Self> {
        let gravity = match gravity.extract::<f64>() {
            Ok(size) if size < 0.0 => {
                let expected = format!("expected {}, which points down, or (0, 0, {size})", -size);
                return Err(refused(format!("gravity is {size}, {expected}")));
            }
            Ok(size) => [0.0, 0.0, -size],
            Err(_) => Numbers::fixed("gravity", gravity, "(3,), or a number: m/s²")?,
        };
        Self::built(self.robot().model.with_gravity(gravity))
    }

    /// Return a copy with a floating or a fixed base.
    ///
    /// Parameters
    /// ----------
    /// floating : bool
    ///     False for a fixed base.
    ///
    /// Returns
    /// -------
    /// Model
    #[pyo3(signature = (floating=true))]
    fn with_floating_base(&self, floating: bool) -> PyResult<Self> {
        let base = if floating { Base::Floating } else { Base::Fixed };
        Self::built(self.robot().model.with_base(base))
    }

    /// Return a copy in which joints are fixed at given positions.
    ///
    /// Parameters
    /// ----------
    /// positions : dict of str to float
    ///     Positions by joint name: rad or m.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.panda().with_locked_joints({"panda_joint3": 0.3}).n
    /// 7
    fn with_locked_joints(&self, positions: &Bound<'_, PyDict>) -> PyResult<Self> {
        let positions = positions
            .iter()
            .map(|(k, x)| Ok((k.extract()?, x.extract()?)))
            .collect::<PyResult<Vec<(String, f64)>>>()?;
        let positions: Vec<(&str, f64)> = positions.iter().map(|(name, x)| (name.as_str(), *x)).collect();
        Self::built(self.robot().model.with_locked_joints(&positions))
    }

    /// Return a copy with a further rotor that several joints turn together, as in coupled wrists.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the rotor.
    /// gears : dict of str to float
    ///     Ratios by joint name: the rotor's rate is the sum of the joints' rates, each times its ratio.
    /// armature : float, optional
    ///     Its inertia, kg m²; with 0 it is there to be identified.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the name is taken, or a joint does not exist.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5, theta = mozzi.models.ur5(), [0.0] * 6
    /// >>> wrist = ur5.with_rotor("wrist", {"wrist_1_joint": 1.0, "wrist_2_joint": 1.0}, armature=0.1)
    /// >>> round(float((wrist.mass_matrix(theta) - ur5.mass_matrix(theta))[3, 4]), 6)
    /// 0.1
    #[pyo3(signature = (name, gears, armature=0.0))]
    fn with_rotor(&self, name: &str, gears: &Bound<'_, PyDict>, armature: f64) -> PyResult<Self> {
        let gears =
            gears.iter().map(|(k, x)| Ok((k.extract()?, x.extract()?))).collect::<PyResult<Vec<(String, f64)>>>()?;
        let gears: Vec<(&str, f64)> = gears.iter().map(|(name, x)| (name.as_str(), *x)).collect();
        Self::built(self.robot().model.with_rotor(name, armature, &gears))
    }

    /// Return the chain between two frames as a robot of its own.
    ///
    /// Parameters
    /// ----------
    /// start : str
    ///     Frame whose link becomes the base.
    /// end : str
    ///     Frame of a descendant, which becomes the end effector.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If `end` is not a descendant of `start`, or a mimic joint or rotor couples the chain to a joint outside of
    ///     it.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.ur5().sub_chain("base_link", "forearm_link").n
    /// 3
    fn sub_chain(&self, start: &str, end: &str) -> PyResult<Self> {
        Self::built(self.robot().model.sub_chain(self.frame(Some(start))?, self.frame(Some(end))?))
    }
}
