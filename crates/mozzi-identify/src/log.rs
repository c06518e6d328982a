//! A recorded motion, and the check of its rows.

use crate::{Error, Finding, order};
use mozzi::{FrameId, Freedom, Model, SpatialInertia};

/// A recorded motion with its torques. Tables are by rows: N rows of nq or n numbers in the model's order.
#[derive(Clone, Debug, Default)]
pub struct Log {
    /// Its name in messages.
    pub name: String,
    /// Times, s, increasing.
    pub t: Vec<f64>,
    /// Whether the times are known to be in seconds; otherwise ms, µs and ns are recognised.
    pub is_time_certain: bool,
    /// Positions θ, N × nq: rad or m.
    pub theta: Vec<f64>,
    /// Velocities θ̇, N × n; without them they are differentiated from θ.
    pub dtheta: Option<Vec<f64>>,
    /// Accelerations θ̈, N × n, if they are known better than by differentiation, as in simulations.
    pub ddtheta: Option<Vec<f64>>,
    /// Measured forces τ, N × n: N m or N; or motor currents, if drive gains are estimated.
    pub tau: Vec<f64>,
    /// Target positions θ* of position controllers, N × n, of joints of one axis.
    pub target: Option<Vec<f64>>,
    /// Measured wrenches that frames apply to the environment, N × 6 each, in the frame's coordinates, (m, f).
    pub wrenches: Vec<(FrameId, Vec<f64>)>,
    /// A known payload that was fixed to a frame, its inertia in the frame's coordinates.
    pub payload: Option<(FrameId, SpatialInertia)>,
}

/// A gap is a step in time longer than this many median steps.
const GAP: f64 = 5.0;

/// Equal extreme forces in this many consecutive rows are saturation.
const SATURATED: usize = 5;

/// The rows of a log that can be used: runs of rows without gaps, and forces that are not saturated.
#[derive(Clone, Debug)]
pub struct Rows {
    /// The rows of each run.
    pub runs: Vec<Vec<usize>>,
    /// Median step of time, s.
    pub step: f64,
    /// N × n: whether the force is saturated there.
    pub saturated: Vec<bool>,
    /// Findings in the log.
    pub findings: Vec<Finding>,
}

