//! The whole of it: from logs to estimates and their errors on parts that were left out.

use crate::compress::{Compressed, Evidence, PARTS};
use crate::estimate::least_squares::Decomposition;
use crate::finding::keep_causes;
use crate::judgement::{limits, rest, short, suspicion};
use crate::predict::predict_some;
use crate::setup::{Estimates, Limits, Setup, without_constraints};
use crate::signals::{Filter, Samples, prepare};
use crate::{Choice, Error, Finding, Kind, Level, Log};
use mozzi::Model;
use nalgebra::DMatrix;

/// How a robot is identified.
#[derive(Clone, Debug)]
pub struct Options {
    /// Which parameters are estimated.
    pub choice: Choice,
    /// How signals are filtered.
    pub filter: Filter,
    /// γ: the weight of the robot's own values, relative to the weighted squared error per sample. Between 0.1 and 1
    /// it hardly matters.
    pub prior: f64,
    /// Whether large residuals count less: Huber's weights.
    pub robust: bool,
    /// Bounds that the data alone does not know.
    pub limits: Limits,
    /// The first part of each log that is used, in tenths: 10 for all of it. The rest is held out.
    pub tenths: usize,
    /// Whether to fit a log that contradicts itself or the robot; the contradictions are then warnings.
    pub trust_log: bool,
}

impl Default for Options {
    fn default() -> Self {
        let (choice, filter) = (Choice::default(), Filter::default());
        Options {
            choice,
            filter,
            prior: 0.3,
            robust: false,
            limits: Limits::default(),
            tenths: PARTS,
            trust_log: false,
        }
    }
}

/// Root mean square errors of each force, N m or N, on the same samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// The force itself.
    pub force: Vec<f64>,
    /// Errors of the given robot with its own friction.
    pub robot: Vec<f64>,
    /// Errors of the given robot with fitted friction and offsets.
    pub friction: Vec<f64>,
    /// Errors of least squares.
    pub least_squares: Vec<f64>,
    /// Errors of the estimate with physically consistent bodies.
    pub consistent: Vec<f64>,
    /// Errors of the robot as files can express it, with offsets, without apparent inertias and dampings.
    pub written: Vec<f64>,
}

/// A joint's force below this part of the largest is not judged by itself: a wrist that turns nothing has none.
const SMALL_FORCE: f64 = 1e-3;

impl Errors {
    /// Σ_j error_j / weight_j: one number for all joints.
    pub fn weighted_sum(errors: &[f64], weights: &[f64]) -> f64 {
        errors.iter().zip(weights).filter(|(_, w)| **w > 0.0).map(|(e, w)| e / w).sum()
    }

    /// The root mean square over joints of the errors relative to the forces: NRMS. A force below a thousandth of the
    /// largest counts as that.
    pub fn normalized(&self, errors: &[f64]) -> f64 {
        let least = SMALL_FORCE * self.force.iter().copied().fold(0.0, f64::max);
        let joints = errors.iter().zip(&self.force).filter(|(_, f)| **f > 0.0);
        let used: Vec<f64> = joints.map(|(e, f)| e / f.max(least)).collect();
        (used.iter().map(|e| e * e).sum::<f64>() / used.len().max(1) as f64).sqrt()
    }
}

/// Blocks of time that are left out in turn.
const BLOCKS: usize = 5;

/// An identified robot.
#[derive(Debug)]
pub struct Identification<'m> {
    /// The fitted problem.
    pub setup: Setup<'m>,
    /// The filtered logs.
    pub samples: Vec<Samples>,
    /// The equations of the logs.
    pub logs: Vec<Compressed>,
    /// Both estimates.
    pub estimates: Estimates,
    /// Errors on the samples that were fitted.
    pub fitted: Errors,
    /// Errors on five blocks of the fitted part, each predicted by a fit on the other four.
    pub left_out: Option<Errors>,
    /// Errors on the part of the logs that `tenths` holds out.
    pub held_out: Option<Errors>,
    /// The fits that predicted the blocks.
    left_out_fits: Vec<Vec<f64>>,
    /// Findings in the logs and the fit.
    pub findings: Vec<Finding>,
    tenths: usize,
}

