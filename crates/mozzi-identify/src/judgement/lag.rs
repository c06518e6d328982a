//! Forces that come later or earlier than predicted: all of them, or those of one joint.

use super::residuals::Residual;
use crate::Finding;

/// One joint's lag is clear above this many standard deviations, and above this many steps of time.
const CLEAR: (f64, f64) = (3.0, 1.0);

/// It is the joint's own if it is this many times as far from the others' median as any other is for sure.
const OWN: f64 = 8.0;

/// A common lag, or that of one joint.
pub fn check(log: &str, residuals: &[Residual], step: f64) -> Option<Finding> {
    of_all(log, residuals, step).or_else(|| of_one(log, residuals, step))
}

/// A common lag of all forces, where it is clear: torques that were filtered forwards only.
fn of_all(log: &str, residuals: &[Residual], step: f64) -> Option<Finding> {
    let weight = |r: &Residual| 1.0 / (r.lag_deviation * r.lag_deviation);
    let total: f64 = residuals.iter().map(weight).sum();
    let mean = residuals.iter().map(|r| weight(r) * r.lag).sum::<f64>() / total;
    let alike = residuals.iter().filter(|r| r.lag * mean > 0.0).count();
    let is_clear =
        mean.abs() > (0.5 * step).max(3e-3) && mean.abs() > 5.0 / total.sqrt() && 4 * alike >= 3 * residuals.len();
    is_clear.then(|| {
        let when = if mean > 0.0 { "later" } else { "earlier" };
        Finding::warning(
            "causal_filter",
            format!(
                "{log}: forces come {:.1} ms {when} than predicted: a causal filter or a clock, or \
                 friction with memory; \
                 log them unfiltered",
                1e3 * mean.abs()
            ),
        )
    })
}

/// The lag of one joint that differs from those of all others.
fn of_one(log: &str, residuals: &[Residual], step: f64) -> Option<Finding> {
    let is_own = |&j: &usize| {
        let mut others: Vec<f64> = (0..residuals.len()).filter(|&i| i != j).map(|i| residuals[i].lag).collect();
        others.sort_unstable_by(f64::total_cmp);
        let Some(&median) = others.get(others.len() / 2).filter(|_| others.len() > 1) else { return false };
        let apart = |i: usize| (residuals[i].lag - median).abs();
        let sure = |i: usize| (apart(i) - residuals[i].lag_deviation).max(0.0);
        let most = (0..residuals.len()).filter(|&i| i != j).map(sure).fold(0.0, f64::max);
        let (lag, deviation) = (residuals[j].lag.abs(), residuals[j].lag_deviation);
        lag > CLEAR.0 * deviation && lag > CLEAR.1 * step && apart(j) > OWN * most
    };
    let found = &residuals[(0..residuals.len()).find(is_own)?];
    Some(Finding::warning(
        "lag",
        format!(
            "{log}: the force of {} comes at least {:.1} ms {} than predicted, those of the other joints do not: its \
             column is delayed, by a filter or a slower bus, or it has friction with memory; log it with its own time",
            found.name,
            1e3 * found.lag.abs(),
            if found.lag > 0.0 { "later" } else { "earlier" }
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residual(name: &str, lag: f64) -> Residual {
        Residual {
            name: name.into(),
            force: 1.0,
            rmse: 0.01,
            peak: (1.0, 0.1),
            autocorrelation: 0.3,
            lag,
            lag_deviation: 5e-4,
        }
    }

    #[test]
    fn one_joint_that_lags_is_named() {
        let all = [residual("a", 1e-4), residual("b", 0.011), residual("c", -2e-4), residual("d", 0.0)];
        let found = check("log", &all, 2e-3).expect("a lag");
        assert!(found.code == "lag" && found.text.contains("the force of b"), "{found}");
        // two that differ are effects of the joints, such as friction with memory
        let all = [residual("a", 1e-4), residual("b", 0.011), residual("c", -8e-3), residual("d", 0.0)];
        assert_eq!(check("log", &all, 2e-3), None);
        assert_eq!(check("log", &all[..1], 2e-3), None);
    }
}
