//! Where torques are measured, as the estimated armature shows.

use crate::compress::Compressed;
use crate::identify::cross_validated;
use crate::setup::{Limits, Setup};
use crate::{Choice, Error, Finding, Identification, Kind};

/// An armature is clear above this many standard deviations, and if most of its certainty comes from the data.
const CLEAR: f64 = 3.0;

/// A warning if the armature of every joint is at its bound 0, although forces were taken to be the motors', and if
/// the forces are predicted as well without it, by bodies that exist. A rotor behind a gear is felt at the motor as a
/// large inertia of its own.
///
/// # Errors
/// Those of the fits with and without armature.
pub fn behind_the_gears(found: &Identification<'_>) -> Result<Option<Finding>, Error> {
    let columns = &found.setup.columns;
    let Some(errors) = found.left_out.as_ref().filter(|_| columns.choice.armature && !columns.choice.gains) else {
        return Ok(None);
    };
    let armatures = armatures(found);
    let optimum = &found.estimates.consistent;
    let is_clear = |k: usize| {
        let is_armature = matches!(columns.unknowns[k].kind, Kind::Armature(_));
        is_armature && optimum.prior_share[k] < 0.5 && optimum.x[k] > CLEAR * optimum.deviations[k]
    };
    if armatures.is_empty() || (0..columns.count()).any(is_clear) {
        return Ok(None);
    }
    // of bodies and rotors that exist: an apparent inertia would take the place of the armature
    let possible = Choice { apparent: false, ..columns.choice.clone() };
    let predicted = |choice: Choice| -> Result<f64, Error> {
        let setup = Setup::new(columns.model, choice, found.setup.problem.gamma, &Limits::default())?;
        let compress = |samples| Compressed::new(&setup.columns, &setup.pattern, samples, None);
        let logs: Vec<Compressed> = found.samples.iter().map(compress).collect::<Result<_, _>>()?;
        let (errors, _) = cross_validated(&setup, &logs, found.tenths(), 5, &|| false)?;
        Ok(100.0 * errors.normalized(&errors.consistent))
    };
    let (with, without) = (predicted(possible.clone())?, predicted(Choice { armature: false, ..possible })?);
    if without > 1.01 * with {
        return Ok(None);
    }
    let free = 100.0 * errors.normalized(&errors.consistent);
    let least = armatures.iter().map(|(name, value, deviation)| format!("{name} {value:.3} ± {deviation:.3}"));
    Ok(Some(Finding::warning(
        "behind_the_gears",
        format!(
            "every joint's armature is at its bound 0 (least squares, kg m²: {}), and rotors do not help: left-out forces \
             are predicted to {without:.2} % without armature, {with:.2} % with it ({free:.2} % with apparent inertia and \
             damping, which may be negative). The forces seem to be measured behind the gears, where rotors are not felt, \
             or the rotors are light; `--torque link` gives the robot no armature. Otherwise friction that lags at \
             reversals hides it",
            least.collect::<Vec<_>>().join(", ")
        ),
    )))
}

/// The armatures that some motion can determine by themselves: joint, value by least squares, standard deviation.
fn armatures<'f>(found: &'f Identification<'_>) -> Vec<(&'f str, f64, f64)> {
    let (unknowns, least) = (&found.setup.columns.unknowns, &found.estimates.least_squares);
    let of_base = found.setup.base.columns.iter().zip(least.values.iter().zip(&least.deviations));
    let armatures = of_base.filter(|(k, _)| matches!(unknowns[**k].kind, Kind::Armature(_)));
    armatures
        .filter(|(_, (_, deviation))| deviation.is_finite())
        .map(|(&k, (&value, &deviation))| {
            let name = &unknowns[k].name;
            (name.strip_suffix(".armature").unwrap_or(name), value, deviation)
        })
        .collect()
}
