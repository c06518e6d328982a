//! How well the robot's file explains one force, and the factor that would make it fit: currents, per mille of a rated
//! torque, and torques before the gear differ from N m by a factor for each joint.

use nalgebra::{Matrix3, Vector3};

/// Joints count if their factor leaves at most this share of their variance unexplained.
const EXPLAINED: f64 = 0.25;

/// Factors between this and its inverse may be the file's own error.
const NEAR_ONE: f64 = 2.5;

/// A file explains a force if it leaves at most this share of what friction, an armature and an offset leave.
const WITH_SAY: f64 = 0.25;

/// Factors that wrong masses in the file explain.
const BY_MASSES: (f64, f64) = (0.7, 1.4);

/// The standard deviation of the logarithm of such factors.
const MASS_ERROR: f64 = 0.2;

/// Masses between the file's and the best that are tried.
const STEPS: u32 = 8;

/// τ = a τ̂ + d θ̇ + μ tanh(θ̇/0.05) + I θ̈ + o, with d, μ, I ≥ 0.
#[derive(Clone, Debug, Default)]
pub struct Fit {
    count: f64,
    /// Moments of (1, θ̇, tanh, θ̈, τ̂, τ) about 0.
    moments: [[f64; 6]; 6],
}

/// Places in the moments.
const PREDICTED: usize = 4;
const MEASURED: usize = 5;

/// The factor of one force.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    /// a: measured over predicted.
    pub factor: f64,
    /// The share of the force's variance that is left.
    pub unexplained: f64,
    /// The share that is left without τ̂.
    pub without: f64,
}

impl Fit {
    pub fn add(&mut self, tau: f64, predicted: f64, dtheta: f64, ddtheta: f64) {
        self.count += 1.0;
        let x = [1.0, dtheta, (dtheta / 0.05).tanh(), ddtheta, predicted, tau];
        for i in 0..6 {
            for j in 0..6 {
                self.moments[i][j] += x[i] * x[j];
            }
        }
    }

    /// Covariances times the count: they remove the offset.
    fn covariance(&self, i: usize, j: usize) -> f64 {
        self.moments[i][j] - self.moments[0][i] * self.moments[0][j] / self.count
    }

    /// The share of the force's variance that is left with a given a.
    pub fn left(&self, a: f64) -> f64 {
        let c = |i, j| self.covariance(i, j);
        // of e = τ − a τ̂
        let of_error = |i| c(i, MEASURED) - a * c(i, PREDICTED);
        let square = of_error(MEASURED) - a * of_error(PREDICTED);
        let A = core::array::from_fn(|i| core::array::from_fn(|j| c(i + 1, j + 1)));
        self.share(losses(A, [1, 2, 3].map(of_error), square).0)
    }

    /// The share of the force's variance that is left with a = 1.
    pub fn unexplained(&self) -> f64 {
        self.left(1.0)
    }

    /// The share that is left without τ̂.
    pub fn without(&self) -> f64 {
        self.left(0.0)
    }

    /// The share that is left with the best a that a wrong mass may explain, if forces are `factor` times too large.
    pub fn unexplained_by_masses(&self, factor: f64) -> f64 {
        let (low, high) = BY_MASSES;
        self.left(factor).min(self.left(self.gain().factor.clamp(low * factor, high * factor)))
    }

    /// The logarithm of the share that is left if forces are `factor` times too large and the force's mass is wrong,
    /// with a penalty for a wrong mass: the least over the mass.
    pub fn cost(&self, factor: f64) -> f64 {
        let of = |a: f64| self.left(factor * a).max(1e-12).ln() + 0.5 * (a.ln() / MASS_ERROR).powi(2);
        let (low, high) = BY_MASSES;
        let best = (self.gain().factor / factor).clamp(low, high);
        // from the mass of the file to the one that fits best
        (0..=STEPS).map(|k| of(best.powf(f64::from(k) / f64::from(STEPS)))).fold(f64::MAX, f64::min)
    }