impl Log {
    /// The largest share of rows that may contain NaN.
    pub const MOST_MISSING: f64 = 0.05;

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.t.len()
    }

    /// Whether another log holds the same motion and forces.
    pub fn is_same(&self, other: &Log) -> bool {
        self.rows() > 0 && self.theta == other.theta && self.tau == other.tau
    }

    /// All tables with their names and widths.
    fn tables<'l>(&'l self, model: &Model) -> Vec<(&'static str, &'l [f64], usize)> {
        let mut all = vec![("theta", self.theta.as_slice(), model.nq()), ("tau", self.tau.as_slice(), model.n())];
        all.extend(self.dtheta.as_deref().map(|table| ("dtheta", table, model.n())));
        all.extend(self.ddtheta.as_deref().map(|table| ("ddtheta", table, model.n())));
        all.extend(self.target.as_deref().map(|table| ("target", table, model.n())));
        all.extend(self.wrenches.iter().map(|(_, table)| ("wrench", table.as_slice(), 6)));
        all
    }

    pub(crate) fn check_lengths(&self, model: &Model) -> Result<(), Error> {
        let N = self.rows();
        for (what, table, width) in self.tables(model) {
            if table.len() != N * width {
                let expected = format!("{N} rows of {width}");
                return Err(Error::WrongLength { log: self.name.clone(), what, found: table.len(), expected });
            }
        }
        Ok(())
    }

    /// Checks lengths, times and numbers. Rows with NaN and rows that repeat the row before are left out; a step in
    /// time longer than five median steps ends a run.
    ///
    /// # Errors
    /// [`Error::WrongLength`], [`Error::NotMonotonic`], [`Error::NotFinite`] if more than 5 % of the rows are not
    /// numbers, [`Error::TooShort`] with fewer than 20 rows.
    pub fn check(&self, model: &Model) -> Result<Rows, Error> {
        let (N, n, log) = (self.rows(), model.n(), || self.name.clone());
        self.check_lengths(model)?;
        let tables = self.tables(model);
        let (mut findings, mut usable, mut missing) = (Vec::new(), Vec::new(), None);
        let (mut not_finite, mut repeated) = (0, 0);
        for row in 0..N {
            let bad = tables.iter().find_map(|&(what, table, width)| {
                let k = table[row * width..][..width].iter().position(|x| !x.is_finite())?;
                Some(format!("{what} {}", k + 1))
            });
            let bad = bad.or_else(|| (!self.t[row].is_finite()).then(|| "t".to_string()));
            if let Some(column) = bad {
                not_finite += 1;
                missing.get_or_insert((column, row));
                continue;
            }
            if let Some(&last) = usable.last() {
                let same = |&(_, table, width): &(&str, &[f64], usize)| {
                    table[row * width..][..width] == table[last * width..][..width]
                };
                if tables.iter().all(same) {
                    repeated += 1;
                    continue;
                }
                if !(self.t[row] > self.t[last]) {
                    let (found, before) = (self.t[row], self.t[last]);
                    let why = order::explain(&self.t, row);
                    return Err(Error::NotMonotonic { log: log(), row, found, before, why });
                }
            }
            usable.push(row);
        }
        if let Some((column, row)) = missing {
            if not_finite as f64 > Log::MOST_MISSING * N as f64 {
                return Err(Error::NotFinite { log: log(), column, row, count: not_finite, rows: N });
            }
            findings.push(Finding::warning(
                "not_finite",
                format!(
                    "{}: {not_finite} rows with NaN or infinite numbers are left out, first `{column}` at row {row}",
                    self.name
                ),
            ));
        }
        if repeated > 0 {
            findings.push(Finding::note(
                "repeated_rows",
                format!("{}: {repeated} of {N} rows repeat the row before and are left out", self.name),
            ));
        }
        let expected = 20;
        if usable.len() < expected {
            return Err(Error::TooShort {
                log: log(),
                found: usable.len(),
                expected,
                why: self.few(N, repeated, not_finite),
            });
        }
        let step = self.median_step(&usable, repeated, &mut findings);
        let runs = self.runs(&usable, step);
        self.constants(model, &usable, &mut findings);
        let saturated = self.saturated(model, &usable, &mut findings);
        debug_assert_eq!(saturated.len(), N * n);
        Ok(Rows { runs, step, saturated, findings })
    }

    /// The median step of time; a warning if steps vary.
    fn median_step(&self, usable: &[usize], repeated: usize, findings: &mut Vec<Finding>) -> f64 {
        let mut steps: Vec<f64> = usable.windows(2).map(|w| self.t[w[1]] - self.t[w[0]]).collect();
        steps.sort_unstable_by(f64::total_cmp);
        let median = steps[steps.len() / 2];
        let at = |share: f64| steps[((steps.len() - 1) as f64 * share) as usize];
        let spread = (at(0.95) - at(0.05)) / median;
        if spread > 0.2 && repeated == 0 {
            findings.push(Finding::note(
                "jitter",
                format!(
                    "{}: steps of time vary between {:.3e} and {:.3e} s (5 % and 95 %); the log is \
                     resampled every {median:.3e} s",
                    self.name,
                    at(0.05),
                    at(0.95)
                ),
            ));
        }
        median
    }

    /// Why few rows are usable.
    fn few(&self, rows: usize, repeated: usize, not_finite: usize) -> String {
        match (repeated, not_finite) {
            (0, 0) => format!("of {rows}"),
            (_, 0) => format!("of {rows}; {repeated} repeat the row before: the numbers are constant"),
            _ => format!("of {rows}; {repeated} repeat the row before, {not_finite} are not finite"),
        }
    }

    /// Positions that never change, and forces that do not.
    fn constants(&self, model: &Model, usable: &[usize], findings: &mut Vec<Finding>) {
        let (n, nq) = (model.n(), model.nq());
        let range = |table: &[f64], width: usize, k: usize| {
            let of = usable.iter().map(|&row| table[row * width + k]);
            of.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
        };
        let names: Vec<&str> = model.velocity_names().collect();
        for place in model.places().iter().filter(|place| place.freedom == Freedom::One) {
            let name = names[place.j];
            let (low, high) = range(&self.theta, nq, place.q);
            let speed = self.dtheta.as_ref().map_or((0.0, 0.0), |table| range(table, n, place.j));
            let file = &self.name;
            if low == high && speed.0 == speed.1 {
                findings.push(Finding::warning(
                    "not_moving",
                    format!("{file}: the position of {name} is {low} in all rows; --lock {name}={low} keeps it there"),
                ));
            } else if low == high {
                findings.push(Finding::fault(
                    "constant",
                    format!(
                        "{file}: the position of {name} is {low} in all rows, but its velocity is between {} and {}: the \
                         position is constant, its encoder was not read",
                        speed.0, speed.1
                    ),
                ));
            }
            let (least, most) = range(&self.tau, n, place.j);
            if least == most && low < high {
                findings.push(Finding::fault(
                    "constant",
                    format!(
                        "{file}: the force of {name} is constant, {least} in all rows, while the joint moves: it was not \
                         measured, or no motor drives it"
                    ),
                ));
            }
        }
    }

    fn runs(&self, usable: &[usize], step: f64) -> Vec<Vec<usize>> {
        let mut runs: Vec<Vec<usize>> = vec![Vec::new()];
        for (k, &row) in usable.iter().enumerate() {
            if k > 0 && self.t[row] - self.t[usable[k - 1]] > GAP * step {
                runs.push(Vec::new());
            }
            if let Some(run) = runs.last_mut() {
                run.push(row);
            }
        }
        runs
    }

    /// Forces that stay at their extreme value, or at the effort limit, are saturated.
    fn saturated(&self, model: &Model, usable: &[usize], findings: &mut Vec<Finding>) -> Vec<bool> {
        let n = model.n();
        let mut saturated = vec![false; self.rows() * n];
        for j in 0..n {
            let of = |row: usize| self.tau[row * n + j];
            let (low, high) = usable.iter().fold((f64::MAX, f64::MIN), |(a, b), &row| (a.min(of(row)), b.max(of(row))));
            if low == high {
                continue; // unused, or a base without a motor
            }
            let mut k = 0;
            let mut count = 0;
            while k < usable.len() {
                let start = k;
                let value = of(usable[k]);
                while k < usable.len() && of(usable[k]) == value {
                    k += 1;
                }
                if k - start >= SATURATED && (value == low || value == high) {
                    count += k - start;
                    usable[start..k].iter().for_each(|&row| saturated[row * n + j] = true);
                }
            }
            if count > 0 {
                findings.push(Finding::warning(
                    "saturation",
                    format!(
                        "{}: the force of {} stays at its extreme value in {count} rows ({low} or \
                         {high}); they are left out",
                        self.name,
                        model.velocity_names().nth(j).unwrap_or_default()
                    ),
                ));
            }
        }
        saturated
    }
}