/// Identifies a robot from its logs. `stop` is polled; when it returns true, the best result so far is returned.
///
/// # Errors
/// [`Error`]: a log that cannot be read, a motion that excites nothing, or a wrong option.
pub fn identify<'m>(
    model: &'m Model,
    logs: &[Log],
    options: &Options,
    stop: &dyn Fn() -> bool,
) -> Result<Identification<'m>, Error> {
    if options.tenths == 0 || options.tenths > PARTS {
        let found = options.tenths.to_string();
        return Err(Error::BadOption { option: "the part to fit", found, expected: "1 to 10 tenths".into() });
    }
    if logs.is_empty() {
        return Err(Error::BadOption {
            option: "the number of logs",
            found: "0".into(),
            expected: "at least 1".into(),
        });
    }
    without_constraints(model)?;
    if options.choice.gains && logs.iter().all(|log| log.payload.is_none()) {
        return Err(Error::BadOption {
            option: "the number of logs with a known payload",
            found: "0".into(),
            expected: "at least 1: drive gains, in N m/A, need a known mass".into(),
        });
    }
    let setup = Setup::new(model, options.choice.clone(), options.prior, &options.limits)?;
    let (mut samples, mut findings) = (Vec::new(), Vec::new());
    for log in logs {
        let filter = Filter { friction: options.choice.shape(), ..options.filter };
        let (of_log, mut more) = prepare(model, log, &filter)?;
        if options.choice.links {
            more.extend(rest::check(model, log));
        }
        more.extend(limits::check(model, log, &of_log, !options.choice.gains));
        keep_causes(&mut more);
        // a log that contradicts itself is not compared with the robot
        if !options.choice.gains && !more.iter().any(|finding| finding.level == Level::Fault) {
            more.extend(suspicion::check(model, log, &filter, &of_log)?);
        }
        samples.push(of_log);
        findings.extend(more);
    }
    for (k, log) in logs.iter().enumerate() {
        if let Some(other) = logs[..k].iter().find(|other| other.is_same(log)) {
            let text = format!("{} and {} hold the same rows: they count twice", other.name, log.name);
            findings.push(Finding::warning("same_log", text));
        }
    }
    if options.choice.links {
        findings.extend(short::check(logs, &samples));
        keep_causes(&mut findings);
    }
    match options.trust_log {
        true => demote(&mut findings),
        false if findings.iter().any(|finding| finding.level == Level::Fault) => {
            return Err(Error::of_faults(&findings));
        }
        false => {}
    }
    let compress = |samples: &Samples| Compressed::new(&setup.columns, &setup.pattern, samples, None);
    let compressed: Vec<Compressed> = samples.iter().map(compress).collect::<Result<_, _>>()?;
    let tenths = options.tenths;
    let P = setup.columns.count();
    let all = |logs: &[Compressed]| Evidence::new(&setup.pattern, P, logs, |_, part| part < tenths);
    let evidence = all(&compressed);
    let mut estimates = setup.fit(&evidence, stop)?;
    if options.robust {
        let weighted = reweighted(&setup, &samples, &estimates)?;
        estimates = setup.fit(&all(&weighted), stop)?;
    }
    let fitted = errors(&setup, &evidence, &estimates, &evidence)?;
    let held_out = (tenths < PARTS)
        .then(|| {
            let rest = Evidence::new(&setup.pattern, P, &compressed, |_, part| part >= tenths);
            errors(&setup, &evidence, &estimates, &rest)
        })
        .transpose()?;
    if estimates.consistent.is_stopped {
        findings.push(Finding::warning("stopped", "stopped before the optimum: the result is the best so far"));
    }
    if estimates.consistent.is_astray {
        let text = "the search for bodies that exist ended before the optimum: do not use its values; a larger --prior \
                    helps, or limits of what is estimated";
        findings.push(Finding::warning("astray", text));
    }
    let mut found = Identification {
        setup,
        samples,
        logs: compressed,
        estimates,
        fitted,
        left_out: None,
        left_out_fits: Vec::new(),
        held_out,
        findings,
        tenths,
    };
    if !stop() {
        match cross_validated(&found.setup, &found.logs, tenths, BLOCKS, stop) {
            Ok((errors, fits)) => (found.left_out, found.left_out_fits) = (Some(errors), fits),
            Err(why) => {
                let text = format!(
                    "without each fifth of the motion in turn there is no fit ({why}): errors are those of the motion that \
                     was fitted"
                );
                found.findings.push(Finding::warning("not_left_out", text));
            }
        }
    }
    Ok(found)
}

