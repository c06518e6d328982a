//! Lists of numbers for the one-line `repr` of paths, references and controllers.

use mozzi_report::text::{scalar, tuple};

/// Most numbers of a list that are shown.
const MOST: usize = 8;

/// `(0.5, 1)`; a longer list is cut off.
pub fn positions(theta: &[f64]) -> String {
    match theta.get(..MOST) {
        Some(first) if theta.len() > MOST => format!("{}, …)", tuple(first).trim_end_matches(')')),
        _ => tuple(theta),
    }
}

/// One number if all are equal, as `400`, or all of them.
pub fn gains(list: &[f64]) -> String {
    match list {
        [first, rest @ ..] if rest.iter().all(|x| x == first) => scalar(*first),
        _ => positions(list),
    }
}