/// A gap up to this many periods of the cut-off is bridged: between its ends a signal within the band of the motion, a
/// fifth of the cut-off, is a straight line to 1 %.
const BRIDGED: f64 = 0.2;

impl Rows {
    /// Joins runs over gaps that are short against the period of the cut-off, Hz; longer gaps are named.
    pub(crate) fn bridge(&mut self, log: &Log, cutoff: Option<f64>, findings: &mut Vec<Finding>) {
        let longest = cutoff.map_or(0.0, |cutoff| BRIDGED / cutoff);
        let (mut joined, mut count, mut most) = (Vec::<Vec<usize>>::new(), 0, 0.0_f64);
        let mut gaps: Vec<(f64, f64)> = Vec::new();
        for run in std::mem::take(&mut self.runs) {
            let ends = joined.last().and_then(|run| run.last()).zip(run.first()).map(|(a, b)| (log.t[*a], log.t[*b]));
            match (joined.last_mut(), ends) {
                (Some(last), Some((from, to))) if to - from <= longest => {
                    (count, most) = (count + 1, most.max(to - from));
                    last.extend(run);
                }
                (_, ends) => {
                    gaps.extend(ends);
                    joined.push(run);
                }
            }
        }
        self.runs = joined;
        if count > 0 {
            findings.push(Finding::note(
                "bridged",
                format!(
                    "{}: {count} gaps of up to {:.1} ms are short against the cut-off's period, {:.0} ms, and are bridged",
                    log.name,
                    1e3 * most,
                    1e3 / cutoff.unwrap_or(1.0)
                ),
            ));
        }
        if let Some((from, to)) = gaps.first() {
            let more = if gaps.len() > 1 { format!(", and in {} further gaps", gaps.len() - 1) } else { String::new() };
            let what = format!("{}: no rows can be used between t = {from} and {to} s{more}", log.name);
            findings.push(Finding::warning("gap", format!("{what}; the parts are filtered separately")));
        }
    }
}
