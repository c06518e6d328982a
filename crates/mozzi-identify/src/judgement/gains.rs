//! How well the robot's file explains one force, and the factor that would make it fit: currents, per mille of a rated
//! torque, and torques before the gear differ from N m by a factor for each joint.

/// Joints count if their factor leaves at most this share of their variance unexplained.
const EXPLAINED: f64 = 0.25;

/// Factors between this and its inverse may be the file's own error.
const NEAR_ONE: f64 = 2.5;

/// τ = a τ̂ + d θ̇ + μ tanh(θ̇/0.05) + o, with d, μ ≥ 0.
#[derive(Clone, Debug, Default)]
pub struct Fit {
    count: f64,
    /// Moments of (1, θ̇, tanh, τ̂, τ) about 0.
    moments: [[f64; 5]; 5],
}

/// The factor of one force.
#[derive(Clone, Copy, Debug)]
pub struct Gain {
    /// a: measured over predicted.
    pub factor: f64,
    /// The share of the force's variance that is left.
    pub unexplained: f64,
}

impl Fit {
    pub fn add(&mut self, tau: f64, predicted: f64, dtheta: f64) {
        self.count += 1.0;
        let x = [1.0, dtheta, (dtheta / 0.05).tanh(), predicted, tau];
        for i in 0..5 {
            for j in 0..5 {
                self.moments[i][j] += x[i] * x[j];
            }
        }
    }

    /// Covariances times the count: they remove the offset.
    fn covariance(&self, i: usize, j: usize) -> f64 {
        self.moments[i][j] - self.moments[0][i] * self.moments[0][j] / self.count
    }

    /// The share of the force's variance that is left with a = 1.
    pub fn unexplained(&self) -> f64 {
        let c = |i, j| self.covariance(i, j);
        // of e = τ − τ̂
        let of_error = |i| c(i, 4) - c(i, 3);
        let square = c(4, 4) - 2.0 * c(3, 4) + c(3, 3);
        self.share(friction([[c(1, 1), c(1, 2)], [c(1, 2), c(2, 2)]], [of_error(1), of_error(2)], square).0)
    }

    /// The best a.
    pub fn gain(&self) -> Gain {
        let c = |i, j| self.covariance(i, j);
        if !(c(3, 3) > 0.0) {
            return Gain { factor: 1.0, unexplained: 1.0 };
        }
        // τ̂ is projected out, so that friction is fitted to what it leaves
        let without = |i: usize, j: usize| c(i, j) - c(i, 3) * c(j, 3) / c(3, 3);
        let A = [[without(1, 1), without(1, 2)], [without(1, 2), without(2, 2)]];
        let (left, [d, mu]) = friction(A, [without(1, 4), without(2, 4)], without(4, 4));
        let factor = (c(3, 4) - d * c(1, 3) - mu * c(2, 3)) / c(3, 3);
        Gain { factor, unexplained: self.share(left).max(1e-12) }
    }

    fn share(&self, left: f64) -> f64 {
        let variance = self.covariance(4, 4);
        if variance > 0.0 { (left / variance).max(0.0) } else { 1.0 }
    }
}

/// min ‖e − d θ̇ − μ s‖² with d, μ ≥ 0: what is left, and (d, μ).
fn friction([[vv, vs], [_, ss]]: [[f64; 2]; 2], [ve, se]: [f64; 2], ee: f64) -> (f64, [f64; 2]) {
    let mut best = (ee, [0.0, 0.0]);
    let mut try_one = |d: f64, mu: f64| {
        let left = ee - 2.0 * (d * ve + mu * se) + d * d * vv + 2.0 * d * mu * vs + mu * mu * ss;
        if d >= 0.0 && mu >= 0.0 && left < best.0 {
            best = (left, [d, mu]);
        }
    };
    if vv > 0.0 {
        try_one(ve / vv, 0.0);
    }
    if ss > 0.0 {
        try_one(0.0, se / ss);
    }
    let det = vv * ss - vs * vs;
    if det > 1e-9 * vv * ss {
        try_one((ve * ss - se * vs) / det, (se * vv - ve * vs) / det);
    }
    best
}

/// Whether all forces that the file explains are far from N m.
pub fn is_scale(gains: &[Gain]) -> bool {
    let with_say: Vec<&Gain> = gains.iter().filter(|gain| gain.unexplained < EXPLAINED).collect();
    let is_far = |gain: &&Gain| gain.factor > NEAR_ONE || (0.0..1.0 / NEAR_ONE).contains(&gain.factor);
    2 * with_say.len() > gains.len() && with_say.iter().all(is_far)
}

/// An explanation of the factors.
pub fn text(gains: &[Gain], names: &[&str]) -> String {
    let with_say = || gains.iter().zip(names).filter(|(gain, _)| gain.unexplained < EXPLAINED);
    let list: Vec<String> = with_say().take(8).map(|(gain, name)| format!("{name} {:.4}", gain.factor)).collect();
    let (low, high) =
        with_say().fold((f64::MAX, 0.0_f64), |(a, b), (gain, _)| (a.min(gain.factor), b.max(gain.factor)));
    let is_common = high < 1.6 * low;
    let middle = (low * high).sqrt();
    let is_near = |x: f64| is_common && (0.5..2.0).contains(&(middle / x));
    let others = "motor currents in A (--torque current), per mille of the rated torque, or torques of the motor side, \
                  before the gear";
    let causes = if is_near(1e3) {
        format!("mN m, or per mille of the rated torque ({others})")
    } else if is_near(1e-3) {
        format!("kN m ({others})")
    } else {
        others.to_string()
    };
    format!(
        "forces are not in N m: they are {} times what the robot's file predicts: {causes}; multiply each by its own \
         factor, or name the unit in the header, such as tau_1_mNm",
        list.join(", ")
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
            let (dtheta, predicted) = ((1.3 * t).cos(), 20.0 * t.sin() + 3.0 * (2.7 * t).cos());
            fit.add(0.1 * (predicted + 0.5 * dtheta + 0.3 * (dtheta / 0.05).tanh()) + 0.02, predicted, dtheta);
        }
        let gain = fit.gain();
        assert!((gain.factor - 0.1).abs() < 1e-9 && gain.unexplained < 1e-9, "{gain:?}");
        assert!(fit.unexplained() > 0.5);
        assert!(is_scale(&[gain]) && !is_scale(&[Gain { factor: 1.2, unexplained: 0.01 }]));
        assert!(text(&[gain], &["elbow"]).contains("currents"));
    }
}
