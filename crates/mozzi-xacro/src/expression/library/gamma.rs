//! The gamma function, with Python's errors at its poles.

use crate::expression::values::float;
use crate::fault::{Fault, Result};

fn pole(x: f64) -> Box<Fault> {
    Fault::new(format!("{} is outside of its domain", float::repr(x)))
}

/// Γ(x)
pub(crate) fn gamma(x: f64) -> Result<f64> {
    if x == f64::NEG_INFINITY || x <= 0.0 && x.fract() == 0.0 {
        return Err(pole(x));
    }
    // whole numbers are exact
    if (1.0..=23.0).contains(&x) && x.fract() == 0.0 {
        return Ok((1..x as u64).map(|k| k as f64).product());
    }
    match libm::tgamma(x) {
        result if result.is_infinite() && x.is_finite() => {
            Err(Fault::new(format!("its value at {} is too large for a float", float::repr(x))))
        }
        result => Ok(result),
    }
}

/// ln |Γ(x)|
pub(crate) fn log_gamma(x: f64) -> Result<f64> {
    match x {
        x if x.is_infinite() => Ok(f64::INFINITY),
        x if x <= 0.0 && x.fract() == 0.0 => Err(pole(x)),
        x if x == 1.0 || x == 2.0 => Ok(0.0),
        x => Ok(libm::lgamma(x)),
    }
}
