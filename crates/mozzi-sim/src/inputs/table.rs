//! Sampled inputs.

use crate::Error;
use crate::Input;
use alloc::format;
use alloc::vec::Vec;
use mozzi::model::FrameId;
use mozzi::spatial::Wrench;

/// How to extrapolate a table outside its time range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// An error, so that no input is invented.
    #[default]
    Error,
    /// The nearest row.
    Hold,
    /// Zero.
    Zero,
}

/// Rows of values at strictly increasing times, linear in between.
#[derive(Clone, Debug)]
pub struct Table {
    times: Vec<f64>,
    /// Row-major.
    values: Vec<f64>,
    outside: Outside,
}

impl Table {
    /// Row k holds at `times[k]` (seconds) the values `values[k w .. (k + 1) w]`, w = values / times. It is an error to
    /// evaluate the table outside its time range.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] if there is no row, a number is not finite, or a time does not come after the one
    /// before; [`mozzi::Error::WrongLength`] if the values do not make whole rows.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Result<Self, Error> {
        let bad = |what, found, expected| Err(Error::Model(mozzi::Error::BadArgument { what, found, expected }));
        if times.is_empty() {
            return bad("the table", "empty".into(), "at least one row");
        }
        let rows = times.len();
        let width = values.len().div_ceil(rows).max(1);
        if values.len() != rows * width {
            return Err(Error::Model(mozzi::Error::WrongLength {
                what: "the table",
                found: values.len(),
                expected: rows * width,
            }));
        }
        if let Some(k) = (1..rows).find(|&k| !(times[k] > times[k - 1])) {
            let found = format!("{} in row {} after {}", times[k], k + 1, times[k - 1]);
            return bad("the table's time", found, "strictly increasing times");
        }
        if let Some(k) = times.iter().position(|t| !t.is_finite()) {
            return bad("the table's time", format!("{} in row {}", times[k], k + 1), "finite numbers");
        }
        if let Some(k) = values.iter().position(|x| !x.is_finite()) {
            let found = format!("{} in row {}, column {}", values[k], k / width + 1, k % width + 1);
            return bad("the table's value", found, "finite numbers");
        }
        Ok(Table { times, values, outside: Outside::Error })
    }

    /// Sets how the table is extrapolated outside its time range.
    pub fn outside(self, outside: Outside) -> Self {
        Table { outside, ..self }
    }

    /// Values in a row.
    pub fn width(&self) -> usize {
        self.values.len() / self.times.len()
    }

    /// First and last time.
    pub fn range(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    /// The row at time t is (1 − s) · (row k) + s · (row k + 1): calls `each(column, value)`. O(log rows). A time that
    /// is outside the range by rounding only (10⁻¹² of its size) counts as inside.
    fn at(&self, t: f64, mut each: impl FnMut(usize, f64)) -> Result<(), Error> {
        let [first, last] = self.range();
        let slack = 1e-12 * first.abs().max(last.abs());
        if !(t >= first - slack && t <= last + slack) {
            match self.outside {
                Outside::Hold if !t.is_nan() => {}
                Outside::Zero => return Ok(()),
                _ => {
                    return Err(Error::Model(mozzi::Error::BadArgument {
                        what: "the time at which a table is asked",
                        found: format!("{t} s, outside {first} … {last} s"),
                        expected: "a time that the table covers (or tell it to hold, Outside::Hold)",
                    }));
                }
            }
        }
        let (w, t) = (self.width(), t.clamp(first, last));
        let row = |k: usize| &self.values[k * w..(k + 1) * w];
        let above = self.times.partition_point(|&time| time <= t);
        if above == self.times.len() {
            row(above - 1).iter().enumerate().for_each(|(j, &x)| each(j, x));
            return Ok(());
        }
        let (t0, t1) = (self.times[above - 1], self.times[above]);
        let s = (t - t0) / (t1 - t0);
        for (j, (&x0, &x1)) in row(above - 1).iter().zip(row(above)).enumerate() {
            each(j, (1.0 - s) * x0 + s * x1);
        }
        Ok(())
    }
}

/// τ from a table of n columns.
#[derive(Clone, Debug)]
pub struct TorqueTable(pub Table);

impl Input for TorqueTable {
    fn torque(&mut self, t: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        if self.0.width() != tau.len() {
            let (found, expected) = (self.0.width(), tau.len());
            return Err(Error::Model(mozzi::Error::WrongLength {
                what: "a row of the table of torques",
                found,
                expected,
            }));
        }
        self.0.at(t, |j, x| tau[j] += x)
    }
}

/// The wrenches that one frame applies to the environment, from a table of 6 columns: (m, f), **angular first**, in the
/// frame's coordinates.
#[derive(Clone, Debug)]
pub struct WrenchTable(pub FrameId, pub Table);

