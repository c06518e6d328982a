//! Positions that wrap at a half or a whole turn, and positions that jump.

use super::{at, axes, is_revolute, quantile};
use crate::cores::each;
use crate::{Finding, Log};
use mozzi::Model;
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

/// A step larger than this many usual ones, and than this angle or length, is a jump.
const JUMP: (f64, f64) = (15.0, 0.05);

/// Adds whole turns, so that revolute joints turn continuously; other jumps are faults.
pub fn unwrap(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (n, nq) = (model.n(), model.nq());
    let axes = axes(model);
    let found = each(axes.len(), log.theta.len(), |k| {
        let (q, _, name) = &axes[k];
        Turns::of(log, *q, nq, is_revolute(model, name))
    });
    for (Turns { rows, offsets, wraps, first, jump, usual }, (q, j, name)) in found.into_iter().zip(axes) {
        if let Some((row, step)) = jump {
            let what = format!("{}: the position of {name} jumps by {step:.4} at {}", log.name, at(log, row));
            findings.push(match (step.abs() - 360.0).abs() < (FAST * usual).min(180.0) {
                true => Finding::fault(
                    "unit",
                    format!("{what}, a turn in degrees, expected rad; name the columns q1_deg, qd1_deg/s"),
                ),
                false => Finding::fault(
                    "position_jump",
                    format!(
                        "{what}, other steps are below {usual:.1e}: an encoder's error, or logs put together; cut the log \
                         there"
                    ),
                ),
            });
        }
        let Some(first) = first else { continue };
        findings.push(Finding::note(
            "wrapped",
            format!(
                "{}: the position of {name} wraps {wraps} times by a whole turn, first at {}; it is unwrapped",
                log.name,
                at(log, first)
            ),
        ));
        let log = log.to_mut();
        rows.iter().zip(&offsets).for_each(|(&row, offset)| log.theta[row * nq + q] += offset);
        // the target of the same turn
        if let Some(target) = &mut log.target {
            for &row in &rows {
                let target = &mut target[row * n + j];
                *target += TAU * ((log.theta[row * nq + q] - *target) / TAU).round();
            }
        }
    }
}

/// The steps of one position.
struct Turns {
    /// Rows with a number, and what unwraps the position there.
    rows: Vec<usize>,
    offsets: Vec<f64>,
    wraps: usize,
    /// The row after the first wrap.
    first: Option<usize>,
    /// The row after the first jump, and its step.
    jump: Option<(usize, f64)>,
    /// 95 % of the steps are smaller.
    usual: f64,
}

impl Turns {
    fn of(log: &Log, q: usize, nq: usize, may_turn: bool) -> Self {
        let rows: Vec<usize> = (0..log.rows()).filter(|&row| log.theta[row * nq + q].is_finite()).collect();
        let steps: Vec<f64> =
            rows.windows(2).map(|pair| log.theta[pair[1] * nq + q] - log.theta[pair[0] * nq + q]).collect();
        let usual = quantile(steps.iter().map(|step| step.abs()).collect(), 0.95);
        let time = quantile(rows.windows(2).map(|pair| log.t[pair[1]] - log.t[pair[0]]).collect(), 0.5);
        let mut found = Turns { offsets: vec![0.0; rows.len()], rows, wraps: 0, first: None, jump: None, usual };
        let mut offset = 0.0;
        for (k, step) in steps.iter().enumerate() {
            let (row, next) = (found.rows[k], found.rows[k + 1]);
            let back = step - TAU * (step / TAU).round();
            let is_next = log.t[next] - log.t[row] < 5.0 * time.max(f64::MIN_POSITIVE);
            let is_one_turn = step.abs() > PI && step.abs() < 3.0 * PI && step.abs() > RARE * usual;
            if may_turn && is_one_turn && back.abs() <= (FAST * usual).max(0.05) {
                offset += back - step;
                found.wraps += 1;
                found.first.get_or_insert(next);
            } else if is_next && step.abs() > (JUMP.0 * usual).max(JUMP.1) && found.jump.is_none() {
                found.jump = Some((next, *step));
            }
            found.offsets[k + 1] = offset;
        }
        found
    }
}

/// A step back after a wrap is at most this many usual ones.
const FAST: f64 = 10.0;

/// A wrap is larger than this many usual steps: those of degrees may be whole turns.
const RARE: f64 = 2.0;