    /// The best a.
    pub fn gain(&self) -> Gain {
        let (c, without) = (|i, j| self.covariance(i, j), self.without());
        let square = c(PREDICTED, PREDICTED);
        if !(square > 0.0) {
            return Gain { factor: 1.0, unexplained: 1.0, without };
        }
        // τ̂ is projected out, so that losses are fitted to what it leaves
        let rest = |i: usize, j: usize| c(i, j) - c(i, PREDICTED) * c(j, PREDICTED) / square;
        let A = core::array::from_fn(|i| core::array::from_fn(|j| rest(i + 1, j + 1)));
        let (left, x) = losses(A, [1, 2, 3].map(|i| rest(i, MEASURED)), rest(MEASURED, MEASURED));
        let others: f64 = (0..3).map(|i| x[i] * c(i + 1, PREDICTED)).sum();
        let factor = (c(PREDICTED, MEASURED) - others) / square;
        Gain { factor, unexplained: self.share(left).max(1e-12), without }
    }

    fn share(&self, left: f64) -> f64 {
        let variance = self.covariance(MEASURED, MEASURED);
        if variance > 0.0 { (left / variance).max(0.0) } else { 1.0 }
    }
}

impl Gain {
    /// Whether the file's prediction, and not friction alone, explains the force.
    fn has_say(&self) -> bool {
        self.unexplained < EXPLAINED && self.unexplained < WITH_SAY * self.without
    }
}

/// min ‖e − Σ x_i s_i‖² with x ≥ 0, of the normal equations A x = b and ‖e‖²: what is left, and x.
fn losses(A: [[f64; 3]; 3], b: [f64; 3], square: f64) -> (f64, [f64; 3]) {
    let mut best = (square, [0.0; 3]);
    for subset in 1..8_usize {
        let is_in = |i: usize| subset >> i & 1 == 1;
        if (0..3).any(|i| is_in(i) && !(A[i][i] > 0.0)) {
            continue;
        }
        // of unit diagonal, so that the determinant is that of correlations
        let size = |i: usize| if is_in(i) { A[i][i].sqrt() } else { 1.0 };
        let scaled = Matrix3::from_fn(|i, j| match (i == j, is_in(i) && is_in(j)) {
            (true, _) => 1.0,
            (false, true) => A[i][j] / (size(i) * size(j)),
            _ => 0.0,
        });
        let right = Vector3::from_fn(|i, _| if is_in(i) { b[i] / size(i) } else { 0.0 });
        let Some(y) = Some(scaled).filter(|m| m.determinant() > 1e-9).and_then(|m| m.lu().solve(&right)) else {
            continue;
        };
        let left = square - right.dot(&y);
        if y.iter().all(|y| *y >= 0.0) && left < best.0 {
            best = (left, core::array::from_fn(|i| y[i] / size(i)));
        }
    }
    best
}

/// Whether a factor is far from N m.
pub fn is_far(factor: f64) -> bool {
    factor > NEAR_ONE || (0.0..1.0 / NEAR_ONE).contains(&factor)
}

/// Whether all forces that the file explains are far from N m.
pub fn is_scale(gains: &[Gain]) -> bool {
    let with_say: Vec<&Gain> = gains.iter().filter(|gain| gain.has_say()).collect();
    3 * with_say.len() >= gains.len() && !with_say.is_empty() && with_say.iter().all(|gain| is_far(gain.factor))
}

