//! The effect of repairs on the mass matrix.

use super::Proposal;
use crate::{Settings, parse_with};
use mozzi::model::integrate;
use mozzi::spatial::Rounded;
use mozzi::{Error, Model, SpatialInertia};
use nalgebra::DMatrix;

const NONE: &str = "M does not change";
/// The second state has every joint so far from the robot's start, rad or m.
const TURNED: f64 = 0.5;
/// Smaller changes, as parts of √(M_ii M_jj), are rounding.
const ROUNDING: f64 = 1e-12;

/// Writes the effect of each proposal, of which the text is the result of all.
pub(super) fn tell(file_name: &str, text: &str, settings: &Settings, proposals: &mut [Proposal]) {
    let model = parse_with(file_name, text, settings.clone()).ok().and_then(|loaded| loaded.description.build().ok());
    for proposal in proposals {
        proposal.effect = match (&proposal.inertia, &model) {
            (None, _) => NONE.to_string(),
            (Some(_), None) => "M is not known: the robot is still refused".to_string(),
            (Some((link, old, new)), Some(model)) => {
                of(model, link, *old, *new).unwrap_or_else(|_| format!("{NONE}: no joint moves the link"))
            }
        };
    }
}

/// An entry of M before and after a repair.
struct Entry {
    /// Its change as a part of √(M_ii M_jj).
    part: f64,
    at: (usize, usize),
    before: f64,
    after: f64,
}

/// The entry of M that changes the most: at the robot's start, unless all change much more at another state.
fn of(model: &Model, link: &str, old: SpatialInertia, new: SpatialInertia) -> Result<String, Error> {
    let start = model.start().theta;
    let mut turned = start.clone();
    integrate(model, &mut turned, &vec![1.0; model.n()], TURNED);
    let [(first, moves), (second, moves_there)] =
        [largest(model, &start, link, old, new)?, largest(model, &turned, link, old, new)?];
    let is_second = second.part > 10.0 * first.part.max(ROUNDING);
    let place = if is_second {
        format!("with every joint {TURNED} from the robot's start")
    } else {
        "at the robot's start".to_string()
    };
    let Entry { part, at: (i, j), before, after } = if is_second { second } else { first };
    Ok(match (moves || moves_there, part > ROUNDING) {
        (false, _) => format!("{NONE}: no joint moves the link"),
        (true, false) => format!("{NONE}: it depends on none of these numbers"),
        (true, true) => format!("M: entry ({}, {}) {} → {} {place}", i + 1, j + 1, Rounded(before), Rounded(after)),
    })
}

/// The entry that changes the most at a state, ΔM = Jᵀ ΔG J, and whether J is not 0.
fn largest(
    model: &Model,
    theta: &[f64],
    link: &str,
    old: SpatialInertia,
    new: SpatialInertia,
) -> Result<(Entry, bool), Error> {
    let J = model.body_jacobian(theta, model.frame(link)?)?.matrix();
    let (a, b) = (old.to_matrix(), new.to_matrix());
    let change = J.transpose() * DMatrix::from_fn(6, 6, |i, j| b[i][j] - a[i][j]) * &J;
    let M = model.mass_matrix(theta)?;
    let size = |i: usize| M[(i, i)].abs().max((M[(i, i)] - change[(i, i)]).abs());
    let mut largest = Entry { part: 0.0, at: (0, 0), before: 0.0, after: 0.0 };
    for (i, j) in (0..model.n()).flat_map(|i| (i..model.n()).map(move |j| (i, j))) {
        let part = change[(i, j)].abs() / (size(i) * size(j)).sqrt();
        if part > largest.part {
            largest = Entry { part, at: (i, j), before: M[(i, j)] - change[(i, j)], after: M[(i, j)] };
        }
    }
    Ok((largest, J.iter().any(|x| *x != 0.0)))
}
