//! Mistakes in the columns of one or two joints that the robot's file does not reveal, since it is far from the robot:
//! the log is fitted again with each of them undone.

use super::mistake::Mistake;
use crate::compress::Evidence;
use crate::cores::each;
use crate::estimate::least_squares::weighted_by;
use crate::mend::is_revolute;
use crate::setup::Setup;
use crate::signals::Samples;
use crate::{Errors, Finding, Identification};

/// Fits with a smaller error over force are not questioned.
const GOOD: f64 = 0.02;

/// A mistake is reported if the logarithms of the joints' errors fall by this much in all without it,
const CLEAR: f64 = 2.0;

/// and those of one joint to less than this part.
const HALF: f64 = 0.5;

/// Samples that are fitted.
const FITTED: usize = 200;

/// With more joints pairs are not tried: there are too many.
const MOST_JOINTS: usize = 12;

/// Units of forces that are tried for each joint, in N m.
const UNITS: [f64; 6] = [1e-3, 1e-2, 0.1, 10.0, 100.0, 1000.0];

/// The first step of the search for an offset, rad, and the number of steps.
const OFFSET: (f64, usize) = (0.15, 5);

/// A warning about the mistake without which a log is explained far better.
pub fn check(found: &Identification<'_>, log: &str, samples: &Samples) -> Option<Finding> {
    let setup = &found.setup;
    let model = setup.columns.model;
    let n = model.n();
    let is_bad = |errors: &Errors| errors.normalized(&errors.consistent) > GOOD;
    if !model.configuration_space().is_flat()
        || !setup.columns.choice.links
        || !found.left_out.as_ref().is_some_and(is_bad)
    {
        return None;
    }
    let few = thinned(samples, n);
    let sigma = &found.estimates.least_squares.sigma;
    let fit = |mistake: &Mistake| errors(setup, &undone(&few, mistake, n), sigma);
    let as_it_is = fit(&Mistake::None)?;
    // Σ_j log of the part of joint j's errors that is left; 0 if no joint's is clearly smaller
    let left = |errors: Vec<f64>| {
        let ratios = errors.iter().zip(&as_it_is).map(|(a, b)| (a / b).max(1e-6));
        if ratios.clone().any(|ratio| ratio < HALF) { ratios.map(f64::ln).sum() } else { 0.0 }
    };
    let mut all: Vec<Mistake> =
        (0..n).flat_map(|a| [Mistake::ForceSign(a), Mistake::MotionSign(a), Mistake::JointSign(a)]).collect();
    all.extend((0..n).flat_map(|a| UNITS.map(|unit| Mistake::ForceScale(a, unit))));
    all.extend(Mistake::of_wrenches(&few));
    if n <= MOST_JOINTS {
        all.extend(Mistake::swaps(n));
    }
    let cost = few.count() * n * setup.columns.count();
    let sums = each(all.len(), all.len() * cost, |k| fit(&all[k]).map_or(0.0, left));
    let names: Vec<&str> = model.velocity_names().collect();
    let revolute: Vec<usize> = (0..n).filter(|&j| is_revolute(model, names[j])).collect();
    let offsets = each(revolute.len(), revolute.len() * cost, |k| {
        let mistake = offset(revolute[k], &as_it_is, &fit);
        let least = fit(&mistake).map_or(0.0, left);
        (mistake, least)
    });
    let tried = all.into_iter().zip(sums).chain(offsets);
    let (best, least) = tried.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, least)| *least < -CLEAR)?;
    let text = format!(
        "{log}: {}; a fit without this mistake leaves {:.0} % of the errors (geometric mean)",
        best.text(model),
        100.0 * (least / n as f64).exp()
    );
    Some(Finding::warning(best.code(), text))
}