/// A factor that two thirds of the forces share which the file explains, but for masses; none if masses explain it.
pub fn shared(gains: &[Gain]) -> Option<f64> {
    let factors: Vec<f64> = gains.iter().filter(|gain| gain.has_say()).map(|gain| gain.factor).collect();
    let (lighter, heavier) = BY_MASSES;
    let alike = |factor: f64| -> Vec<f64> {
        let is_alike = |other: &&f64| (lighter * factor..=heavier * factor).contains(*other);
        factors.iter().filter(is_alike).copied().collect()
    };
    let most = factors.iter().filter(|factor| **factor > 0.0).map(|factor| alike(*factor)).max_by_key(Vec::len)?;
    let is_shared = most.len() >= 2 && 3 * most.len() >= 2 * factors.len() && 3 * most.len() >= gains.len();
    let mean = (most.iter().map(|factor| factor.ln()).sum::<f64>() / most.len() as f64).exp();
    (is_shared && !(lighter..=heavier).contains(&mean)).then_some(mean)
}

/// An explanation of the factors, or of the one that all forces share.
pub fn text(gains: &[Gain], names: &[&str], shared: Option<f64>) -> String {
    let with_say = || gains.iter().zip(names).filter(|(gain, _)| gain.has_say());
    let list: Vec<String> = with_say().take(8).map(|(gain, name)| format!("{name} {:.4}", gain.factor)).collect();
    let (low, high) =
        with_say().fold((f64::MAX, 0.0_f64), |(a, b), (gain, _)| (a.min(gain.factor), b.max(gain.factor)));
    let middle = shared.or((high < 1.6 * low).then(|| (low * high).sqrt()));
    let is_near = |x: f64| middle.is_some_and(|middle| (0.5..2.0).contains(&(middle / x)));
    let others = "motor currents in A (--torque current), per mille of the rated torque, or torques of the motor side, \
                  before the gear";
    let causes = if is_near(1e3) {
        format!("mN m, or per mille of the rated torque ({others})")
    } else if is_near(1e-3) {
        format!("kN m ({others})")
    } else {
        others.to_string()
    };
    let (times, remedy) = match shared {
        Some(factor) => (format!("{factor:.4}"), "divide all of them by it"),
        None => (list.join(", "), "multiply each by its own factor"),
    };
    format!(
        "forces are not in N m: they are {times} times what the robot's file predicts: {causes}; {remedy}, or name the \
         unit in the header, such as tau_1_mNm"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_found_beside_friction() {
        let mut fit = Fit::default();
        for k in 0..400 {
            let t = 0.05 * f64::from(k);
            let (dtheta, ddtheta) = ((1.3 * t).cos(), -1.3 * (1.3 * t).sin());
            let predicted = 20.0 * t.sin() + 3.0 * (2.7 * t).cos();
            let losses = 0.5 * dtheta + 0.3 * (dtheta / 0.05).tanh() + 0.2 * ddtheta;
            fit.add(0.1 * (predicted + losses) + 0.02, predicted, dtheta, ddtheta);
        }
        let gain = fit.gain();
        assert!((gain.factor - 0.1).abs() < 1e-9 && gain.unexplained < 1e-9, "{gain:?}");
        assert!(fit.unexplained() > 0.5);
        assert!(is_scale(&[gain]) && !is_scale(&[Gain { factor: 1.2, ..gain }]));
        assert!(text(&[gain], &["elbow"], None).contains("currents"));
        assert!(text(&[gain], &["elbow"], Some(0.1)).contains("they are 0.1000 times"));
    }

    #[test]
    fn a_factor_is_shared_by_most_forces() {
        let all = |factors: &[f64]| -> Vec<Gain> {
            factors.iter().map(|&factor| Gain { factor, unexplained: 0.01, without: 0.5 }).collect()
        };
        let found = shared(&all(&[2.2, 1.8, 21.0])).expect("a factor");
        assert!((found / 2.0 - 1.0).abs() < 0.01, "{found}");
        // the file's masses may be wrong by so much; currents have a factor for each motor
        assert_eq!(shared(&all(&[1.3, 1.1, 1.2])), None);
        assert_eq!(shared(&all(&[1.0 / 12.0, 1.0 / 12.0, 1.0 / 9.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0])), None);
        assert_eq!(shared(&all(&[2.0])), None);
    }
}
