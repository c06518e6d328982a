//! Residual forces after the prediction.

use crate::signals::spectrum::Spectrum;
use crate::signals::{Samples, derivative};

/// A force or a residual below this part of the largest force is rounding.
const ROUNDING: f64 = 1e-6;

/// The residual of one force.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// The force's name.
    pub name: String,
    /// Root mean square of the force, N m or N.
    pub force: f64,
    /// Root mean square of the residual.
    pub rmse: f64,
    /// The frequency of its largest power, Hz, and that power's share.
    pub peak: (f64, f64),
    /// Its correlation with itself one independent sample later: near 0 for noise, near 1 for a missing effect.
    pub autocorrelation: f64,
    /// By how much the measured force comes later than the predicted one, s.
    pub lag: f64,
    /// The standard deviation of the lag, as if residuals were noise.
    pub lag_deviation: f64,
}

impl Residual {
    /// The residual of force j, from samples and predictions, N × n.
    pub fn new(name: &str, j: usize, n: usize, samples: &Samples, predicted: &[f64]) -> Self {
        let N = samples.count();
        let column = |table: &[f64]| -> Vec<f64> { (0..N).map(|k| table[k * n + j]).collect() };
        let (measured, predicted) = (column(&samples.tau), column(predicted));
        let residual: Vec<f64> = (0..N).map(|k| measured[k] - predicted[k]).collect();
        let mean_square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>() / N as f64;
        // τ(t − δ) ≈ τ̂ − δ τ̂′
        let slope = derivative(&predicted, 1.0 / samples.rate);
        let (mut along, mut square) = (0.0, 0.0);
        for k in 0..N {
            along -= residual[k] * slope[k];
            square += slope[k] * slope[k];
        }
        let square = square.max(f64::MIN_POSITIVE);
        let variance = mean_square(&residual) / samples.independent();
        Residual {
            name: name.to_string(),
            force: mean_square(&measured).sqrt(),
            rmse: mean_square(&residual).sqrt(),
            peak: Spectrum::new(&residual, samples.rate).peak(),
            autocorrelation: autocorrelation(&residual, samples.apart()),
            lag: along / square,
            lag_deviation: (variance / square).sqrt(),
        }
    }
}

impl Residual {
    /// By how much standard deviations that take residuals for noise are too small.
    pub fn colour(&self) -> f64 {
        let alike = self.autocorrelation.clamp(0.0, 0.99);
        ((1.0 + alike) / (1.0 - alike)).sqrt()
    }
}

/// The residuals that mean something: both the force and the residual are above rounding of the largest force.
pub fn above_rounding(all: &[Residual]) -> Vec<Residual> {
    let least = ROUNDING * all.iter().map(|r| r.force).fold(0.0, f64::max);
    all.iter().filter(|r| r.force > least && r.rmse > least).cloned().collect()
}

/// The correlation of a signal with itself `lag` samples later.
pub fn autocorrelation(x: &[f64], lag: usize) -> f64 {
    let mean = x.iter().sum::<f64>() / x.len().max(1) as f64;
    let square: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
    let product: f64 = x.iter().zip(x.iter().skip(lag)).map(|(a, b)| (a - mean) * (b - mean)).sum();
    if square > 0.0 { product / square } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_that_comes_later_has_its_lag() {
        let (rate, N) = (200.0, 4000);
        let wave = |t: f64| (1.3 * t).sin() + 0.5 * (3.1 * t).cos();
        let of = |lag: f64| -> Vec<f64> { (0..N).map(|k| wave(k as f64 / rate - lag)).collect() };
        let samples = Samples { t: vec![0.0; N], tau: of(0.01), rate, ..Samples::default() };
        let found = Residual::new("joint", 0, 1, &samples, &of(0.0));
        assert!((found.lag - 0.01).abs() < 1e-4, "{}", found.lag);
        assert!(found.autocorrelation > 0.99);
    }

    /// A joint without a force, as that of a wrist about a vertical axis, and one that is predicted exactly.
    #[test]
    fn rounding_is_not_judged() {
        let residual = |name: &str, force: f64, rmse: f64| Residual {
            name: name.into(),
            force,
            rmse,
            peak: (0.0, 0.0),
            autocorrelation: 0.98,
            lag: 0.1,
            lag_deviation: 1e-3,
        };
        let all = [residual("elbow", 34.0, 0.2), residual("exact", 0.01, 1e-9), residual("wrist", 1.2e-14, 2e-14)];
        let names: Vec<String> = above_rounding(&all).into_iter().map(|r| r.name).collect();
        assert_eq!(names, ["elbow"]);
    }

    #[test]
    fn noise_is_not_correlated() {
        let x = mozzi::random::Random(1).vector(20_000, 1.0);
        assert!(autocorrelation(&x, 1).abs() < 0.02);
    }
}