impl<'m> Identification<'m> {
    /// The forces of a log's samples, N × n, each predicted by a fit without its block of time.
    ///
    /// # Errors
    /// [`Error::Model`].
    pub fn predicted_unseen(&self, samples: &Samples) -> Result<Vec<f64>, Error> {
        let mut all = Vec::new();
        let whole = self.estimates.consistent.predicting();
        for part in 0..PARTS {
            let range = part * samples.count() / PARTS..(part + 1) * samples.count() / PARTS;
            let block = part * self.left_out_fits.len() / self.tenths;
            let x = self.left_out_fits.get(block).filter(|_| part < self.tenths).unwrap_or(&whole);
            all.extend(predict_some(&self.setup.columns, x, samples, range)?);
        }
        Ok(all)
    }

    /// The first part of each log that is fitted, in tenths.
    pub fn tenths(&self) -> usize {
        self.tenths
    }

    /// Errors of this robot on other logs.
    ///
    /// # Errors
    /// As [`identify`].
    pub fn validate(&self, log: &Log, filter: &Filter) -> Result<(Errors, Samples, Vec<Finding>), Error> {
        let filter = Filter { friction: self.setup.columns.choice.shape(), ..*filter };
        let (samples, mut findings) = prepare(self.setup.columns.model, log, &filter)?;
        keep_causes(&mut findings);
        demote(&mut findings);
        let P = self.setup.columns.count();
        let compressed = [Compressed::new(&self.setup.columns, &self.setup.pattern, &samples, None)?];
        let other = Evidence::new(&self.setup.pattern, P, &compressed, |_, _| true);
        Ok((errors(&self.setup, &self.evidence(), &self.estimates, &other)?, samples, findings))
    }

    /// Replaces the consistent estimate, as after a [refinement](crate::refine()); the errors on the fitted and on the
    /// held-out part become those of the new one. Those on blocks left out stay: they belong to other fits.
    ///
    /// # Errors
    /// [`Error::NotExciting`].
    pub fn replace(&mut self, x: Vec<f64>) -> Result<(), Error> {
        self.estimates.consistent.x = x;
        let (P, tenths, fitted) = (self.setup.columns.count(), self.tenths, self.evidence());
        self.fitted = errors(&self.setup, &fitted, &self.estimates, &fitted)?;
        if self.held_out.is_some() {
            let rest = Evidence::new(&self.setup.pattern, P, &self.logs, |_, part| part >= tenths);
            self.held_out = Some(errors(&self.setup, &fitted, &self.estimates, &rest)?);
        }
        Ok(())
    }

    /// The equations that were fitted.
    pub fn evidence(&self) -> Evidence {
        Evidence::new(&self.setup.pattern, self.setup.columns.count(), &self.logs, |_, part| part < self.tenths)
    }
}

/// Makes faults warnings.
fn demote(findings: &mut [Finding]) {
    findings.iter_mut().for_each(|finding| finding.level = finding.level.min(Level::Warning));
}

/// Errors on blocks in time, each predicted by fits on the other blocks, pooled; and those fits.
pub(crate) fn cross_validated(
    setup: &Setup<'_>,
    logs: &[Compressed],
    tenths: usize,
    blocks: usize,
    stop: &dyn Fn() -> bool,
) -> Result<(Errors, Vec<Vec<f64>>), Error> {
    let P = setup.columns.count();
    let blocks = blocks.min(tenths);
    let block = |part: usize| part * blocks / tenths;
    let (mut pooled, mut fits): (Option<Errors>, _) = (None, Vec::new());
    for left_out in 0..blocks {
        let others = Evidence::new(&setup.pattern, P, logs, |_, part| part < tenths && block(part) != left_out);
        let own = Evidence::new(&setup.pattern, P, logs, |_, part| part < tenths && block(part) == left_out);
        let estimates = setup.fit(&others, stop)?;
        if estimates.consistent.is_astray {
            return Err(Error::NotExciting { reason: "a search ended before its optimum".into() });
        }
        let of_block = errors(setup, &others, &estimates, &own)?;
        fits.push(estimates.consistent.predicting());
        pooled = Some(match pooled {
            None => of_block,
            Some(all) => all.pooled(&of_block, left_out as f64),
        });
    }
    let errors = pooled.ok_or_else(|| Error::NotExciting { reason: "there are no blocks".into() })?;
    Ok((errors, fits))
}

