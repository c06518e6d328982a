//! From a log to evenly spaced positions, velocities, accelerations and forces, all filtered alike.

pub mod butterworth;
mod cutoff;
mod quaternions;
mod shape;
pub mod smoothing_spline;
pub mod spectrum;

use crate::cores::each;
use crate::judgement::velocities;
use crate::log::Rows;
use crate::mend::mend;
use crate::{Error, Finding, Level, Log, rotors};
use butterworth::LowPass;
use mozzi::{FrameId, Freedom, Model, SpatialInertia, Wrench};
pub(crate) use quaternions::{continuous, differentiate, normalize};
pub use shape::Shape;
use smoothing_spline::SmoothingSpline;

/// Where the low-pass filter's gain is ½.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Cutoff {
    /// Five times the frequency below which 99.9 % of the velocities' power lies, or twice that of the forces that the
    /// robot's file predicts for this motion, whichever is higher.
    #[default]
    Automatic,
    /// This frequency, Hz.
    Hz(f64),
    /// No filter.
    None,
}

/// How velocities and accelerations are computed from positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Acceleration {
    /// Central differences of fourth order, of the filtered signals.
    #[default]
    Differences,
    /// The smoothing spline of the same cut-off, which also replaces the filter of the other signals.
    Spline,
}

/// How signals are filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// The cut-off frequency.
    pub cutoff: Cutoff,
    /// The order of Butterworth's filter, which runs forwards and backwards.
    pub order: usize,
    /// How accelerations are computed.
    pub acceleration: Acceleration,
    /// The shape of dry friction, whose jumps pass the filter as those of the forces do.
    pub friction: Shape,
}

impl Default for Filter {
    fn default() -> Self {
        let friction = Shape::default();
        Filter { cutoff: Cutoff::Automatic, order: 4, acceleration: Acceleration::Differences, friction }
    }
}

/// Evenly spaced states with their forces, by rows.
#[derive(Clone, Debug, Default)]
pub struct Samples {
    /// Times, s.
    pub t: Vec<f64>,
    /// N × nq.
    pub theta: Vec<f64>,
    /// N × n.
    pub dtheta: Vec<f64>,
    /// N × n.
    pub ddtheta: Vec<f64>,
    /// N × n.
    pub tau: Vec<f64>,
    /// N × (n + rotors that several joints turn): tanh(θ̇/w) of unfiltered velocities, filtered as the forces; None if
    /// velocities were not measured.
    pub coulomb: Option<Vec<f64>>,
    /// Likewise Stribeck's friction.
    pub stribeck: Option<Vec<f64>>,
    /// N × n: target positions, if they were logged.
    pub target: Option<Vec<f64>>,
    /// N × n: whether the force may be used.
    pub is_valid: Vec<bool>,
    /// N × 6 for each frame.
    pub wrenches: Vec<(FrameId, Vec<f64>)>,
    /// A known payload of this log.
    pub payload: Option<(FrameId, SpatialInertia)>,
    /// Samples per second.
    pub rate: f64,
    /// The cut-off, Hz, if the signals were filtered.
    pub cutoff: Option<f64>,
    /// The share of white noise's power that the filter passed, times the rows for one that is kept.
    pub passed: Option<f64>,
    /// Power of forces above the cut-off, which the filter removed, by joint: an estimate of the noise's, N² m².
    pub removed: Vec<f64>,
}

impl Samples {
    /// The number of samples.
    pub fn count(&self) -> usize {
        self.t.len()
    }

    /// The measured wrenches of sample k.
    pub fn applied(&self, k: usize) -> Vec<(FrameId, Wrench)> {
        let wrench = |table: &[f64]| Wrench::from_array(core::array::from_fn(|i| table[6 * k + i]));
        self.wrenches.iter().map(|(frame, table)| (*frame, wrench(table))).collect()
    }

    /// The share of independent samples: white noise loses this share of its power by the filter, but none at the
    /// frequencies of the motion.
    pub fn independent(&self) -> f64 {
        self.passed.unwrap_or(1.0).min(1.0)
    }

    /// Rows from a sample to the next that a filter of cut-off f_c did not make alike: rate/2f_c.
    pub fn apart(&self) -> usize {
        self.cutoff.map_or(1.0, |cutoff| (0.5 * self.rate / cutoff).round().max(1.0)) as usize
    }
}

