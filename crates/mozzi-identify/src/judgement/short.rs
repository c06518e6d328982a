//! Logs that are too short for any motion.

use crate::signals::Samples;
use crate::{Finding, Log};

/// Logs that last less than this in all, s, determine nothing.
const SHORT: f64 = 0.5;

/// A fault if the logs are too short for any motion.
pub fn check(logs: &[Log], samples: &[Samples]) -> Option<Finding> {
    // the filter leaves out two periods of its cut-off at both ends
    let duration = |of: &Samples| (of.count() as f64 - 1.0) / of.rate + of.cutoff.map_or(0.0, |cutoff| 4.0 / cutoff);
    let total: f64 = samples.iter().map(duration).sum();
    (total < SHORT).then(|| {
        let name = logs.first().map_or("", |log| log.name.as_str());
        let what = format!("{name}: {total:.2} s of motion do not determine a robot; log ten seconds or more");
        Finding::fault("short", what)
    })
}
