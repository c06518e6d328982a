//! The cut-off frequency of the filter, chosen from the motion.

use super::butterworth::LowPass;
use super::spectrum::Spectrum;
use super::{Filter, Part, Samples, resampled};
use crate::Log;
use crate::cores::each;
use crate::log::Rows;
use mozzi::Model;

/// The share of a signal's power that lies in its band.
const BAND: f64 = 0.999;
/// Cut-off over the band of the velocities, and over that of the forces, which contains products and sines of them.
const OF_VELOCITIES: f64 = 5.0;
const OF_FORCES: f64 = 2.0;
/// Forces are predicted from positions below this many times the velocities' band, where noise is small.
const CLEAR: f64 = 2.0;
/// More rows are not looked at.
const ROWS: usize = 20_000;
/// Forces below this part of the largest have no band of their own.
const SMALL: f64 = 1e-3;

/// The cut-off, at most 0.8 of half the sampling rate, and the reason. Measured forces do not decide: their noise may
/// have any band.
pub(super) fn automatic(model: &Model, log: &Log, rows: &Rows, filter: &Filter) -> (f64, &'static str) {
    let (rate, of_velocities) = (1.0 / rows.step, "five times the band of 99.9 % of the velocities' power");
    let most = 0.4 * rate;
    let Some(run) = rows.runs.iter().max_by_key(|run| run.len()) else { return (most, of_velocities) };
    let band = band_of_velocities(model, log, rows, run);
    let by_velocities = (OF_VELOCITIES * band).min(most);
    let by_forces = (OF_FORCES * band_of_forces(model, log, rows, run, (CLEAR * band).min(most), filter)).min(most);
    if by_forces > by_velocities {
        (by_forces, "twice the band of 99.9 % of the power of the forces that the robot's file predicts")
    } else {
        (by_velocities, of_velocities)
    }
}

/// The band of all velocities, or of all positions if velocities were not measured, Hz.
fn band_of_velocities(model: &Model, log: &Log, rows: &Rows, run: &[usize]) -> f64 {
    let (rate, t) = (1.0 / rows.step, run.iter().map(|&row| log.t[row]).collect::<Vec<f64>>());
    let (table, width) = log.dtheta.as_ref().map_or((&log.theta, model.nq()), |dtheta| (dtheta, model.n()));
    let spectra = each(width, width * run.len(), |k| {
        let x: Vec<f64> = run.iter().map(|&row| table[row * width + k]).collect();
        Spectrum::new(&resampled(&t, &x, rows.step), rate)
    });
    let power = spectra.into_iter().reduce(|mut all, of_one| {
        all.power.iter_mut().zip(&of_one.power).for_each(|(sum, x)| *sum += x);
        all
    });
    power.map_or(0.1 * rate, |power| power.band(BAND).max(power.step))
}

/// The widest band of a force that the file predicts for the positions below `cutoff`, Hz.
fn band_of_forces(model: &Model, log: &Log, rows: &Rows, run: &[usize], cutoff: f64, filter: &Filter) -> f64 {
    let (n, nq, rate) = (model.n(), model.nq(), 1.0 / rows.step);
    let Ok(low_pass) = LowPass::new(filter.order, cutoff, rate) else { return 0.0 };
    let (run, trim) = (&run[..run.len().min(ROWS)], (2.0 * rate / cutoff).ceil() as usize);
    if run.len() <= trim.saturating_mul(2).saturating_add(10) {
        return 0.0;
    }
    let some = |table: &[f64], width: usize| -> Vec<f64> {
        run.iter().flat_map(|&row| &table[row * width..][..width]).copied().collect()
    };
    let motion = Log {
        t: some(&log.t, 1),
        theta: some(&log.theta, nq),
        dtheta: log.dtheta.as_ref().map(|table| some(table, n)),
        tau: vec![0.0; run.len() * n],
        ..Log::default()
    };
    let all: Vec<usize> = (0..run.len()).collect();
    let part = Part {
        model,
        log: &motion,
        run: &all,
        rows,
        cutoff: Some(cutoff),
        low_pass: Some(&low_pass),
        filter,
        stride: 1,
    };
    let mut samples = Samples { removed: vec![0.0; n], ..Samples::default() };
    part.append(trim, &mut samples);
    let mut forces = vec![Vec::with_capacity(samples.count()); n];
    for k in 0..samples.count() {
        let row = k * n..(k + 1) * n;
        let (theta, dtheta) = (&samples.theta[k * nq..][..nq], &samples.dtheta[row.clone()]);
        let Ok(tau) = model.inverse_dynamics(theta, dtheta, &samples.ddtheta[row], &model.environment()) else {
            return 0.0;
        };
        forces.iter_mut().zip(tau.iter()).for_each(|(list, tau)| list.push(*tau));
    }
    let spectra: Vec<Spectrum> = forces.iter().map(|x| Spectrum::new(x, rate)).collect();
    let power = |spectrum: &Spectrum| spectrum.power.iter().sum::<f64>();
    let largest = spectra.iter().map(power).fold(0.0, f64::max);
    let clear = spectra.iter().filter(|spectrum| power(spectrum) > SMALL * SMALL * largest);
    clear.map(|spectrum| spectrum.band(BAND)).filter(|band| band.is_finite()).fold(0.0, f64::max)
}

/// Fewer samples are all kept.
const MANY: usize = 100_000;

/// Samples in a period of the cut-off that are kept.
const PER_PERIOD: f64 = 20.0;

/// A filtered signal is known from every k-th row; this k.
pub fn stride(rows: usize, rate: f64, cutoff: Option<f64>) -> usize {
    let most = cutoff.map_or(1.0, |cutoff| rate / (PER_PERIOD * cutoff));
    (rows / MANY).clamp(1, (most as usize).max(1))
}
