//! The robot's environment and its inertial parameters, as keyword arguments.

use crate::arguments::Arguments;
use crate::array::{Numbers, wrong_shape};
use crate::failure::of_model;
use crate::numpy::Element;
use crate::signature::Slot;
use mozzi::{Environment, FrameId, Twist, Vec3, Wrench};
use mozzi_engine::BatchEnvironment;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The converted arguments.
pub struct ArrayEnvironment<'py> {
    gravity: Vec3,
    base_twist: Twist,
    base_acceleration: Twist,
    /// Wrenches that are equal in all states.
    applied: Vec<(FrameId, Wrench)>,
    /// A wrench for each state.
    wrenches: Vec<(FrameId, Numbers<'py>)>,
    /// Gravity for each state.
    gravities: Option<Numbers<'py>>,
    /// Inertial parameters for each state.
    parameters: Option<Numbers<'py>>,
    /// True if all wrenches and tables were float32.
    pub is_single: bool,
    /// True if it is the model's own environment, without applied wrenches.
    pub is_own: bool,
}

impl<'py> ArrayEnvironment<'py> {
    pub fn new(model: &mozzi::Model, given: &Arguments<'_, 'py>) -> PyResult<Self> {
        let own = model.environment();
        let mut environment = ArrayEnvironment {
            gravity: own.gravity,
            base_twist: own.base_twist,
            base_acceleration: own.base_acceleration,
            applied: Vec::new(),
            wrenches: Vec::new(),
            gravities: None,
            parameters: None,
            is_single: true,
            is_own: !given.have_environment(),
        };
        if let Some(gravity) = given.get(Slot::Gravity) {
            let numbers = table("gravity", gravity, 3, "m/s² in the axes of {s}")?;
            match numbers.shape.len() {
                1 => environment.gravity = Vec3(numbers.few()?),
                _ => environment.gravities = Some(environment.count(numbers)),
            }
        }
        if let Some(twist) = given.get(Slot::BaseTwist) {
            environment.base_twist = Twist::from_array(Numbers::fixed("base_twist", twist, "(6,): (ω, v) of {s}")?);
        }
        if let Some(acceleration) = given.get(Slot::BaseAcceleration) {
            let numbers = Numbers::fixed("base_acceleration", acceleration, "(6,): (ω̇, v̇) of {s}")?;
            environment.base_acceleration = Twist::from_array(numbers);
        }
        if let Some(parameters) = given.get(Slot::Parameters) {
            let expected = "ten numbers a body, five a joint, as Model.parameters";
            let numbers = table("parameters", parameters, model.parameter_count(), expected)?;
            environment.parameters = Some(environment.count(numbers));
        }
        if let Some(wrench) = given.get(Slot::TipWrench) {
            environment.push("tip_wrench", model.end_effector().map_err(of_model)?, wrench)?;
        }
        if let Some(wrenches) = given.get(Slot::AppliedWrenches) {
            let wrenches = wrenches.cast::<PyDict>().map_err(|_| {
                PyTypeError::new_err(
                    "applied_wrenches is no dict, expected {frame name: wrench (m, f), shape (..., 6)}",
                )
            })?;
            for (frame, wrench) in wrenches {
                let name: String = frame.extract().map_err(|_| {
                    PyTypeError::new_err("applied_wrenches has a key that is no str, expected names of frames")
                })?;
                environment.push("applied_wrenches", model.frame(&name).map_err(of_model)?, &wrench)?;
            }
        }
        Ok(environment)
    }

    /// The environment of one state; no argument has leading axes.
    ///
    /// # Errors
    /// `ValueError` that names the table.
    pub fn one_state(model: &mozzi::Model, given: &Arguments<'_, 'py>) -> PyResult<Self> {
        let environment = ArrayEnvironment::new(model, given)?;
        if let Some(Numbers { name, shape, .. }) = environment.tables().next() {
            let last = shape.last().copied().unwrap_or_default();
            return Err(wrong_shape(name, shape, format!("({last},): one state")));
        }
        Ok(environment)
    }

    fn count(&mut self, numbers: Numbers<'py>) -> Numbers<'py> {
        self.is_single &= numbers.is_single;
        numbers
    }

    fn push(&mut self, name: &'static str, frame: FrameId, given: &Bound<'py, PyAny>) -> PyResult<()> {
        let wrench = table(name, given, 6, "(m, f) that the frame applies to the environment, in its coordinates")?;
        let wrench = self.count(wrench);
        match wrench.shape.len() {
            1 => self.applied.push((frame, Wrench::from_array(wrench.few()?))),
            _ => self.wrenches.push((frame, wrench)),
        }
        Ok(())
    }

    /// The arguments that have numbers for each state.
    pub fn tables(&self) -> impl Iterator<Item = &Numbers<'py>> {
        self.wrenches.iter().map(|(_, table)| table).chain(&self.gravities).chain(&self.parameters)
    }

    pub fn tables_mut(&mut self) -> impl Iterator<Item = &mut Numbers<'py>> {
        self.wrenches.iter_mut().map(|(_, table)| table).chain(&mut self.gravities).chain(&mut self.parameters)
    }

    /// The part that is the same in all states.
    pub fn environment(&self) -> Environment<'_> {
        Environment {
            gravity: self.gravity,
            base_twist: self.base_twist,
            base_acceleration: self.base_acceleration,
            applied: &self.applied,
        }
    }

    /// The wrenches of each state, already broadcast to all states.
    pub fn wrenches<T: Element>(&self) -> PyResult<Vec<(FrameId, &[T])>> {
        self.wrenches.iter().map(|(frame, table)| Ok((*frame, table.slice()?))).collect()
    }

    /// With these wrenches and the other tables, already broadcast to all states.
    pub fn of_batch<'a, T: Element>(&'a self, wrenches: &'a [(FrameId, &'a [T])]) -> PyResult<BatchEnvironment<'a, T>> {
        let slice = |table: &'a Option<Numbers<'py>>| table.as_ref().map(Numbers::slice).transpose();
        let (gravity, parameters) = (slice(&self.gravities)?, slice(&self.parameters)?);
        Ok(BatchEnvironment { environment: self.environment(), wrenches, gravity, parameters })
    }
}

/// Numbers whose last axis is this long.
fn table<'py>(
    name: &'static str,
    given: &Bound<'py, PyAny>,
    length: usize,
    expected: &'static str,
) -> PyResult<Numbers<'py>> {
    let numbers = Numbers::new(name, given)?;
    match numbers.shape.last() == Some(&length) {
        true => Ok(numbers),
        false => Err(wrong_shape(name, &numbers.shape, format!("(..., {length}): {expected}"))),
    }
}
