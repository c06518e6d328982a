//! Positions that wrap at a half or a whole turn, and positions that jump.

use super::{at, axes, quantile};
use crate::{Finding, Log};
use mozzi::Model;
use mozzi::model::description::JointKind;
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

/// A step larger than this many usual ones, and than this angle or length, is a jump.
const JUMP: (f64, f64) = (15.0, 0.05);

/// Adds whole turns, so that revolute joints turn continuously; other jumps are faults.
pub fn unwrap(model: &Model, log: &mut Cow<'_, Log>, findings: &mut Vec<Finding>) {
    let (N, nq) = (log.rows(), model.nq());
    let joints: Vec<_> = model.joints().collect();
    for (q, _, name) in axes(model) {
        let turns = joints.iter().find(|joint| joint.name == name).is_some_and(
            |joint| matches!(&joint.kind, JointKind::Screw(axis) if !axis.is_prismatic() && axis.pitch() == 0.0),
        );
        let rows: Vec<usize> = (0..N).filter(|&row| log.theta[row * nq + q].is_finite()).collect();
        let steps: Vec<f64> =
            rows.windows(2).map(|pair| log.theta[pair[1] * nq + q] - log.theta[pair[0] * nq + q]).collect();
        let usual = quantile(steps.iter().map(|step| step.abs()).collect(), 0.95);
        let time = quantile(rows.windows(2).map(|pair| log.t[pair[1]] - log.t[pair[0]]).collect(), 0.5);
        let (mut offset, mut wraps, mut first, mut jump) = (0.0, 0, None, None);
        let mut offsets = vec![0.0; rows.len()];
        for (k, step) in steps.iter().enumerate() {
            let back = step - TAU * (step / TAU).round();
            let is_next = log.t[rows[k + 1]] - log.t[rows[k]] < 5.0 * time.max(f64::MIN_POSITIVE);
            if turns && step.abs() > PI && back.abs() <= (FAST * usual).max(0.05) {
                offset += back - step;
                wraps += 1;
                first.get_or_insert(rows[k + 1]);
            } else if is_next && step.abs() > (JUMP.0 * usual).max(JUMP.1) && jump.is_none() {
                jump = Some((rows[k + 1], *step));
            }
            offsets[k + 1] = offset;
        }
        if let Some((row, step)) = jump {
            findings.push(Finding::fault(
                "position_jump",
                format!(
                    "{}: the position of {name} jumps by {step:.4} at {}, other steps are below {usual:.1e}: an encoder's \
                     error, or logs put together; cut the log there",
                    log.name,
                    at(log, row)
                ),
            ));
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
                let turns = (log.theta[row * nq + q] - target[row * nq + q]) / core::f64::consts::TAU;
                target[row * nq + q] += core::f64::consts::TAU * turns.round();
            }
        }
    }
}

/// A step back after a wrap is at most this many usual ones.
const FAST: f64 = 10.0;
