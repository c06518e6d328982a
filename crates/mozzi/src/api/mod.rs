//! The methods of [`Model`]: the kernels on plain numbers, answering with an error where a kernel would panic, and with
//! nalgebra's vectors and matrices. They allocate; a control loop calls the kernels with its own memory.

mod derivatives;
mod directional_derivative;
mod dynamics;
mod forward_dynamics;
mod kinematics;
mod momentum;
mod newton_euler;
mod regressor;
mod task_space;

pub use derivatives::{ForwardDynamicsDerivatives, InverseDynamicsDerivatives};
pub use newton_euler::{BodyFrame, NewtonEuler};
pub use task_space::TaskSpaceDynamics;

use crate::model::{Environment, Error, FrameId, Freedom, Model};
use crate::scalar::{Real, Scalar};
use alloc::format;

impl<C: Real + Into<f64>> Model<C> {
    /// Every argument as long as it must be: θ nq, the others, with their names, n; and every quaternion (a floating base's, a ball's, a free joint's) of length 1, to 10⁻³.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::BadArgument`] for the quaternion.
    pub fn check_lengths<const K: usize>(
        &self,
        theta: &[C],
        velocities: [(&'static str, &[C]); K],
    ) -> Result<(), Error> {
        self.check_configuration(theta)?;
        self.check_velocities(velocities)
    }

    /// Is θ as long as it must be, and is each quaternion in it of length 1 to 10⁻³?
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::BadArgument`].
    pub fn check_configuration(&self, theta: &[C]) -> Result<(), Error> {
        check_length("theta", theta, self.nq())?;
        for (k, place) in self.configuration_space().places().iter().enumerate() {
            if place.freedom != Freedom::One {
                let q = core::array::from_fn(|i| theta[place.q + i].into());
                check_unit(q).map_err(|error| match error {
                    Error::BadArgument { found, .. } if k > 0 || !self.is_floating() => {
                        let joint = self.joint_names().nth(k - usize::from(self.is_floating())).unwrap_or_default();
                        let expected = "a unit quaternion (w, x, y, z), to 1e-3";
                        Error::BadArgument {
                            what: "a joint's orientation in theta",
                            found: format!("{found}, of `{joint}`"),
                            expected,
                        }
                    }
                    error => error,
                })?;
            }
        }
        Ok(())
    }

    pub(crate) fn check_velocities<const K: usize>(&self, velocities: [(&'static str, &[C]); K]) -> Result<(), Error> {
        velocities.into_iter().try_for_each(|(what, slice)| check_length(what, slice, self.n()))
    }

    /// Is this a frame of this model, not of a larger one?
    ///
    /// # Errors
    /// [`Error::BadArgument`].
    pub fn check_frame(&self, frame: FrameId) -> Result<(), Error> {
        let frames = self.frames().len();
        if frame.0 < frames {
            return Ok(());
        }
        let found = format!("number {} of another model (this one has {frames})", frame.0);
        Err(Error::BadArgument { what: "the frame", found, expected: "a frame of this model" })
    }

    /// Are the environment's wrenches on frames of this model?
    ///
    /// # Errors
    /// [`Error::BadArgument`].
    pub fn check_environment(&self, environment: &Environment<C>) -> Result<(), Error> {
        environment.applied.iter().try_for_each(|&(frame, _)| self.check_frame(frame))
    }
}

fn check_length<C>(what: &'static str, slice: &[C], expected: usize) -> Result<(), Error> {
    let found = slice.len();
    if found == expected { Ok(()) } else { Err(Error::WrongLength { what, found, expected }) }
}

/// A floating base's quaternion may have lost digits; it is not a rotation's where it has another length altogether.
pub(crate) fn check_unit(q: [f64; 4]) -> Result<(), Error> {
    let length = Scalar::sqrt(q.iter().map(|x| x * x).sum::<f64>());
    if (length - 1.0).abs() <= 1e-3 || length.is_nan() {
        return Ok(());
    }
    let found = format!("{q:?}, of length {length}");
    let expected =
        "a unit quaternion (w, x, y, z), to 1e-3: theta of a floating base is (w, x, y, z), its origin, and the joints";
    Err(Error::BadArgument { what: "the base's orientation in theta", found, expected })
}
