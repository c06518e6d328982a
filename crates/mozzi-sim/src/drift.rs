//! The energy of a robot with loops, watched: next to change points a step may be wrong by any amount.

use crate::{Account, Error, Method, Options, Recorder, Sample};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use mozzi::model::Model;
use mozzi::scalar::Scalar;

/// The energies so far.
pub(crate) struct Drift {
    account: Account,
    /// The names of the constraints.
    loops: String,
    /// s
    step: f64,
}

impl Drift {
    /// None for a robot without constraints, and for methods of order 1, which are off anyway, or of high order.
    pub fn of(model: &Model, options: &Options) -> Option<Self> {
        let names = model.description().constraints.iter().map(|one| format!("`{}`", one.name));
        let loops = names.collect::<Vec<_>>().join(", ");
        let is_implicit = matches!(options.method, Method::Midpoint | Method::MoreauJean);
        (model.constraint_rows() > 0 && is_implicit).then(|| Drift {
            account: Account::default(),
            loops,
            step: options.step(),
        })
    }

    /// Adds a row.
    pub fn add(&mut self, row: &Sample) {
        let _ = self.account.take(row);
    }

    /// At the end of a motion: a robot that has just started has too little energy to compare with.
    ///
    /// # Errors
    /// [`Error::Drifted`] if the energy is off.
    pub fn check(&self, time: f64) -> Result<(), Error> {
        if !self.account.is_off() {
            return Ok(());
        }
        let Account { largest_drift: drift, largest_kinetic_energy: kinetic, .. } = self.account;
        // errors fall with the square of the step: to a thousandth
        let shorter = one_digit(self.step * Scalar::sqrt(1e-3 * kinetic / drift));
        Err(Error::Drifted { loops: self.loops.clone(), drift, kinetic, time, steps: [self.step, shorter] })
    }
}

/// x rounded down to one digit.
fn one_digit(x: f64) -> f64 {
    let text = format!("{x:e}");
    let power = text.split_once('e').map_or("0", |(_, power)| power);
    format!("{}e{power}", &text[..1]).parse().unwrap_or(x)
}
