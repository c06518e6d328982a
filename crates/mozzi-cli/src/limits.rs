//! Limits of a motion by flags.

use crate::angles;
use crate::failure::{Result, note};
use crate::numbers::one_or_each;
use crate::state::by_name;
use crate::text::scalar;
use mozzi::Model;

/// The limits of a flag: one for all, one for each velocity, or `NAME=LIMIT,…` for some of them; "inf" for none. A
/// limit above that of the robot's `file` is questioned.
pub fn of_flag(
    model: &Model,
    flag: &str,
    text: Option<&str>,
    [default, file]: [&[f64]; 2],
    are_angles: &[bool],
) -> Result<Vec<f64>> {
    let read = |text: &str, are_angles: &[bool]| match text.trim() {
        "inf" => Ok(vec![f64::INFINITY; are_angles.len()]),
        text => one_or_each(flag, text, are_angles),
    };
    let found = match text {
        None => return Ok(default.to_vec()),
        Some(text) if text.contains('=') => {
            let (mut found, names) = (default.to_vec(), model.velocity_names().collect::<Vec<_>>());
            for (k, limit) in by_name(flag, text, &names)? {
                found[k] = read(limit, &are_angles[k..=k])?[0];
            }
            found
        }
        Some(text) => read(text, are_angles)?,
    };
    let above = model.velocity_names().enumerate().find(|(k, _)| found[*k] > file[*k]);
    if let Some((k, name)) = above {
        let [x, of_file] = [found[k], file[k]].map(|x| scalar(angles::shown(&[x], &are_angles[k..=k])[0]));
        note(&format!("{flag} is {x} for `{name}`, above the limit {of_file} of the robot's file"));
    }
    Ok(found)
}