impl Input for WrenchTable {
    fn applied(&mut self, t: f64, _: &[f64], _: &[f64], wrenches: &mut Vec<(FrameId, Wrench)>) -> Result<(), Error> {
        if self.1.width() != 6 {
            let found = self.1.width();
            return Err(Error::Model(mozzi::Error::WrongLength {
                what: "a row of the table of wrenches",
                found,
                expected: 6,
            }));
        }
        let mut F = [0.0; 6];
        self.1.at(t, |j, x| F[j] = x)?;
        wrenches.push((self.0, Wrench::from_array(F)));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate;
    use crate::tests::robots::{difference, double_pendulum};
    use crate::{Options, applied, torque};
    use alloc::vec;

    fn row(table: &Table, t: f64) -> Result<Vec<f64>, Error> {
        let mut row = vec![0.0; table.width()];
        table.at(t, |j, x| row[j] = x)?;
        Ok(row)
    }

    #[test]
    fn rows_are_joined_by_lines() {
        let table = Table::new(vec![-1.0, 0.0, 0.5], vec![0.0, 1.0, 2.0, 5.0, 4.0, -3.0]).expect("a table");
        for (t, expected) in
            [(-1.0, [0.0, 1.0]), (-0.75, [0.5, 2.0]), (0.0, [2.0, 5.0]), (0.25, [3.0, 1.0]), (0.5, [4.0, -3.0])]
        {
            assert_eq!(row(&table, t).expect("covered"), expected);
        }
        assert_eq!(row(&table, 0.5 + 1e-13).expect("rounding"), [4.0, -3.0]);
        let message = row(&table, 0.6).expect_err("beyond").to_string();
        assert!(message.contains("0.6 s, outside -1 … 0.5 s"), "{message}");
        assert!(row(&table, -1.1).is_err() && row(&table, f64::NAN).is_err());
        let held = table.clone().outside(Outside::Hold);
        assert_eq!(
            (row(&held, 9.0).expect("held"), row(&held, -9.0).expect("held")),
            (vec![4.0, -3.0], vec![0.0, 1.0])
        );
        assert!(row(&held, f64::NAN).is_err());
        assert_eq!(row(&table.outside(Outside::Zero), 9.0).expect("zero"), [0.0, 0.0]);
    }

    #[test]
    fn bad_tables_are_refused() {
        let message =
            |times: &[f64], values: &[f64]| Table::new(times.to_vec(), values.to_vec()).expect_err("bad").to_string();
        assert!(message(&[], &[]).contains("at least one row"));
        assert!(message(&[0.0, 0.0], &[1.0, 2.0]).contains("0 in row 2 after 0"));
        assert!(message(&[0.0, f64::NAN], &[1.0, 2.0]).contains("NaN in row 2"));
        assert!(message(&[0.0, f64::INFINITY], &[1.0, 2.0]).contains("inf in row 2"));
        assert!(message(&[0.0, 1.0], &[1.0, 2.0, 3.0, f64::NAN]).contains("row 2, column 2"));
        assert!(message(&[0.0, 1.0], &[1.0, 2.0, 3.0]).contains("3 entries, expected 4"));
        assert!(message(&[0.0, 1.0], &[]).contains("0 entries"));
    }

    #[test]
    fn a_table_is_the_function_that_it_samples() {
        let robot = double_pendulum();
        let tip = robot.frame("rod2").expect("there");
        let push = |t: f64| [0.0, 0.0, 0.0, 3.0 - t, 1.0, 2.0 * t];
        let by_function = (
            torque(|t, _, _, tau| (tau[0], tau[1]) = (1.0 - 2.0 * t, 0.5 * t)),
            applied(tip, |t, _, _| Wrench::from_array(push(t))),
        );
        let times = vec![0.0, 0.3, 0.31, 1.0];
        let rows = |f: &dyn Fn(f64) -> Vec<f64>| Table::new(times.clone(), times.iter().flat_map(|&t| f(t)).collect());
        let by_table = (
            TorqueTable(rows(&|t| vec![1.0 - 2.0 * t, 0.5 * t]).expect("a table")),
            WrenchTable(tip, rows(&|t| push(t).to_vec()).expect("a table")),
        );
        let options = Options::new(1.0, 37);
        let a = simulate(&robot, &[0.3, 0.1], &[0.0, 1.0], by_function, &options).expect("a motion");
        let b = simulate(&robot, &[0.3, 0.1], &[0.0, 1.0], by_table, &options).expect("a motion");
        assert!(difference(&a.theta, &b.theta) < 1e-12 && difference(&a.tau, &b.tau) < 1e-14);
    }

    #[test]
    fn tables_of_other_robots_are_refused() {
        let robot = double_pendulum();
        let (table, options) = (Table::new(vec![0.0, 1.0], vec![0.0; 6]).expect("a table"), Options::new(1.0, 10));
        let start = ([0.0; 2], [0.0; 2]);
        let wrong = simulate(&robot, &start.0, &start.1, TorqueTable(table.clone()), &options);
        assert!(
            matches!(wrong, Err(Error::Model(mozzi::Error::WrongLength { found: 3, expected: 2, .. }))),
            "{wrong:?}"
        );
        let wrench = WrenchTable(robot.frame("rod2").expect("there"), table);
        let wrong = simulate(&robot, &start.0, &start.1, wrench, &options);
        assert!(
            matches!(wrong, Err(Error::Model(mozzi::Error::WrongLength { found: 3, expected: 6, .. }))),
            "{wrong:?}"
        );
        let short = TorqueTable(Table::new(vec![0.0, 0.5], vec![0.0; 4]).expect("a table"));
        assert!(matches!(
            simulate(&robot, &start.0, &start.1, short, &options),
            Err(Error::Model(mozzi::Error::BadArgument { .. }))
        ));
    }
}