/// Filters a log.
///
/// # Errors
/// As [`Log::check`], and [`Error::TooShort`] if no run is long enough for the filter.
pub fn prepare(model: &Model, log: &Log, filter: &Filter) -> Result<(Samples, Vec<Finding>), Error> {
    let (mut log, mut findings) = mend(model, log)?;
    if findings.iter().any(|finding| finding.level == Level::Fault && finding.code.contains("clock")) {
        return Err(Error::of_clock(&findings)); // no signal can be filtered without its times
    }
    let mut rows = log.check(model)?;
    findings.extend(rows.findings.clone());
    let rate = 1.0 / rows.step;
    if !rate.is_finite() {
        let found = format!("{:e} s", rows.step);
        return Err(Error::BadOption { option: "the time between two rows", found, expected: "seconds".into() });
    }
    let cutoff = match filter.cutoff {
        Cutoff::None => None,
        Cutoff::Hz(f) => Some(f),
        Cutoff::Automatic => {
            let (f, why) = cutoff::automatic(model, &log, &rows, filter);
            findings.push(Finding::note("cutoff", format!("{}: the cut-off is {f:.3} Hz, {why}", log.name)));
            Some(f)
        }
    };
    let low_pass = cutoff.map(|f| LowPass::new(filter.order, f, rate)).transpose()?;
    // the spline's gain is 1/(1 + (f/f_c)⁴), that of a filter of order 2
    let order = if filter.acceleration == Acceleration::Spline { 2 } else { filter.order };
    let passed = cutoff.map(|f| Ok::<_, Error>(LowPass::new(order, f, rate)?.noise())).transpose()?;
    rows.bridge(&log, cutoff, &mut findings);
    let two_periods = cutoff.map_or(0.0, |f| (2.0 * rate / f).ceil());
    let trim = two_periods as usize; // what the ends of a filtered run are worth
    let stride = cutoff::stride(rows.runs.iter().map(Vec::len).sum(), rate, cutoff);
    if stride > 1 {
        let what =
            format!("{}: one of {stride} filtered rows is fitted, {:.0} a second", log.name, rate / stride as f64);
        findings.push(Finding::note("thinned", format!("{what}: the filter leaves nothing between them")));
    }
    if let Some(finding) = velocities::accelerations(model, &log, &rows, low_pass.as_ref(), trim) {
        findings.push(finding);
        log.to_mut().ddtheta = None;
    }
    let log = log.as_ref();
    let mut samples = Samples {
        rate: rate / stride as f64,
        cutoff,
        passed: passed.map(|share| share * stride as f64),
        payload: log.payload,
        removed: vec![0.0; model.n()],
        ..Samples::default()
    };
    if log.dtheta.is_some() {
        (samples.coulomb, samples.stribeck) = (Some(Vec::new()), filter.friction.stribeck.map(|_| Vec::new()));
    }
    samples.target = log.target.as_ref().map(|_| Vec::new());
    samples.wrenches = log.wrenches.iter().map(|(frame, _)| (*frame, Vec::new())).collect();
    for run in rows.runs.iter().filter(|run| run.len() > trim.saturating_mul(2).saturating_add(10)) {
        let part = Part { model, log, run, rows: &rows, cutoff, low_pass: low_pass.as_ref(), filter, stride };
        part.append(trim, &mut samples);
    }
    findings.extend(velocities::check(model, log, &rows, low_pass.as_ref(), trim));
    if samples.count() < 20 {
        let count = if two_periods < 1e9 { format!("{trim}") } else { format!("{two_periods:.1e}") };
        let why = format!("two periods of the cut-off, {count} rows, are left out at both ends of each run");
        return Err(Error::TooShort { log: log.name.clone(), found: samples.count(), expected: 20, why });
    }
    let N = samples.count() as f64;
    samples.removed.iter_mut().for_each(|sum| *sum /= N);
    Ok((samples, findings))
}

