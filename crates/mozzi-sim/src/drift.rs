//! The energy of a robot with loops, watched: next to change points a step may be wrong by any amount.

use crate::{Account, Error, Method, Recorder, Sample};
use alloc::format;
use alloc::vec::Vec;
use mozzi::model::Model;
use mozzi::scalar::Scalar;

/// The energies so far.
pub(crate) struct Drift(Account);

impl Drift {
    /// None for a robot without constraints, and for methods of order 1, which are off anyway, or of high order.
    pub fn of(model: &Model, method: Method) -> Option<Self> {
        let is_implicit = matches!(method, Method::Midpoint | Method::MoreauJean);
        (model.constraint_rows() > 0 && is_implicit).then(|| Drift(Account::default()))
    }

    /// Adds a row.
    pub fn add(&mut self, row: &Sample) {
        let _ = self.0.take(row);
    }

    /// At the end of a motion by such steps: a robot that has just started has too little energy to compare with.
    ///
    /// # Errors
    /// [`Error::Drifted`] if the energy is off.
    pub fn check(&self, model: &Model, time: f64, step: f64) -> Result<(), Error> {
        if !self.0.is_off() {
            return Ok(());
        }
        let Account { largest_drift: drift, largest_kinetic_energy: kinetic, .. } = self.0;
        // errors fall with the square of the step: to a thousandth
        let shorter = one_digit(step * Scalar::sqrt(1e-3 * kinetic / drift));
        let names = model.description().constraints.iter().map(|one| format!("`{}`", one.name));
        let loops = names.collect::<Vec<_>>().join(", ");
        Err(Error::Drifted { loops, drift, kinetic, time, steps: [step, shorter] })
    }
}

/// x rounded down to one digit.
fn one_digit(x: f64) -> f64 {
    let text = format!("{x:e}");
    let power = text.split_once('e').map_or("0", |(_, power)| power);
    format!("{}e{power}", &text[..1]).parse().unwrap_or(x)
}
