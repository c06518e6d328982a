//! Limits of velocity, acceleration and torque along a path.

use crate::Error;
use crate::error::check;
use mozzi::Model;
use mozzi::model::Bounds;

/// Largest excess over a limit, relative to it.
const EXCESS: f64 = 1e-9;
/// How often limits that are exceeded between the samples are drawn in: two or three times are enough.
pub(super) const CORRECTIONS: usize = 20;

/// Limits of each of the n velocities, ∞ if there is none. They hold in both directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// |θ̇|, rad/s or m/s.
    pub velocity: Vec<f64>,
    /// |θ̈|, rad/s² or m/s².
    pub acceleration: Vec<f64>,
    /// |τ|, N m or N.
    pub torque: Vec<f64>,
}

impl Limits {
    /// No limits.
    pub fn none(model: &Model) -> Self {
        let none = vec![f64::INFINITY; model.n()];
        Limits { velocity: none.clone(), acceleration: none.clone(), torque: none }
    }

    /// The limits of velocity, acceleration and effort of the robot's description; a ball's apply to each of its three
    /// velocities, a mimic joint's velocity and acceleration to its source. Of the formats, URDF 1.2 and JSON have
    /// limits of acceleration.
    pub fn of(model: &Model) -> Self {
        let mut limits = Limits::none(model);
        let [velocity, acceleration] = Bounds::of_rates(model);
        for (k, (place, joint)) in model.places().iter().zip(model.joints()).enumerate() {
            limits.velocity[place.velocities()].fill(velocity[k]);
            limits.acceleration[place.velocities()].fill(acceleration[k]);
            limits.torque[place.velocities()].fill(joint.limits.effort.unwrap_or(f64::INFINITY));
        }
        limits
    }

    /// Draws in each limit by as much as it is exceeded, from the largest used fractions of the limits of velocity,
    /// acceleration and torque; false if none is exceeded.
    pub(super) fn draw_in(&mut self, shares: &[Vec<f64>; 3]) -> bool {
        if shares.iter().flatten().all(|&share| share <= 1.0 + EXCESS) {
            return false;
        }
        for (list, shares) in [&mut self.velocity, &mut self.acceleration, &mut self.torque].into_iter().zip(shares) {
            list.iter_mut().zip(shares).for_each(|(limit, share)| *limit /= share.max(1.0));
        }
        true
    }

    pub(super) fn check(&self, model: &Model) -> Result<(), Error> {
        for (what, list) in [
            ("a velocity limit", &self.velocity),
            ("an acceleration limit", &self.acceleration),
            ("a torque limit", &self.torque),
        ] {
            if list.len() != model.n() {
                let (found, expected) = (list.len(), model.n());
                return Err(mozzi::Error::WrongLength { what: "a list of limits", found, expected }.into());
            }
            for (x, joint) in list.iter().zip(model.velocity_names()) {
                check(*x > 0.0, what, format!("{x} of `{joint}`"), "a positive number, or infinity")?;
            }
        }
        Ok(())
    }
}

/// The error of limits that stay exceeded between the samples.
pub(super) fn exceeded(what: &'static str, samples: usize) -> Error {
    let found = format!("{samples}, between which limits are exceeded");
    mozzi::Error::BadArgument { what, found, expected: "more" }.into()
}
