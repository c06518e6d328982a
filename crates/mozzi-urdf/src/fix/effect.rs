//! The effect of repairs on the mass matrix.

use super::Proposal;
use crate::{Settings, parse_with};
use mozzi::spatial::Rounded;
use mozzi::{Model, SpatialInertia};
use nalgebra::DMatrix;

const NONE: &str = "M does not change";

/// Writes the effect of each proposal, of which the text is the result of all.
pub(super) fn tell(file_name: &str, text: &str, settings: &Settings, proposals: &mut [Proposal]) {
    let model = parse_with(file_name, text, settings.clone()).ok().and_then(|loaded| loaded.description.build().ok());
    for proposal in proposals {
        proposal.effect = match (&proposal.inertia, &model) {
            (None, _) => NONE.to_string(),
            (Some(_), None) => "M is not known: the robot is still refused".to_string(),
            (Some((link, old, new)), Some(model)) => {
                of(model, link, *old, *new).unwrap_or_else(|| format!("{NONE}: no joint moves the link"))
            }
        };
    }
}

/// The diagonal entry of M that changes the most, at the robot's start: ΔM = Jᵀ ΔG J.
fn of(model: &Model, link: &str, old: SpatialInertia, new: SpatialInertia) -> Option<String> {
    let theta = model.start().theta;
    let J = model.body_jacobian(&theta, model.frame(link).ok()?).ok()?;
    let (a, b) = (old.to_matrix(), new.to_matrix());
    let change = DMatrix::from_fn(6, 6, |i, j| b[i][j] - a[i][j]);
    let change = J.matrix().transpose() * change * J.matrix();
    let M = model.mass_matrix(&theta).ok()?;
    let part = |i: usize| {
        let (after, before) = (M[(i, i)], M[(i, i)] - change[(i, i)]);
        change[(i, i)].abs() / after.abs().max(before.abs())
    };
    let best = (0..model.n()).filter(|&i| part(i) > 0.0).max_by(|&i, &j| part(i).total_cmp(&part(j)))?;
    let (after, before) = (M[(best, best)], M[(best, best)] - change[(best, best)]);
    let k = best + 1;
    Some(format!("M: entry ({k}, {k}) {} → {} at the robot's start", Rounded(before), Rounded(after)))
}
