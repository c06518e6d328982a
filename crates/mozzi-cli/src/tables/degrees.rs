//! Questions positions of a table, in radians, that are more than two turns: they may be meant in degrees.

use super::samples::{Row, Samples};
use crate::angles::{are_degrees, has_unit, of_positions};
use crate::failure::note;
use crate::recogniser::POSITION;
use mozzi::Model;

/// Prints a note, once for a table, unless the column's name states the unit or `--deg` is given. Positions within a
/// joint's limits are fine. A joint without limits may turn often: its column must also hold whole numbers only.
pub fn question(samples: &Samples, model: &Model) {
    let Some(theta) = samples.tables.get("theta").filter(|_| !are_degrees()) else { return };
    let (nq, are_angles) = (model.nq().max(1), of_positions(model));
    let names: Vec<&str> = model.position_names().collect();
    for (joint, place) in model.joints().zip(model.places()) {
        let k = place.positions().start;
        let column = samples.columns.iter().find(|row| row.meaning == POSITION && row.joint == names[k]);
        let is_converted = column.is_some_and(|row| has_unit(&row.column) || row.unit.starts_with('×'));
        let numbers = || theta.iter().skip(k).step_by(nq);
        let is_suspect = joint.limits.position.is_some() || numbers().all(|x| x.fract() == 0.0);
        if !are_angles[k] || is_converted || !is_suspect {
            continue;
        }
        let is_within = |x: f64| joint.limits.position.is_some_and(|[low, high]| (low..=high).contains(&x));
        let Some(x) = numbers().find(|x| x.abs() > 4.0 * std::f64::consts::PI && !is_within(**x)) else { continue };
        let turns = x / std::f64::consts::TAU;
        let (what, remedy) = match column {
            Some(Row { column, .. }) => (format!("column `{column}`"), format!("`{column}_deg` is a name for degrees")),
            None => (format!("θ of `{}`", names[k]), "only named columns can be in degrees".to_string()),
        };
        let file = &samples.file;
        return note(&format!("{file}: {what} is read in radians, and {x} rad are {turns:.1} turns; {remedy}"));
    }
}
