//! Modified copies of a robot: with a payload, a frame, another gravity or base, locked joints, a part of it.

use crate::array::Numbers;
use crate::describe::{pose, refused};
use crate::model::PyModel;
use mozzi::SpatialInertia;
use mozzi::model::Base;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyModel {
    /// With a body of this spatial inertia (6, 6) or mass fixed to a frame.
    fn with_payload(&self, frame: &str, inertia: &Bound<'_, PyAny>) -> PyResult<Self> {
        let inertia = match inertia.extract::<f64>() {
            Ok(mass) => SpatialInertia::point_mass(mass, mozzi::Vec3([0.0; 3])),
            Err(_) => {
                let G = Numbers::matrix::<6, 6>("inertia", inertia, "(6, 6), or a mass in kg")?;
                SpatialInertia::from_matrix(G).map_err(refused)?
            }
        };
        Self::built(self.robot().model.with_payload(self.frame(Some(frame))?, inertia))
    }

    /// With a further frame, at T (4, 4) seen from one that is there.
    fn with_frame(&self, name: &str, on: &str, T: &Bound<'_, PyAny>) -> PyResult<Self> {
        let T = pose(Numbers::matrix("T", T, "(4, 4)")?)?;
        Self::built(self.robot().model.with_frame(name, self.frame(Some(on))?, T))
    }

    /// With this frame as its end effector.
    fn with_end_effector(&self, frame: &str) -> PyResult<Self> {
        Self::built(self.robot().model.with_end_effector(self.frame(Some(frame))?))
    }

    /// With this gravity (3,), m/s².
    fn with_gravity(&self, gravity: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::built(self.robot().model.with_gravity(Numbers::fixed("gravity", gravity, "(3,): m/s²")?))
    }

    /// With its base floating, or fixed.
    #[pyo3(signature = (floating=true))]
    fn with_floating_base(&self, floating: bool) -> PyResult<Self> {
        let base = if floating { Base::Floating } else { Base::Fixed };
        Self::built(self.robot().model.with_base(base))
    }

    /// With these joints held at these positions, `{name: position}`.
    fn with_locked_joints(&self, positions: &Bound<'_, PyDict>) -> PyResult<Self> {
        let positions = positions
            .iter()
            .map(|(k, x)| Ok((k.extract()?, x.extract()?)))
            .collect::<PyResult<Vec<(String, f64)>>>()?;
        let positions: Vec<(&str, f64)> = positions.iter().map(|(name, x)| (name.as_str(), *x)).collect();
        Self::built(self.robot().model.with_locked_joints(&positions))
    }

    /// The chain between two frames as a robot of its own.
    fn sub_chain(&self, start: &str, end: &str) -> PyResult<Self> {
        Self::built(self.robot().model.sub_chain(self.frame(Some(start))?, self.frame(Some(end))?))
    }
}
