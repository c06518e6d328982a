//! The columns of a body that is fixed to a frame.

use crate::Error;
use crate::signals::Samples;
use mozzi::{FrameId, Model, SpatialInertia};

/// The robot of a log: a robot with these parameters and the payload that is known.
///
/// # Errors
/// [`Error::Model`] if the payload's frame belongs to another model.
pub(crate) fn robot_of(model: &Model, mut parameters: Vec<f64>, samples: &Samples) -> Result<Model, Error> {
    if let Some((frame, inertia)) = samples.payload {
        Carried::new(model, frame)?.add(&mut parameters, &inertia.to_parameters());
    }
    Ok(model.with_parameters(&parameters))
}

/// The parameters of a body at a frame, as combinations of those of the link that carries it.
#[derive(Clone, Debug)]
pub struct Carried {
    /// The first parameter of the link; none for a body on a fixed base, which no force depends on.
    first: Option<usize>,
    /// By column: what one unit of the body's parameter k adds to the link's parameters.
    X: [[f64; 10]; 10],
}

impl Carried {
    /// A body fixed to this frame.
    ///
    /// # Errors
    /// [`Error::Model`] if the frame belongs to another model.
    pub fn new(model: &Model, frame: FrameId) -> Result<Self, Error> {
        model.check_frame(frame)?;
        let robot = model.description();
        let name = model.frame_name(frame);
        let mut link = robot.frames.iter().find(|known| known.name == name).map_or(name, |known| known.link.as_str());
        let names = model.parameter_names();
        let first = loop {
            if let Some(k) = names.iter().position(|known| known.strip_suffix(".m") == Some(link)) {
                break Some(k);
            }
            match robot.joints.iter().find(|joint| joint.child == link) {
                Some(joint) => link = joint.parent.as_str(),
                None => break None,
            }
        };
        let poses = model.frame_poses(&model.neutral_configuration())?;
        let at = |name: &str| model.frames().position(|(_, known)| known == name).map(|k| poses[k]);
        let T = match (at(link), at(name)) {
            (Some(link), Some(frame)) => link.inverse() * frame,
            _ => mozzi::SE3::identity(),
        };
        let X = SpatialInertia::units().map(|unit| unit.transformed(T).to_parameters());
        Ok(Carried { first, X })
    }

    /// The column of the body's parameter k, from a row of the robot's regressor.
    pub fn column(&self, Y: &[f64], k: usize) -> f64 {
        self.first.map_or(0.0, |first| self.X[k].iter().zip(&Y[first..]).map(|(x, y)| x * y).sum())
    }

    /// Adds a body with these parameters to those of the robot.
    pub fn add(&self, parameters: &mut [f64], body: &[f64; 10]) {
        let Some(first) = self.first else { return };
        for (x, value) in self.X.iter().zip(body) {
            parameters[first..].iter_mut().zip(x).for_each(|(sum, x)| *sum += x * value);
        }
    }
}
