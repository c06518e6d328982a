//! Checks of what a caller passes: lengths, unit quaternions, frames.

use super::{Environment, Error, FrameId, Freedom, Model};
use crate::lie::length_off_unit;
use crate::scalar::Real;
use alloc::format;

impl<C: Real + Into<f64>> Model<C> {
    /// Checks the lengths of the arguments, nq for θ and n for the others (with their names), and that every quaternion
    /// has length 1 to 10⁻³.
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

    /// Checks that the length of θ is nq and that every quaternion has length 1 to 10⁻³.
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

    /// Checks that the frame belongs to this model.
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

    /// Checks that the environment's wrenches are on frames of this model.
    ///
    /// # Errors
    /// [`Error::BadArgument`].
    pub fn check_environment(&self, environment: &Environment<C>) -> Result<(), Error> {
        environment.applied.iter().try_for_each(|&(frame, _)| self.check_frame(frame))
    }
}

pub(crate) fn check_length<C>(what: &'static str, slice: &[C], expected: usize) -> Result<(), Error> {
    let found = slice.len();
    if found == expected { Ok(()) } else { Err(Error::WrongLength { what, found, expected }) }
}

/// A floating base's quaternion may have lost digits, but a clearly different length is an error.
pub(crate) fn check_unit(q: [f64; 4]) -> Result<(), Error> {
    let Some(length) = length_off_unit(q) else { return Ok(()) };
    let found = format!("{q:?}, of length {length}");
    let expected =
        "a unit quaternion (w, x, y, z), to 1e-3: theta of a floating base is (w, x, y, z), its origin, and the joints";
    Err(Error::BadArgument { what: "the base's orientation in theta", found, expected })
}
