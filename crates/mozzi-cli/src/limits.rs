//! Limits of a motion by flags.

use crate::failure::{Result, note};
use crate::numbers::one_or_each;
use crate::text::scalar;
use mozzi::Model;

/// The limits of a flag, one for all or one for each velocity, "inf" for none; the robot's own without it. A limit
/// above the robot's own is questioned.
pub fn of_flag(model: &Model, flag: &str, text: Option<&str>, own: Vec<f64>, are_angles: &[bool]) -> Result<Vec<f64>> {
    let found = match text {
        None => return Ok(own),
        Some(text) if text.trim() == "inf" => vec![f64::INFINITY; own.len()],
        Some(text) => one_or_each(flag, text, are_angles)?,
    };
    let above = model.velocity_names().zip(found.iter().zip(&own)).find(|(_, (x, own))| *x > *own);
    if let Some((name, (x, own))) = above {
        note(&format!("{flag} is {} for `{name}`, above the limit {} of the robot's file", scalar(*x), scalar(*own)));
    }
    Ok(found)
}
