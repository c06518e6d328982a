//! Signals that are constant while the robot moves: encoders that were not read, forces that were not measured.

use super::{axes, quantile};
use crate::cores::each;
use crate::{Finding, Level, Log};
use mozzi::Model;
use std::borrow::Cow;
use std::ops::Range;

/// A stuck signal is constant in at least this many rows, for at least this time, s, and for this many times the mean
/// length of its other runs of equal numbers, which coarse numbers explain.
const LONG: (usize, f64, f64) = (50, 0.2, 20.0);

/// The joint moves meanwhile: at this share of its mean speed, and this many steps of its position, at least this far.
const MOVES: (f64, f64, f64) = (0.2, 20.0, 1e-3);

/// A stop within one row: its change of velocity is this many times what 99.9 % of the rows have.
const ABRUPT: f64 = 5.0;

/// Speeds are differences over this time, s.
const PACE: f64 = 0.05;

/// A larger share of rows with a stuck force is a fault.
const MOST: f64 = 0.5;

/// Names stuck positions and velocities, and removes the rows of stuck forces.
pub fn check(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (N, n, nq) = (log.rows(), model.n(), model.nq());
    let rows = fresh_rows(log);
    if rows.len() < LONG.0 {
        return;
    }
    let t: Vec<f64> = rows.iter().map(|&row| log.t[row]).collect();
    let column = |table: &[f64], width: usize, k: usize| -> Vec<f64> {
        rows.iter().map(|&row| table[row * width + k]).collect()
    };
    let joints = axes(model);
    let found = each(joints.len(), log.theta.len(), |k| {
        let (q, j, name) = &joints[k];
        let mut found = Stuck::default();
        let theta = Signal { t: &t, x: column(&log.theta, nq, *q) };
        let dtheta = log.dtheta.as_ref().map(|table| column(table, n, *j));
        let whole = 0..rows.len();
        let stuck = |x: &[f64], is_stuck: &dyn Fn(&Range<usize>) -> bool| -> Vec<Range<usize>> {
            let runs = theta.long_runs(x).into_iter();
            runs.filter(|run| *run != whole && is_stuck(run)).collect()
        };
        let where_ = |runs: &[Range<usize>]| spans(&t, runs);
        // the velocity moves on, or the joint would have stopped within a row
        let is_read = |run: &Range<usize>| !(dtheta.as_ref().is_some_and(|v| theta.passes(v, run)) || theta.stops(run));
        let encoder = stuck(&theta.x, &|run| !is_read(run));
        if let Some(run) = encoder.first() {
            found.findings.push(Finding::fault(
                "stuck",
                format!(
                    "{}: the position of {name} is constant, {}, {}, although the joint moves: its encoder was not read; \
                     cut the log there",
                    log.name,
                    theta.x[run.start],
                    where_(&encoder)
                ),
            ));
            return found; // nothing else is judged by these positions
        }
        if let Some(v) = &dtheta {
            let runs = theta.long_runs(v).into_iter().filter(|run| theta.leaves(v[run.start], run));
            let runs: Vec<Range<usize>> = runs.collect();
            if let Some(run) = runs.first() {
                found.velocity = Some((name.clone(), v[run.start] + 0.0, runs.clone())); // no -0
            }
        }
        let tau = column(&log.tau, n, *j);
        let (low, high) = tau.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        let forces = stuck(&tau, &|run| (low < tau[run.start] && tau[run.start] < high) && theta.leaves(0.0, run));
        if let Some(run) = forces.first() {
            let count: usize = forces.iter().map(|run| run.len()).sum();
            let what = format!(
                "{}: the force of {name} is constant, {}, {}, while the joint moves: it was not measured",
                log.name,
                tau[run.start],
                where_(&forces)
            );
            if count as f64 > MOST * rows.len() as f64 {
                found.findings.push(Finding::fault("stuck", format!("{what} in most of the log; log it")));
            } else {
                found.findings.push(Finding::warning("stuck", format!("{what}; these {count} rows are left out")));
                found.forces = forces;
            }
        }
        found
    });
    let (mut without_velocity, mut is_out, mut more) = (Vec::new(), vec![false; N], Vec::new());
    for mut of in found {
        more.append(&mut of.findings);
        without_velocity.extend(of.velocity);
        of.forces.iter().for_each(|run| (rows[run.start]..=rows[run.end - 1]).for_each(|row| is_out[row] = true));
    }
    more.extend(of_velocities(log, &t, joints.len(), &without_velocity));
    let is_fault = more.iter().any(|finding| finding.level == Level::Fault);
    findings.append(&mut more);
    if !is_fault && is_out.contains(&true) {
        log.to_mut().keep(&|row| !is_out[row]);
    }
}

/// The stuck signals of one joint.
#[derive(Default)]
struct Stuck {
    findings: Vec<Finding>,
    /// A velocity's joint, its value and where it is constant.
    velocity: Option<(String, f64, Vec<Range<usize>>)>,
    /// Where the force is constant.
    forces: Vec<Range<usize>>,
}

/// Velocities that do not follow the positions for a while.
fn of_velocities(log: &Log, t: &[f64], joints: usize, stuck: &[(String, f64, Vec<Range<usize>>)]) -> Option<Finding> {
    let (_, value, runs) = stuck.first()?;
    let of = match stuck.len() {
        count if count == joints && joints > 1 => "every joint".to_string(),
        _ => stuck.iter().map(|(name, ..)| name.as_str()).collect::<Vec<_>>().join(", "),
    };
    Some(Finding::fault(
        "stuck",
        format!(
            "{}: the velocity of {of} is constant, {value}, {}, while the positions move: it was not measured; leave \
             velocities out, then positions are differentiated",
            log.name,
            spans(t, runs)
        ),
    ))
}