/// Linear interpolation at even times.
pub(crate) fn resampled(t: &[f64], x: &[f64], step: f64) -> Vec<f64> {
    let count = ((t[t.len() - 1] - t[0]) / step + 1e-6) as usize + 1;
    let mut k = 0;
    (0..count)
        .map(|i| {
            let at = t[0] + i as f64 * step;
            while k + 2 < t.len() && t[k + 1] <= at {
                k += 1;
            }
            let share = ((at - t[k]) / (t[k + 1] - t[k])).clamp(0.0, 1.0);
            x[k] + share * (x[k + 1] - x[k])
        })
        .collect()
}

/// One run of rows.
struct Part<'a> {
    model: &'a Model,
    log: &'a Log,
    run: &'a [usize],
    rows: &'a Rows,
    cutoff: Option<f64>,
    low_pass: Option<&'a LowPass>,
    filter: &'a Filter,
    /// One of this many filtered rows is kept.
    stride: usize,
}

impl Part<'_> {
    fn append(&self, trim: usize, samples: &mut Samples) {
        let (n, nq, step) = (self.model.n(), self.model.nq(), self.rows.step);
        let t: Vec<f64> = self.run.iter().map(|&row| self.log.t[row]).collect();
        let raw = |table: &[f64], width: usize, k: usize| -> Vec<f64> {
            resampled(&t, &self.run.iter().map(|&row| table[row * width + k]).collect::<Vec<_>>(), step)
        };
        let columns = |table: &[f64], width: usize| each(width, width * t.len(), |k| raw(table, width, k));
        let times: Vec<f64> = (0..raw(&self.log.t, 1, 0).len()).map(|k| t[0] + k as f64 * step).collect();
        let N = times.len();

        let mut theta = columns(&self.log.theta, nq);
        continuous(self.model, &mut theta);
        // memory: raw positions are kept only if they are differentiated
        let is_spline = self.filter.acceleration == Acceleration::Spline;
        let positions = if is_spline || self.log.dtheta.is_none() { theta.clone() } else { Vec::new() };
        theta = self.smoothed(&times, theta);
        normalize(self.model, &mut theta);
        let mut dtheta = match &self.log.dtheta {
            Some(table) => columns(table, n),
            None => self.velocities(&times, &theta, &positions),
        };
        let shape = &self.filter.friction;
        let kept = || (trim..N.saturating_sub(trim)).step_by(self.stride);
        let thinned = |x: &Vec<f64>| -> Vec<f64> { kept().map(|row| x[row]).collect() };
        // memory: of a filtered signal only what is kept is stored
        let all =
            |width: usize, signal: &(dyn Fn(usize) -> Vec<f64> + Sync)| each(width, width * N, |k| thinned(&signal(k)));
        let store = |to: &mut Vec<f64>, signals: Vec<Vec<f64>>| {
            to.extend((0..kept().len()).flat_map(|row| signals.iter().map(move |x| x[row])));
        };
        let smooth = |mut x: Vec<f64>| {
            self.smooth(&times, &mut x);
            x
        };
        let turned = rotors::signals(self.model, &dtheta);
        let shaped = |to: &mut Option<Vec<f64>>, of: &(dyn Fn(f64) -> f64 + Sync)| {
            let speed = |k: usize| dtheta.get(k).unwrap_or_else(|| &turned[k - n]);
            if let Some(to) = to {
                store(to, all(n + turned.len(), &|k| smooth(speed(k).iter().map(|x| of(*x)).collect())));
            }
        };
        shaped(&mut samples.coulomb, &|x| shape.coulomb(x));
        shaped(&mut samples.stribeck, &|x| shape.stribeck(x));
        if self.log.dtheta.is_some() {
            dtheta = self.smoothed(&times, dtheta);
        }
        store(&mut samples.theta, theta.iter().map(thinned).collect());
        drop(theta);
        let given = self.log.ddtheta.as_ref();
        let ddtheta = match (given, self.filter.acceleration, self.cutoff) {
            (Some(table), ..) => all(n, &|k| smooth(raw(table, n, k))),
            (None, Acceleration::Spline, Some(cutoff)) => {
                self.by_spline(&times, &dtheta, &positions, cutoff).iter().map(thinned).collect()
            }
            _ => all(n, &|k| derivative(&dtheta[k], step)),
        };
        store(&mut samples.ddtheta, ddtheta);
        store(&mut samples.dtheta, dtheta.iter().map(thinned).collect());
        drop(dtheta);
        let forces = each(n, n * N, |k| {
            let rough = raw(&self.log.tau, n, k);
            let x = smooth(rough.clone());
            (thinned(&x), kept().map(|k| (rough[k] - x[k]).powi(2)).sum::<f64>())
        });
        let (forces, removed): (Vec<Vec<f64>>, Vec<f64>) = forces.into_iter().unzip();
        samples.removed.iter_mut().zip(removed).for_each(|(sum, power)| *sum += power);
        store(&mut samples.tau, forces);
        if let (Some(to), Some(table)) = (&mut samples.target, &self.log.target) {
            store(to, all(n, &|k| smooth(raw(table, n, k))));
        }
        for ((_, to), (_, table)) in samples.wrenches.iter_mut().zip(&self.log.wrenches) {
            store(to, all(6, &|k| smooth(raw(table, 6, k))));
        }
        for k in kept() {
            samples.t.push(times[k]);
            let nearest = self.nearest(&t, times[k]);
            samples.is_valid.extend((0..n).map(|j| !self.rows.saturated[nearest * n + j]));
        }
    }

    /// The row of the log nearest to a time.
    fn nearest(&self, t: &[f64], at: f64) -> usize {
        let k = t.partition_point(|&t| t < at).min(t.len() - 1);
        let k = if k > 0 && at - t[k - 1] < t[k] - at { k - 1 } else { k };
        self.run[k]
    }

    /// Filters signals.
    fn smoothed(&self, times: &[f64], signals: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        each(signals.len(), signals.len() * times.len(), |k| {
            let mut x = signals[k].clone();
            self.smooth(times, &mut x);
            x
        })
    }

    /// Filters one signal in place.
    fn smooth(&self, times: &[f64], x: &mut Vec<f64>) {
        match (self.filter.acceleration, self.cutoff, self.low_pass) {
            (Acceleration::Spline, Some(cutoff), _) => *x = SmoothingSpline::new(times, x, cutoff).value,
            (_, _, Some(filter)) => filter.filter(x),
            _ => {}
        }
    }

    /// θ̇ from θ: differences of filtered positions, along the configuration space.
    fn velocities(&self, times: &[f64], theta: &[Vec<f64>], raw: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let (model, step) = (self.model, self.rows.step);
        let (n, N) = (model.n(), times.len());
        let mut found = vec![vec![0.0; N]; n];
        for place in model.configuration_space().places() {
            if place.freedom == Freedom::One {
                found[place.j] = match (self.filter.acceleration, self.cutoff) {
                    (Acceleration::Spline, Some(cutoff)) => SmoothingSpline::new(times, &raw[place.q], cutoff).first,
                    _ => derivative(&theta[place.q], step),
                };
            }
        }
        differentiate(model, theta, step, &mut found);
        found
    }

    /// θ̈ by the smoothing spline: its second derivative if there are positions alone, else the first of θ̇.
    fn by_spline(&self, times: &[f64], dtheta: &[Vec<f64>], raw: &[Vec<f64>], cutoff: f64) -> Vec<Vec<f64>> {
        let mut found: Vec<Vec<f64>> = dtheta.iter().map(|x| derivative(x, self.rows.step)).collect();
        let places = self.model.configuration_space().places();
        if self.log.dtheta.is_none() {
            for place in places.iter().filter(|place| place.freedom == Freedom::One) {
                found[place.j] = SmoothingSpline::new(times, &raw[place.q], cutoff).second;
            }
        }
        found
    }
}

/// Central differences of fourth order, of lower order at the ends.
pub(crate) fn derivative(x: &[f64], step: f64) -> Vec<f64> {
    let N = x.len();
    (0..N)
        .map(|k| match k {
            _ if N < 2 => 0.0,
            0 => (x[1] - x[0]) / step,
            _ if k == N - 1 => (x[k] - x[k - 1]) / step,
            _ if k == 1 || k == N - 2 => (x[k + 1] - x[k - 1]) / (2.0 * step),
            _ => (8.0 * (x[k + 1] - x[k - 1]) - (x[k + 2] - x[k - 2])) / (12.0 * step),
        })
        .collect()
}
