//! The times of a motion's rows.

use crate::failure::{Failure, Result};
use crate::numbers::number;
use crate::workload::{self, BINARY, TEXT};

/// Largest number of rows of a motion, all of which are in memory.
const MOST: f64 = 1e7;

/// The multiples of --step before the end, and the end. A row has so many numbers.
pub fn times(step: &str, duration: f64, width: usize) -> Result<Vec<f64>> {
    let step_s = number("--step", step)?;
    let count = duration / step_s;
    if !(step_s > 0.0) || count > MOST {
        let cost = match step_s > 0.0 {
            true => {
                let bytes = count * width as f64 * (BINARY + TEXT);
                format!("{} rows, about {} of memory", workload::count(count), workload::size(bytes))
            }
            false => "no rows".to_string(),
        };
        return Err(Failure::wrong(format!(
            "--step is {}, which gives {cost}; expected a positive number of seconds that gives at most 10⁷ rows",
            step.trim()
        )));
    }
    Ok(mozzi_motion::trajectories::times(step_s, duration))
}

#[cfg(test)]
mod tests {
    use super::times;

    #[test]
    fn steps_are_kept_and_the_last_row_is_the_end() {
        let of = |step: &str, duration: f64| times(step, duration, 1).expect("times");
        assert_eq!(of("0.25", 1.0), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(of("0.3", 1.0), [0.0, 0.3, 2.0 * 0.3, 3.0 * 0.3, 1.0]);
        assert_eq!(of("0.1", 0.3), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(of("1e9", 2.0), [0.0, 2.0]);
        assert_eq!(of("0.1", 0.0), [0.0]);
        assert!(times("0", 1.0, 1).is_err() && times("1e-9", 1.0, 1).is_err() && times("-1", 1.0, 1).is_err());
    }
}