/// Evenly spaced samples.
fn thinned(samples: &Samples, n: usize) -> Samples {
    let step = samples.count().div_ceil(FITTED).max(1);
    let table = |x: &[f64], width: usize| -> Vec<f64> { x.chunks(width).step_by(step).flatten().copied().collect() };
    let some = |x: &Option<Vec<f64>>| x.as_ref().map(|x| table(x, x.len() / samples.count().max(1)));
    Samples {
        t: table(&samples.t, 1),
        theta: table(&samples.theta, n),
        dtheta: table(&samples.dtheta, n),
        ddtheta: table(&samples.ddtheta, n),
        tau: table(&samples.tau, n),
        coulomb: some(&samples.coulomb),
        stribeck: some(&samples.stribeck),
        target: None,
        is_valid: samples.is_valid.chunks(n).step_by(step).flatten().copied().collect(),
        wrenches: samples.wrenches.iter().map(|(frame, x)| (*frame, table(x, 6))).collect(),
        removed: samples.removed.clone(),
        ..*samples
    }
}

/// The samples without a mistake.
fn undone(samples: &Samples, mistake: &Mistake, n: usize) -> Samples {
    let mut samples = samples.clone();
    if *mistake == Mistake::Wrench {
        samples.wrenches.clear();
    }
    if !matches!(mistake, Mistake::None | Mistake::ForceSign(_) | Mistake::ForceScale(..) | Mistake::SwappedForces(..))
        && samples.coulomb.as_ref().is_some_and(|table| table.len() > samples.dtheta.len())
    {
        (samples.coulomb, samples.stribeck) = (None, None); // a rotor's rate is another one then
    }
    if *mistake == Mistake::WrenchSign {
        samples.wrenches.iter_mut().flat_map(|(_, table)| table).for_each(|x| *x = -*x);
    }
    for k in 0..samples.count() {
        let row = k * n..(k + 1) * n;
        let mut motion = [&samples.theta, &samples.dtheta, &samples.ddtheta].map(|x| x[row.clone()].to_vec());
        mistake.undo(&mut motion, &mut samples.tau[row.clone()], &[]);
        let [theta, dtheta, ddtheta] = motion;
        samples.theta[row.clone()].copy_from_slice(&theta);
        samples.dtheta[row.clone()].copy_from_slice(&dtheta);
        samples.ddtheta[row.clone()].copy_from_slice(&ddtheta);
        for friction in [&mut samples.coulomb, &mut samples.stribeck].into_iter().flatten() {
            mistake.undo_rates(&mut friction[row.clone()]);
        }
    }
    samples
}

/// The errors of a fit by least squares with the weights of the whole log's, each relative to its force.
fn errors(setup: &Setup<'_>, samples: &Samples, sigma: &[f64]) -> Option<Vec<f64>> {
    let evidence = Evidence::of_samples(&setup.columns, &setup.pattern, samples).ok()?;
    let x = weighted_by(&evidence, &setup.base, sigma);
    Some(evidence.rmse(&x).into_iter().zip(evidence.rms()).map(|(e, force)| e / force.max(1e-12)).collect())
}

/// The offset of a joint's position that leaves the smallest errors, by parabolas from 0, a quarter and half a turn.
fn offset(j: usize, usual: &[f64], fit: &dyn Fn(&Mistake) -> Option<Vec<f64>>) -> Mistake {
    let square = |delta: f64| -> f64 {
        let of = |errors: Vec<f64>| errors.iter().zip(usual).map(|(e, s)| (e / s).powi(2)).sum();
        fit(&Mistake::Offset(j, delta)).map_or(f64::MAX, of)
    };
    let quarter = core::f64::consts::FRAC_PI_2;
    let starts = [0.0, quarter, -quarter, 2.0 * quarter].map(|delta| (delta, square(delta)));
    let (mut at, mut least) = starts.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, f64::MAX));
    let (mut step, rounds) = OFFSET;
    for _ in 0..rounds {
        let [low, high] = [at - step, at + step].map(square);
        let bend = low - 2.0 * least + high;
        let change = if bend > 0.0 { (0.5 * step * (low - high) / bend).clamp(-2.0 * step, 2.0 * step) } else { 0.0 };
        let next = square(at + change);
        if next < least {
            (at, least) = (at + change, next);
        }
        if change.abs() < step {
            step /= 4.0;
        }
    }
    Mistake::Offset(j, at)
}