/// Rows that do not repeat the row before.
fn fresh_rows(log: &Log) -> Vec<usize> {
    let N = log.rows();
    let tables: Vec<&[f64]> =
        [log.theta.as_slice(), log.tau.as_slice()].into_iter().chain(log.dtheta.as_deref()).collect();
    let differs = |row: usize| {
        tables.iter().any(|table| {
            let width = table.len() / N;
            table[row * width..][..width] != table[(row - 1) * width..][..width]
        })
    };
    (0..N).filter(|&row| row == 0 || differs(row)).collect()
}

/// The time of the first span, and how many follow.
fn spans(t: &[f64], runs: &[Range<usize>]) -> String {
    let Some(run) = runs.first() else { return String::new() };
    let more = if runs.len() > 1 { format!(" and in {} further spans", runs.len() - 1) } else { String::new() };
    match (run.start, run.end == t.len()) {
        (0, true) => "in all rows".to_string(),
        (start, true) => format!("from t = {} s to the end", t[start]),
        (start, false) => format!("from t = {} s to {} s{more}", t[start], t[run.end - 1]),
    }
}

/// A joint's position at its times.
struct Signal<'a> {
    t: &'a [f64],
    x: Vec<f64>,
}

impl Signal<'_> {
    /// Runs of equal numbers that are longer than coarse numbers explain.
    fn long_runs(&self, x: &[f64]) -> Vec<Range<usize>> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        for k in 0..x.len() {
            match runs.last_mut() {
                Some(run) if x[run.start] == x[k] => run.end = k + 1,
                _ => runs.push(k..k + 1),
            }
        }
        let (rows, time, usual) = LONG;
        let is_long = |run: &Range<usize>| {
            let others = (x.len() - run.len()) as f64 / (runs.len() - 1).max(1) as f64;
            run.len() >= rows && self.t[run.end - 1] - self.t[run.start] >= time && run.len() as f64 > usual * others
        };
        runs.iter().filter(|run| is_long(run)).cloned().collect()
    }

    /// The mean of |θ̇ − v| over some rows, from differences over a twentieth of a second.
    fn speed(&self, v: f64, run: &Range<usize>) -> f64 {
        let step = (self.t[self.t.len() - 1] - self.t[0]) / self.t.len() as f64;
        let every = ((PACE / step).ceil() as usize).clamp(1, run.len().saturating_sub(1).max(1));
        let (mut path, mut time) = (0.0, 0.0);
        for k in (run.start + every..run.end).step_by(every) {
            let (change, duration) = (self.x[k] - self.x[k - every], self.t[k] - self.t[k - every]);
            if change.is_finite() {
                (path, time) = (path + (change - v * duration).abs(), time + duration);
            }
        }
        if time > 0.0 { path / time } else { 0.0 }
    }

    /// Whether the position departs clearly from one that moves at v during a run.
    fn leaves(&self, v: f64, run: &Range<usize>) -> bool {
        let path = |k: usize| self.x[k] - v * (self.t[k] - self.t[run.start]);
        let (low, high) = run.clone().map(path).fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
        let (share, steps, far) = MOVES;
        let usual = self.speed(0.0, &(0..self.x.len()));
        high - low > far.max(steps * self.resolution()) && self.speed(v, run) > share * usual
    }

    /// Whether the velocities of a run lead clearly away from its constant position.
    fn passes(&self, v: &[f64], run: &Range<usize>) -> bool {
        let mean = |range: &Range<usize>| v[range.clone()].iter().map(|x| x.abs()).sum::<f64>() / range.len() as f64;
        let (mut at, mut most) = (0.0, 0.0_f64);
        for k in run.start + 1..run.end {
            at += 0.5 * (v[k] + v[k - 1]) * (self.t[k] - self.t[k - 1]);
            most = most.max(f64::abs(at));
        }
        let (share, steps, far) = MOVES;
        most > far.max(steps * self.resolution()) && mean(run) > share * mean(&(0..v.len()))
    }

    /// Whether the joint stops at the beginning of a run, or starts at its end, faster than it ever does elsewhere.
    fn stops(&self, run: &Range<usize>) -> bool {
        let N = self.x.len();
        let bend = |k: usize, m: usize| (self.x[k + m] - 2.0 * self.x[k] + self.x[k - m]).abs();
        [1, 2, 4, 8].into_iter().any(|m| {
            let is_apart = |k: usize| k + m < run.start || k > run.end + m;
            let moves = |k: &usize| is_apart(*k) && self.x[*k + m] != self.x[*k - m];
            let others: Vec<f64> = (m..N - m).filter(moves).map(|k| bend(k, m)).collect();
            let usual = ABRUPT * quantile(others, 0.999);
            let ends = [run.start, run.end - 1].into_iter().filter(|&k| k >= m && k + m < N);
            usual > 0.0 && ends.map(|k| bend(k, m)).any(|bend| bend > usual && bend > 3.0 * self.resolution())
        })
    }

    /// The smallest step of the position.
    fn resolution(&self) -> f64 {
        let steps = self.x.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0);
        quantile(steps.collect(), 0.0)
    }
}
