//! How to simulate.

use crate::Error;
use crate::{Method, Policy};
use alloc::format;
use mozzi::linalg::Vec3;

/// A state beyond this size has diverged: squares, and so energies, would overflow.
pub const LARGEST: f64 = 1e150;

/// How a simulation runs. Start from [`new`](Self::new) or [`with_step`](Self::with_step), and change what differs:
/// `Options { method: Method::Euler, ..Options::new(2.0, 2000) }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The method of integration; default [`Automatic`](Method::Automatic).
    pub method: Method,
    /// t_f in seconds, at least 0; the motion starts at t = 0.
    pub duration: f64,
    /// N, at least 1; the step is δt = t_f / N. An adaptive method chooses its own steps; δt is then the interval of
    /// the rows.
    pub steps: usize,
    /// Record the start, every k-th step, and the last; default 1.
    pub record_every: usize,
    /// Gravity in {s} coordinates, m/s², in place of the model's own. (For a {s} that accelerates by a without turning:
    /// g − a.)
    pub gravity: Option<Vec3>,
    /// Coulomb friction as in the model.
    pub friction: Friction,
    /// How to treat position limits; by default they are reported. If they are respected, a joint comes to rest at its
    /// limit, inelastically, and is held as long as it is pressed against its stop; a smooth method ends with
    /// [`Error::StopActs`] there. The start may then be beyond a limit by 10⁻⁵ rad or m.
    pub joint_limits: Policy,
}

/// How to model Coulomb friction μ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// Dry friction: |f| ≤ μ, a joint at rest sticks as long as |f| < μ holds it, and a moving one loses μ |θ̇|. See
    /// [`crate::one_sided`]. Rollouts, and batches without sticking, use μ sgn θ̇ with sgn 0 = 0.
    Coulomb,
    /// μ tanh(θ̇ / v_s), smooth, so that Runge-Kutta keeps its order; it does not stick but creeps at up to about v_s.
    /// Stiff for small v_s: the explicit methods here need δt below about v_s M / μ.
    Smooth {
        /// v_s > 0: three quarters of μ act at this speed; rad/s or m/s.
        slip_speed: f64,
    },
}

impl Options {
    /// N equal steps to t_f: the automatic method, every step recorded, gravity and friction as in the model.
    pub fn new(duration: f64, steps: usize) -> Self {
        Options {
            method: Method::Automatic,
            duration,
            steps,
            record_every: 1,
            gravity: None,
            friction: Friction::Coulomb,
            joint_limits: Policy::Report,
        }
    }

    /// As [`new`](Self::new) with the fewest equal steps that are not longer than `step` seconds (up to rounding).
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] if the step is not positive and finite, the duration not at least 0 and finite, or
    /// their ratio above 10¹².
    pub fn with_step(duration: f64, step: f64) -> Result<Self, Error> {
        check(step > 0.0 && step.is_finite(), "step", step, "a positive, finite number of seconds")?;
        check_duration(duration)?;
        let ratio = duration / step;
        check(ratio <= 1e12, "the number of steps", ratio, "at most 1e12")?;
        let whole = ratio as usize; // rounded down
        let steps = if ratio - whole as f64 > 1e-9 * ratio.max(1.0) { whole + 1 } else { whole };
        Ok(Self::new(duration, steps.max(1)))
    }

    /// δt = t_f / N in seconds.
    pub fn step(&self) -> f64 {
        self.duration / self.steps as f64
    }

    /// The time of step k: k δt, and t_f itself at the end.
    pub fn time(&self, k: usize) -> f64 {
        if k == self.steps { self.duration } else { k as f64 * self.step() }
    }

    /// True if step k is recorded: every `record_every`-th step and the last.
    pub fn is_recorded(&self, k: usize) -> bool {
        k.is_multiple_of(self.record_every) || k == self.steps
    }

    /// Checks the options.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for an invalid option.
    pub fn check(&self) -> Result<(), Error> {
        check_duration(self.duration)?;
        check(self.steps > 0, "steps", self.steps, "at least 1")?;
        check(self.record_every > 0, "record_every", self.record_every, "at least 1")?;
        if let Some(g) = self.gravity {
            check(g.0.iter().all(|x| x.is_finite()), "gravity", format!("{:?}", g.0), "finite numbers")?;
        }
        if let Friction::Smooth { slip_speed } = self.friction {
            check(slip_speed > 0.0 && slip_speed.is_finite(), "slip_speed", slip_speed, "a positive, finite speed")?;
        }
        if let Method::DormandPrince { tolerance } = self.method {
            check(tolerance > 0.0 && tolerance.is_finite(), "tolerance", tolerance, "a positive, finite number")?;
        }
        Ok(())
    }
}

fn check_duration(duration: f64) -> Result<(), Error> {
    let fine = duration >= 0.0 && duration.is_finite();
    check(fine, "duration", duration, "a finite number of seconds, at least 0")
}

pub(crate) fn check(
    fine: bool,
    what: &'static str,
    found: impl core::fmt::Display,
    expected: &'static str,
) -> Result<(), Error> {
    if fine {
        Ok(())
    } else {
        Err(Error::Model(mozzi::Error::BadArgument { what, found: format!("{found}"), expected }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_fit_the_duration() {
        let steps = |duration, step| Options::with_step(duration, step).map(|options| options.steps);
        assert_eq!(steps(2.0, 0.001).expect("fits"), 2000); // 2 / 0.001 is not below 2000 by rounding
        assert_eq!(steps(0.3, 0.1).expect("fits"), 3); // 2.9999…
        assert_eq!(steps(1.0, 0.3).expect("fits"), 4);
        assert_eq!(steps(1.0, 7.0).expect("fits"), 1);
        assert_eq!(steps(0.0, 0.1).expect("fits"), 1);
        for (duration, step) in
            [(1.0, 0.0), (1.0, -0.1), (1.0, f64::NAN), (1.0, f64::INFINITY), (-1.0, 0.1), (f64::NAN, 0.1), (1.0, 1e-13)]
        {
            assert!(
                matches!(steps(duration, step), Err(Error::Model(mozzi::Error::BadArgument { .. }))),
                "{duration} by {step}"
            );
        }
    }

    #[test]
    fn the_last_time_is_the_duration() {
        for steps in 1..500 {
            let options = Options::new(0.7, steps);
            assert_eq!(options.time(0), 0.0);
            assert_eq!(options.time(steps), 0.7);
            assert!((1..=steps).all(|k| options.time(k) > options.time(k - 1)));
        }
    }
}
