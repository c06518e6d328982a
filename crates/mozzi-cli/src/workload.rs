//! The estimated cost of a computation, announced if it is large and refused if it is too large.

use crate::failure::{self, Failure, Result};
use mozzi::Model;

/// More steps or bytes need a flag.
const STEPS: f64 = 1e9;
const BYTES: f64 = 16e9;
/// From this share of the bounds on, costs are announced.
const ANNOUNCED: f64 = 0.01;

/// Bytes of a number in memory and binary files, and the approximate bytes of one in a text.
pub const BINARY: f64 = 8.0;
pub const TEXT: f64 = 20.0;

pub struct Workload {
    /// The flag with its value, such as "--step 1e-12".
    pub cause: String,
    pub steps: f64,
    pub rows: f64,
    pub bytes: f64,
    /// The destination of the bytes: "motion.csv", "memory".
    pub place: String,
    /// The flag that allows it.
    pub flag: Option<&'static str>,
}

/// Largest matrix n × n, bytes.
const MATRIX: f64 = 1e9;
/// Multiplications per second, to estimate the time of a factorization.
const RATE: f64 = 1e9;

/// A step of a robot with constraints is announced if solving for them takes this long, s.
const LONG_STEP: f64 = 1e-3;

/// Refuses a robot whose matrices n × n are too large, and announces one whose factorizations, or constraints, take
/// long.
pub fn matrices(model: &Model) -> Result<()> {
    square("velocities", model.n())?;
    let n = model.n() as f64;
    let seconds = n * n * n / 6.0 / RATE;
    if seconds > 1.0 {
        failure::note(&format!("the robot has {n} velocities: a factorization of M takes about {seconds:.0} s"));
    }
    let rows = model.constraint_rows() as f64;
    let seconds = rows * rows * (rows + n) / RATE;
    if seconds > LONG_STEP {
        failure::note(&format!("the robot has {rows} rows of constraints: a step takes about {seconds:.1e} s"));
    }
    Ok(())
}

/// Refuses a square matrix of so many velocities, or parameters, that is too large.
pub fn square(what: &str, n: usize) -> Result<()> {
    let bytes = BINARY * n as f64 * n as f64;
    if bytes > MATRIX {
        let most = (MATRIX / BINARY).sqrt();
        return Err(Failure::wrong(format!(
            "the robot has {n} {what}, and a matrix n × n takes {}; expected at most {most:.0} {what}, {}",
            size(bytes),
            size(MATRIX)
        )));
    }
    Ok(())
}

/// Refuses a robot of more velocities; `of` ends the sentence.
pub fn at_most(most: usize, model: &Model, of: &str) -> Result<()> {
    let n = model.n();
    if n > most {
        return Err(Failure::wrong(format!("the robot has {n} velocities, expected at most {most} {of}")));
    }
    Ok(())
}

impl Workload {
    /// Announces the workload, or refuses it unless it is allowed.
    pub fn check(&self, is_allowed: bool) -> Result<()> {
        let share = (self.steps / STEPS).max(self.bytes / BYTES);
        if share > 1.0 && !is_allowed {
            let remedy = self.flag.map(|flag| format!("; {flag} allows more")).unwrap_or_default();
            return Err(Failure::wrong(format!(
                "{} gives {}, expected at most {} steps and {}{remedy}",
                self.cause,
                self.cost(),
                count(STEPS),
                size(BYTES)
            )));
        }
        if share > ANNOUNCED {
            failure::note(&self.cost());
        }
        Ok(())
    }

    /// "2e12 steps, 2e12 rows, about 700 TB of memory"
    fn cost(&self) -> String {
        let steps = format!("{} steps", count(self.steps));
        let bytes = size(self.bytes);
        match self.place.as_str() {
            _ if self.bytes == 0.0 => steps,
            "memory" => format!("{steps}, {} rows, about {bytes} of memory", count(self.rows)),
            file => format!("{steps}, {} rows, about {bytes} in {file}", count(self.rows)),
        }
    }
}

pub fn count(x: f64) -> String {
    let short: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    if x < 1e6 { format!("{x:.0}") } else { format!("{short:e}") }
}

/// "1.5 GB"
pub fn size(bytes: f64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB", "EB"];
    let power = (bytes.max(1.0).log10() / 3.0).floor().clamp(0.0, 6.0);
    let scaled = bytes / 1000_f64.powf(power);
    let unit = units[power as usize];
    if scaled < 10.0 && power > 0.0 { format!("{scaled:.1} {unit}") } else { format!("{scaled:.0} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_short() {
        let found = [0.0, 999.0, 1500.0, 16e9, 7.04e14, 1e20].map(size);
        assert_eq!(found, ["0 B", "999 B", "1.5 kB", "16 GB", "704 TB", "100 EB"]);
        assert_eq!([12.0, 2e12, 1.25e9, 1.5e8].map(count), ["12", "2e12", "1.25e9", "1.5e8"]);
    }
}
