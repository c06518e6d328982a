//! Mistakes in a log that the robot's own values reveal: joints mixed up, signs, units, the direction of gravity.

use super::gains::{self, Fit, Gain};
use super::mistake::Mistake;
use crate::payload::robot_of;
use crate::signals::{Cutoff, Filter, Samples, prepare};
use crate::{Error, Finding, Level, Log};
use mozzi::quantities::{InverseDynamics, Query};
use mozzi::{Environment, Model, SO3, Vec3, fast};

/// The logarithms of the joints' squared errors must fall by this much in all before a mistake is reported.
const CLEAR: f64 = 1.5;

/// By this much before it is a fault.
const SURE: f64 = 2.0;

/// A mistake explains the forces if it, and masses of the file that are wrong by a third, leave at most this share of
/// their variance unexplained (geometric mean),
const EXPLAINED: f64 = 0.05;

/// and if the logarithms of mistakes of other kinds are larger by this much.
const APART: f64 = 0.5;

/// Above this share the file predicts so badly that no robot of this file has recorded the log.
const ABSURD: f64 = 10.0;

/// A base may be tilted by an angle that is sought in these steps, rad; a smaller one than the second number is none.
const TILTS: ([f64; 5], f64) = ([0.4, 0.2, 0.1, 0.05, 0.02], 0.05);

/// Samples that are compared.
const COMPARED: usize = 400;

/// The mistakes of a log that its filtered samples reveal.
///
/// # Errors
/// [`Error::Model`].
pub fn check(model: &Model, log: &Log, filter: &Filter, samples: &Samples) -> Result<Vec<Finding>, Error> {
    let found = mistakes(model, &log.name, samples)?;
    let is_absurd = found.iter().any(|finding| finding.code == "contradiction" && finding.level == Level::Fault);
    if !is_absurd || filter.cutoff != Cutoff::Automatic {
        return Ok(found);
    }
    // degrees spoil the cut-off that follows the predicted forces
    let mut converted = log.clone();
    let rates = [&mut converted.dtheta, &mut converted.ddtheta].into_iter().flatten();
    let all = [&mut converted.theta].into_iter().chain(rates);
    all.for_each(|table| table.iter_mut().for_each(|x| *x = x.to_radians()));
    let Ok((samples, _)) = prepare(model, &converted, filter) else { return Ok(found) };
    let mut comparison = Comparison::new(model, &samples)?;
    if !comparison.is_explained(&Mistake::None) {
        return Ok(found);
    }
    let share = (comparison.score(&Mistake::None) / model.n() as f64).exp();
    let text = format!(
        "{}: {}; then the robot's own values leave {:.2} % of each force's variance unexplained (geometric mean)",
        log.name,
        Mistake::Degrees.text(model),
        100.0 * share
    );
    Ok(vec![Finding::fault(Mistake::Degrees.code(), text)])
}

