//! A model with data for C: names as C strings, frames by number, limits.

use crate::border::c_string;
use crate::handle::{Handle, kind, put};
use crate::status::{Outcome, Status, of_model, refuse};
use mozzi::model::Bounds;
use mozzi::quantities::{Declaration, LIST, MOST_INPUTS, MOST_OUTPUTS, Query, Subject};
use mozzi::{Environment, FrameId, Model};
use std::ffi::CString;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// A model behind a handle. Copies of a handle share it.
pub struct Robot {
    pub model: Model,
    /// Its own gravity, its base at rest, no applied wrenches.
    pub own: Environment<'static>,
    /// Distinguishes the models of this process, and with them their frames.
    pub serial: u32,
    pub frames: Vec<FrameId>,
    pub bounds: Bounds,
    pub names: Names,
    /// One for each quantity.
    pub plans: Vec<Plan>,
    /// The most numbers that the outputs of a quantity have together.
    pub most_numbers: usize,
    /// True if θ contains quaternions.
    pub has_quaternions: bool,
}

kind!(Arc<Robot>, "mozzi_model");

/// `struct mozzi_model`.
pub type ModelHandle = Handle<Arc<Robot>>;

/// Arguments and sizes for a call of a quantity, with all six rows of a task.
pub struct Plan {
    pub query: Query<'static>,
    pub declaration: &'static Declaration,
    /// Lengths of the inputs.
    pub inputs: [usize; MOST_INPUTS],
    pub outputs: Shapes,
}

/// Shapes of the outputs, the last axis last, 1 for axes that they lack.
pub type Shapes = [[usize; 3]; MOST_OUTPUTS];

impl Plan {
    fn new(model: &Model, index: usize) -> Self {
        let (query, mut inputs) = (Query::at(index), [0; MOST_INPUTS]);
        inputs.iter_mut().zip(query.input_lengths(model)).for_each(|(length, found)| *length = found);
        let declaration = query.declaration();
        Plan { query, declaration, inputs, outputs: shapes(declaration, model, &query.subject) }
    }
}

/// The shapes of a quantity's outputs.
pub fn shapes(declaration: &Declaration, model: &Model, subject: &Subject) -> Shapes {
    let mut shapes = [[1; 3]; MOST_OUTPUTS];
    for (shape, output) in shapes.iter_mut().zip(declaration.outputs) {
        let first = 3 - output.dims.len();
        shape[first..].iter_mut().zip(output.dims).for_each(|(size, dim)| *size = dim.size(model, subject));
    }
    shapes
}

/// Names as C's texts.
pub struct Names {
    pub model: CString,
    pub joints: Vec<CString>,
    pub positions: Vec<CString>,
    pub velocities: Vec<CString>,
    pub frames: Vec<CString>,
    pub parameters: Vec<CString>,
    pub constraint_rows: Vec<CString>,
    pub states: Vec<CString>,
}

impl Names {
    fn new(model: &Model) -> Self {
        fn list<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> Vec<CString> {
            names.into_iter().map(|name| c_string(name.as_ref())).collect()
        }
        Names {
            model: c_string(&model.description().name),
            joints: list(model.joint_names()),
            positions: list(model.position_names()),
            velocities: list(model.velocity_names()),
            frames: list(model.frames().map(|(_, name)| name)),
            parameters: list(model.parameter_names()),
            constraint_rows: list(model.constraint_row_names()),
            states: list(model.state_names()),
        }
    }
}

impl Robot {
    pub fn new(model: Model) -> Self {
        static SERIAL: AtomicU32 = AtomicU32::new(1);
        let most = |index: usize| Query::at(index).output_lengths(&model).sum();
        Robot {
            own: model.environment(),
            serial: SERIAL.fetch_add(1, Ordering::Relaxed),
            frames: model.frames().map(|(frame, _)| frame).collect(),
            bounds: Bounds::of(&model),
            names: Names::new(&model),
            plans: (0..LIST.len()).map(|index| Plan::new(&model, index)).collect(),
            most_numbers: (0..LIST.len()).map(most).max().unwrap_or(0),
            has_quaternions: !model.configuration_space().is_flat(),
            model,
        }
    }

    /// C's handle of a frame: the model's serial number and the frame's.
    pub fn handle_of(&self, frame: FrameId) -> Frame {
        let place = self.frames.iter().position(|known| *known == frame).unwrap_or(0);
        u64::from(self.serial) << 32 | place as u64
    }

    /// The frame of a handle.
    #[inline(always)]
    pub fn frame(&self, frame: Frame) -> Outcome<FrameId> {
        let place = (frame & u64::from(u32::MAX)) as usize;
        if frame >> 32 == u64::from(self.serial) && place < self.frames.len() {
            return Ok(self.frames[place]);
        }
        let why = match frame {
            0 => "it is 0; expected one that mozzi_model_frame or mozzi_model_end_effector gives",
            _ => "it was found in another model, or never",
        };
        refuse!(Status::FOREIGN, "the frame is not of '{}': {why}", self.model.description().name)
    }

    /// Checks θ: finite numbers, unit quaternions.
    #[inline(always)]
    pub fn check_theta(&self, theta: &[f64], name: &str) -> Outcome {
        crate::border::check_finite(theta, name)?;
        if self.has_quaternions {
            self.model.check_configuration(theta).map_err(|error| of_model(&error))?;
        }
        Ok(())
    }
}

/// `mozzi_frame`.
pub type Frame = u64;

/// Writes the handle of a new model.
///
/// # Safety
/// As [`put`].
pub unsafe fn put_model(model: Result<Model, mozzi::Error>, to: *mut *mut ModelHandle) -> Outcome {
    let model = model.map_err(|error| of_model(&error))?;
    // SAFETY: the caller's promise.
    unsafe { put(Arc::new(Robot::new(model)), to) }
}
