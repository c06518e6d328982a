//! Quantities that only a picture needs, from the library's results.

mod anchors;
mod coordinates;
mod ellipsoid;
mod motion;

use crate::bodies::Bodies;
use crate::request::Output;
use mozzi::{Environment, Error, FrameId, Model};

/// A quantity of a picture, requested as those of [`mozzi::quantities::LIST`].
#[derive(Debug)]
pub struct Drawn {
    /// Its name.
    pub name: &'static str,
    /// A short description.
    pub formula: &'static str,
    /// The names of its inputs.
    pub inputs: &'static [&'static str],
    /// Whether it refers to a frame.
    pub of_frame: bool,
    pub(crate) outputs: fn(&Model) -> Vec<Output>,
    pub(crate) compute: fn(&Call) -> Result<Vec<f64>, Error>,
}

/// All of them.
pub const LIST: [&Drawn; 7] = [
    &motion::BODY_MOTION,
    &anchors::CONSTRAINT_ANCHORS,
    &anchors::CONSTRAINT_WRENCHES,
    &ellipsoid::VELOCITY_ELLIPSOID,
    &coordinates::COORDINATES,
    &coordinates::CONFIGURATION,
    &coordinates::UNIT_CONFIGURATION,
];

/// The arguments of a computation; inputs have the right lengths.
#[derive(Debug)]
pub(crate) struct Call<'a> {
    pub model: &'a Model,
    pub bodies: &'a Bodies,
    /// In the order of [`Drawn::inputs`].
    pub inputs: &'a [&'a [f64]],
    pub environment: &'a Environment<'a>,
    /// The frame, if the quantity refers to one.
    pub frame: Option<FrameId>,
}

pub(crate) fn output(name: &'static str, shape: impl Into<Vec<usize>>, unit: &'static str) -> Output {
    Output { name, shape: shape.into(), unit }
}
