//! Parts of a robot that a format cannot express, in words.

use crate::failure::{self, Failure, Result};
use mozzi::Description;
use mozzi::model::description::Joint;
use mozzi_urdf::{Policy, Settings};

pub fn not_written(output: &str, why: &dyn std::fmt::Display) -> Failure {
    Failure::wrong(format!("{output} is not written: {why}; .json can express all of it"))
}

/// A note about each loss; with `--strict` an error.
pub fn report(output: &str, losses: &[String], settings: &Settings) -> Result<()> {
    if settings.policy == Policy::Strict && !losses.is_empty() {
        return Err(not_written(output, &format!("--strict, and it cannot express {}", losses.join("; "))));
    }
    losses.iter().for_each(|loss| failure::note(&format!("{output} cannot express {loss}")));
    Ok(())
}

/// The names of some joints, the first of them if there are many.
pub fn names(robot: &Description, is_one: impl Fn(&Joint) -> bool) -> Option<String> {
    const SHOWN: usize = 4;
    let all: Vec<String> = robot.joints.iter().filter(|j| is_one(j)).map(|j| format!("`{}`", j.name)).collect();
    let shown = all.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
    match all.len() {
        0 => None,
        count if count > SHOWN => Some(format!("{count} joints ({shown}, …)")),
        _ => Some(shown),
    }
}

/// "actuator" of one, "2 actuators": after "the".
pub fn of_these(count: usize, what: &str) -> String {
    if count == 1 { what.to_string() } else { mozzi_urdf::counted(count, what) }
}
