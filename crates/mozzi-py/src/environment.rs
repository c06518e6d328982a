//! What surrounds the robot, as keyword arguments.

use crate::array::{Numbers, wrong_shape};
use crate::failure::of_model;
use crate::numpy::Element;
use mozzi::{Environment, FrameId, Twist, Vec3, Wrench};
use mozzi_batch::BatchEnvironment;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

pub type Given<'a, 'py> = Option<&'a Bound<'py, PyAny>>;

/// The arguments as they came.
#[derive(Default)]
pub struct Arguments<'a, 'py> {
    pub tip_wrench: Given<'a, 'py>,
    pub gravity: Given<'a, 'py>,
    pub applied_wrenches: Given<'a, 'py>,
    pub base_twist: Given<'a, 'py>,
    pub base_acceleration: Given<'a, 'py>,
}

impl Arguments<'_, '_> {
    /// The model's own gravity, the base at rest, nothing touched.
    #[inline(always)]
    pub fn are_none(&self) -> bool {
        self.tip_wrench.is_none()
            && self.gravity.is_none()
            && self.applied_wrenches.is_none()
            && self.base_twist.is_none()
            && self.base_acceleration.is_none()
    }
}

/// The arguments, converted.
pub struct Around<'py> {
    gravity: Vec3,
    base_twist: Twist,
    base_acceleration: Twist,
    /// The same in all states.
    applied: Vec<(FrameId, Wrench)>,
    /// A wrench for each state.
    pub tables: Vec<(FrameId, Numbers<'py>)>,
    /// Were all wrenches of float32?
    pub is_single: bool,
    /// Is it the model's own, with nothing touched?
    pub is_own: bool,
}

impl<'py> Around<'py> {
    pub fn new(model: &mozzi::Model, given: &Arguments<'_, 'py>) -> PyResult<Self> {
        let own = model.environment();
        let mut around = Around {
            gravity: own.gravity,
            base_twist: own.base_twist,
            base_acceleration: own.base_acceleration,
            applied: Vec::new(),
            tables: Vec::new(),
            is_single: true,
            is_own: given.are_none(),
        };
        if let Some(gravity) = given.gravity {
            around.gravity = Vec3(Numbers::fixed("gravity", gravity, "(3,): m/s² in the base's axes")?);
        }
        if let Some(twist) = given.base_twist {
            around.base_twist = Twist::from_array(Numbers::fixed("base_twist", twist, "(6,): (ω, v) of {s}")?);
        }
        if let Some(acceleration) = given.base_acceleration {
            let numbers = Numbers::fixed("base_acceleration", acceleration, "(6,): (ω̇, v̇) of {s}")?;
            around.base_acceleration = Twist::from_array(numbers);
        }
        if let Some(wrench) = given.tip_wrench {
            around.push("tip_wrench", model.end_effector().map_err(of_model)?, wrench)?;
        }
        if let Some(wrenches) = given.applied_wrenches {
            let wrenches = wrenches.cast::<PyDict>().map_err(|_| {
                PyTypeError::new_err(
                    "applied_wrenches is no dict, expected {frame name: wrench (m, f), shape (..., 6)}",
                )
            })?;
            for (frame, wrench) in wrenches {
                let name: String = frame.extract().map_err(|_| {
                    PyTypeError::new_err("applied_wrenches has a key that is no str, expected names of frames")
                })?;
                around.push("applied_wrenches", model.frame(&name).map_err(of_model)?, &wrench)?;
            }
        }
        Ok(around)
    }

    fn push(&mut self, name: &'static str, frame: FrameId, given: &Bound<'py, PyAny>) -> PyResult<()> {
        let mut wrench = Numbers::new(name, given)?;
        if wrench.shape.last() != Some(&6) {
            return Err(wrong_shape(
                name,
                &wrench.shape,
                "(..., 6): (m, f) that the frame applies to the environment, in its coordinates",
            ));
        }
        self.is_single &= wrench.is_single;
        if wrench.shape.len() == 1 {
            wrench.spread::<f64>(&[], 1)?;
            let mut numbers = [0.0; 6];
            numbers.copy_from_slice(wrench.slice::<f64>()?);
            self.applied.push((frame, Wrench::from_array(numbers)));
        } else {
            self.tables.push((frame, wrench));
        }
        Ok(())
    }

    pub fn environment(&self) -> Environment<'_> {
        Environment {
            gravity: self.gravity,
            base_twist: self.base_twist,
            base_acceleration: self.base_acceleration,
            applied: &self.applied,
        }
    }

    /// With the tables, spread before to all states.
    pub fn surroundings<'a, T: Element>(&'a self, tables: &'a [(FrameId, &'a [T])]) -> BatchEnvironment<'a, T> {
        BatchEnvironment { environment: self.environment(), wrenches: tables }
    }

    pub fn slices<T: Element>(&self) -> PyResult<Vec<(FrameId, &[T])>> {
        self.tables.iter().map(|(frame, table)| Ok((*frame, table.slice()?))).collect()
    }
}