/// Compares the log with the robot's own prediction under each possible mistake, and reports the one that explains it
/// far better than none and than others, if nearly all of the forces are explained then: two mistakes at once are not
/// one. Only joints of one axis are compared.
///
/// # Errors
/// [`Error::Model`].
fn mistakes(model: &Model, log: &str, samples: &Samples) -> Result<Vec<Finding>, Error> {
    if !model.configuration_space().is_flat() || samples.count() < 20 {
        return Ok(Vec::new());
    }
    let names: Vec<&str> = model.velocity_names().collect();
    let mut comparison = Comparison::new(model, samples)?;
    let as_it_is = comparison.score(&Mistake::None);
    let share = |score: f64| (score / names.len() as f64).exp();
    let most = comparison.most();
    let all: Vec<(Mistake, f64)> = Mistake::all(model, comparison.limits.is_some(), &most)
        .into_iter()
        .chain(Mistake::of_wrenches(samples))
        .filter_map(|mistake| {
            let (score, without) = comparison.scores(&mistake);
            // what friction and armature explain alone is no evidence
            (without - score > CLEAR).then_some((mistake, score))
        })
        .collect();
    let first = all.iter().min_by(|a, b| a.1.total_cmp(&b.1)).cloned();
    let (best, least) = first.filter(|(_, score)| *score < as_it_is).unwrap_or((Mistake::None, as_it_is));
    let of_other_kind = all.iter().filter(|(mistake, _)| mistake.code() != best.code()).map(|(_, score)| *score);
    let is_apart = of_other_kind.fold(f64::MAX, f64::min) - least > APART;
    let evidence = |score: f64| {
        format!(
            "then the robot's own values leave {:.2} % of each force's variance unexplained, now {:.2} % (geometric means)",
            100.0 * share(score),
            100.0 * share(as_it_is)
        )
    };
    let is_explained = comparison.is_explained(&best);
    let gains = comparison.gains();
    if let Some((factor, score)) = comparison.shared(&gains, &best, [as_it_is, least]) {
        if gains::is_far(factor) {
            let text = format!("{log}: {}; {}", gains::text(&gains, &names, Some(factor)), evidence(score));
            return Ok(vec![Finding::fault("unit", text)]);
        }
        let text = format!(
            "{log}: the forces are {factor:.2} times what the robot's file predicts, by one factor for all: another unit \
             (such as per cent of a rated torque) or a gain of the driver, or all masses of the file are wrong; if they \
             are not, divide the forces by it; {}",
            evidence(score)
        );
        return Ok(vec![Finding::warning("scale", text)]);
    }
    let is_rated = matches!(best, Mistake::Rated(_)) && is_explained;
    let scaled: f64 = gains.iter().map(|gain| gain.unexplained.ln()).sum();
    // a factor for each force explains more than any single mistake: the unit
    let is_better = as_it_is - scaled > CLEAR && scaled < least.min(as_it_is - CLEAR) + APART;
    if gains::is_scale(&gains) && is_better && !is_rated {
        let text = format!("{log}: {}; {}", gains::text(&gains, &names, None), evidence(scaled));
        return Ok(vec![Finding::fault("unit", text)]);
    }
    let gain = as_it_is - least;
    Ok(match () {
        () if gain > CLEAR && is_explained && is_apart => {
            let level = if gain > SURE { Level::Fault } else { Level::Warning };
            let text = format!("{log}: {}; {}", best.text(model), evidence(least));
            vec![Finding { code: best.code(), level, text }]
        }
        () if gain > CLEAR && share(as_it_is) > EXPLAINED || share(as_it_is) > ABSURD => {
            if let Some(tilt) = comparison.tilt().filter(|tilt| comparison.is_explained(tilt)) {
                let text = format!("{log}: {}; {}", tilt.text(model), evidence(comparison.score(&tilt)));
                return Ok(vec![Finding::warning(tilt.code(), text)]);
            }
            let level = if share(as_it_is) > ABSURD { Level::Fault } else { Level::Warning };
            let by_joint = comparison.unexplained().into_iter().zip(&names);
            let list: Vec<String> = by_joint.map(|(x, name)| format!("{name} {:.0} %", 100.0 * x)).collect();
            let text = format!(
                "{log}: positions, velocities and forces do not fit the robot's file, and no single mistake explains it: \
                 its own values leave of each force's variance unexplained: {}; columns, signs or units of several \
                 joints, positions of the motor's side, or another robot",
                list.join(", ")
            );
            vec![Finding { code: "contradiction", level, text }]
        }
        () => Vec::new(),
    })
}

/// Whether nearly nothing is left if forces are this many times too large, and masses wrong.
fn is_little(sums: &[Fit], factor: f64) -> bool {
    let left: f64 = sums.iter().map(|fit| fit.unexplained_by_masses(factor).max(1e-12).ln()).sum();
    (left / sums.len() as f64).exp() < EXPLAINED
}

struct Comparison<'a> {
    /// The robot with the log's payload.
    model: Model,
    samples: &'a Samples,
    rows: Vec<usize>,
    /// Effort limits of all joints, if all have one.
    limits: Option<Vec<f64>>,
    workspace: fast::Workspace,
}

impl<'a> Comparison<'a> {
    fn new(model: &Model, samples: &'a Samples) -> Result<Self, Error> {
        let step = samples.count().div_ceil(COMPARED);
        // at uneven distances: a periodic motion may repeat in a multiple of the step
        let uneven = (0..samples.count()).step_by(step).enumerate().map(|(k, row)| row + k * 7919 % step);
        let rows = uneven.filter(|row| *row < samples.count()).collect();
        let limit = |name: &str| {
            let joint = model.joints().find(|joint| joint.name == name)?;
            joint.limits.effort.filter(|limit| *limit > 0.0 && limit.is_finite())
        };
        let limits = model.velocity_names().map(limit).collect();
        let model = robot_of(model, model.parameters(), samples)?;
        let workspace = fast::Workspace::new(&model);
        Ok(Comparison { model, samples, rows, limits, workspace })
    }

    /// The largest size of each position.
    fn most(&self) -> Vec<f64> {
        let n = self.model.n();
        let of = |j: usize| self.rows.iter().map(|&k| self.samples.theta[k * n + j].abs()).fold(0.0, f64::max);
        (0..n).map(of).collect()
    }