impl Errors {
    /// Root mean squares over `count` blocks and one more.
    fn pooled(&self, other: &Errors, count: f64) -> Errors {
        let mean = |a: &[f64], b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| ((count * a * a + b * b) / (count + 1.0)).sqrt()).collect()
        };
        Errors {
            force: mean(&self.force, &other.force),
            robot: mean(&self.robot, &other.robot),
            friction: mean(&self.friction, &other.friction),
            least_squares: mean(&self.least_squares, &other.least_squares),
            consistent: mean(&self.consistent, &other.consistent),
            written: mean(&self.written, &other.written),
        }
    }
}

/// The errors of estimates on some equations; friction alone is fitted to those of the estimates.
fn errors(setup: &Setup<'_>, fitted: &Evidence, estimates: &Estimates, on: &Evidence) -> Result<Errors, Error> {
    let prior = setup.columns.prior();
    Ok(Errors {
        force: on.rms(),
        robot: on.rmse(&prior),
        friction: on.rmse(&friction_alone(setup, fitted, &estimates.least_squares.sigma)),
        least_squares: on.rmse(&estimates.least_squares.x),
        consistent: on.rmse(&estimates.consistent.predicting()),
        written: on.rmse(&estimates.consistent.x),
    })
}

/// The robot's own links, with friction and offsets by least squares.
fn friction_alone(setup: &Setup<'_>, evidence: &Evidence, sigma: &[f64]) -> Vec<f64> {
    let mut x = setup.columns.prior();
    let is_free = |k: &usize| {
        !matches!(
            setup.columns.unknowns[*k].kind,
            Kind::Link(_) | Kind::Payload(_) | Kind::Armature(_) | Kind::Apparent(_) | Kind::Gain(_)
        )
    };
    let free: Vec<usize> = (0..x.len()).filter(is_free).collect();
    if free.is_empty() {
        return x;
    }
    free.iter().for_each(|&k| x[k] = 0.0);
    let all = evidence.weighted(sigma);
    let P = all.unknowns();
    let columns: Vec<usize> = free.iter().copied().chain([P]).collect();
    let mut rows: DMatrix<f64> = all.R.select_columns(&columns);
    for k in (0..P).filter(|k| !free.contains(k)) {
        rows.column_mut(free.len()).axpy(-x[k], &all.R.column(k), 1.0);
    }
    let mut R = crate::Triangle::new(free.len());
    R.push(rows, all.rows);
    let values = Decomposition::new(&R).solution();
    free.iter().zip(values).for_each(|(&k, value)| x[k] = value);
    x
}

/// The equations with Huber's weights: residuals above 1.345 σ count by their size alone.
fn reweighted(setup: &Setup<'_>, samples: &[Samples], estimates: &Estimates) -> Result<Vec<Compressed>, Error> {
    let (x, sigma, P) = (&estimates.consistent.predicting(), &estimates.least_squares.sigma, setup.columns.count());
    let weight = |_: usize, A: &[f64], b: &[f64], w: &mut [f64]| {
        for (j, w) in w.iter_mut().enumerate() {
            let residual = A[j * P..][..P].iter().zip(x).map(|(a, x)| a * x).sum::<f64>() - b[j];
            *w = (1.345 * sigma[j] / residual.abs().max(f64::MIN_POSITIVE)).min(1.0).sqrt();
        }
    };
    let one = |samples: &Samples| Compressed::new(&setup.columns, &setup.pattern, samples, Some(&weight));
    samples.iter().map(one).collect()
}