    /// Σ_j log of the share of force j that the robot, with friction, armature and an offset fitted, does not predict.
    fn score(&mut self, mistake: &Mistake) -> f64 {
        self.scores(mistake).0
    }

    /// The score, and that of friction, armature and offset alone.
    fn scores(&mut self, mistake: &Mistake) -> (f64, f64) {
        let log = |share: f64| share.max(1e-12).ln();
        self.sums(mistake)
            .iter()
            .fold((0.0, 0.0), |(with, without), fit| (with + log(fit.unexplained()), without + log(fit.without())))
    }

    /// The direction of gravity that explains the forces best, if it is another than the robot's.
    fn tilt(&mut self) -> Option<Mistake> {
        let own = self.model.gravity();
        let (mut g, mut least) = (own, self.score(&Mistake::None));
        for step in TILTS.0 {
            let mut moves = own.norm() > 0.0;
            while moves {
                moves = false;
                for turn in [0, 1, 2].into_iter().flat_map(|axis| [(axis, step), (axis, -step)]) {
                    let mut w = Vec3::zero();
                    w.0[turn.0] = turn.1;
                    let next = SO3::exp(w) * g;
                    let score = self.score(&Mistake::Gravity(next.0));
                    if score < least - 1e-3 {
                        (g, least, moves) = (next, score, true);
                    }
                }
            }
        }
        ((g - own).norm() > TILTS.1 * own.norm()).then_some(Mistake::Gravity(g.0))
    }

    /// Whether nearly nothing is left once the mistake is undone.
    fn is_explained(&mut self, mistake: &Mistake) -> bool {
        let sums = self.sums(mistake);
        is_little(&sums, 1.0)
    }

    /// A factor that all forces share and the score without it, if it explains the forces as well as the best mistake,
    /// and nearly as well as a factor for each force. Forces in shares of the effort limits have a factor for each
    /// limit.
    fn shared(&mut self, gains: &[Gain], best: &Mistake, [as_it_is, least]: [f64; 2]) -> Option<(f64, f64)> {
        let factor = gains::shared(gains)?;
        let sums = self.sums(&Mistake::None);
        let score: f64 = sums.iter().map(|fit| fit.left(factor).max(1e-12).ln()).sum();
        let cost: f64 = sums.iter().map(|fit| fit.cost(factor)).sum();
        let of_each: f64 = gains.iter().map(|gain| gain.unexplained.ln()).sum();
        let is_best = match (best, &self.limits) {
            (Mistake::Rated(whole), Some(limits)) => {
                cost < sums.iter().zip(limits).map(|(fit, limit)| fit.cost(whole / limit)).sum::<f64>() + APART
            }
            _ => score < least + APART,
        };
        let is_clear = as_it_is - score > CLEAR && is_little(&sums, factor) && cost < of_each + 2.0 * CLEAR;
        (is_best && is_clear).then_some((factor, score))
    }

    /// The share of each force that the file does not predict.
    fn unexplained(&mut self) -> Vec<f64> {
        self.sums(&Mistake::None).iter().map(Fit::unexplained).collect()
    }

    /// The factor of each force that fits best.
    fn gains(&mut self) -> Vec<Gain> {
        self.sums(&Mistake::None).iter().map(Fit::gain).collect()
    }

    fn sums(&mut self, mistake: &Mistake) -> Vec<Fit> {
        let n = self.model.n();
        let query = Query::from(InverseDynamics);
        let environment = self.model.environment();
        let gravity = match mistake {
            Mistake::Gravity(g) => Vec3(*g),
            Mistake::NoGravity => Vec3::zero(),
            _ => environment.gravity,
        };
        let mut sums = vec![Fit::default(); n];
        let mut predicted = vec![0.0; n];
        for &k in &self.rows {
            let row = |table: &[f64]| table[k * n..(k + 1) * n].to_vec();
            let mut motion = [row(&self.samples.theta), row(&self.samples.dtheta), row(&self.samples.ddtheta)];
            let mut tau = row(&self.samples.tau);
            mistake.undo(&mut motion, &mut tau, self.limits.as_deref().unwrap_or_default());
            let [theta, dtheta, ddtheta] = &motion;
            let inputs: [&[f64]; 3] = [theta, dtheta, ddtheta];
            let environment = Environment { gravity, applied: &mistake.applied(self.samples, k), ..environment };
            fast::evaluate(&query, &self.model, &inputs, &environment, &mut self.workspace, &mut [&mut predicted]);
            for j in 0..n {
                sums[j].add(tau[j], predicted[j], dtheta[j], ddtheta[j]);
            }
        }
        sums
    }
}
