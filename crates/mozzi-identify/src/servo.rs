//! Position controllers from logs of targets: gains and delay.

use crate::signals::Samples;
use nalgebra::{Matrix3, Vector3};

/// The law of one joint, τ = kp (θ*(t − δ) − θ) − kd θ̇ + b.
#[derive(Clone, Debug, PartialEq)]
pub struct Servo {
    /// The velocity's name.
    pub joint: String,
    /// kp, N m/rad or N/m, and its standard deviation.
    pub stiffness: [f64; 2],
    /// kd, N m s/rad or N s/m, and its standard deviation.
    pub damping: [f64; 2],
    /// δ, s, of all joints.
    pub delay: f64,
    /// b, N m or N.
    pub bias: f64,
    /// Error over force, root mean squares.
    pub nrms: f64,
}

/// The longest delay that is tried, s.
const LONGEST: f64 = 0.2;

/// Delays that are tried before the best one is refined.
const TRIED: usize = 100;

/// The laws of all joints from samples with targets; none without targets or motion. The delay, the same for all
/// joints, is the one with the least product of the joints' errors; for each delay the rest is linear.
pub fn servos(names: &[&str], samples: &[Samples], gains: &[f64]) -> Vec<Servo> {
    let logs: Vec<&Samples> = samples.iter().filter(|log| log.target.is_some()).collect();
    let n = names.len();
    if logs.is_empty() {
        return Vec::new();
    }
    let all = |delay: f64| -> Vec<Law> { (0..n).map(|j| Law::new(&logs, j, n, delay, gains[j])).collect() };
    let score = |delay: f64| -> f64 { all(delay).iter().map(|law| law.nrms.max(1e-12).ln()).sum() };
    let step = LONGEST / TRIED as f64;
    let mut best = (0, f64::INFINITY);
    for k in 0..=TRIED {
        let found = score(k as f64 * step);
        if found < best.1 {
            best = (k, found);
        }
    }
    let delay = golden((best.0 as f64 - 1.0).max(0.0) * step, (best.0 as f64 + 1.0) * step, score);
    let laws = all(delay).into_iter().zip(names).filter(|(law, _)| law.is_determined);
    laws.map(|(Law { x, deviations, nrms, .. }, joint)| Servo {
        joint: joint.to_string(),
        stiffness: [x[0], deviations[0]],
        damping: [x[1], deviations[1]],
        delay,
        bias: x[2],
        nrms,
    })
    .collect()
}

/// The least value between two bounds, by the golden section.
fn golden(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut c, mut d) = (b - share * (b - a), a + share * (b - a));
    let (mut at_c, mut at_d) = (f(c), f(d));
    for _ in 0..30 {
        if at_c < at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - share * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + share * (b - a);
            at_d = f(d);
        }
    }
    0.5 * (a + b)
}

struct Law {
    x: Vector3<f64>,
    deviations: Vector3<f64>,
    nrms: f64,
    is_determined: bool,
}

impl Law {
    /// Least squares for one joint and one delay.
    fn new(logs: &[&Samples], j: usize, n: usize, delay: f64, gain: f64) -> Self {
        let (mut G, mut g, mut square, mut count) = (Matrix3::zeros(), Vector3::zeros(), 0.0, 0.0);
        let mut independent = 0.0;
        for log in logs {
            let Some(target) = &log.target else { continue };
            let back = delay * log.rate;
            let (whole, share) = (back as usize, back.fract());
            for k in whole + 1..log.count() {
                let at = |table: &[f64], k: usize| table[k * n + j];
                // across a gap the delayed target is another run's
                let is_whole = log.t[k] - log.t[k - whole - 1] < (whole as f64 + 1.5) / log.rate;
                if !is_whole || !log.is_valid[k * n + j] {
                    continue;
                }
                let wanted = (1.0 - share) * at(target, k - whole) + share * at(target, k - whole - 1);
                let a = Vector3::new(wanted - at(&log.theta, k), -at(&log.dtheta, k), 1.0);
                let tau = gain * at(&log.tau, k);
                G += a * a.transpose();
                g += tau * a;
                square += tau * tau;
                count += 1.0;
                independent += log.independent();
            }
        }
        let failed =
            Law { x: Vector3::zeros(), deviations: Vector3::repeat(f64::INFINITY), nrms: 1.0, is_determined: false };
        let scale = G.diagonal().map(|x| if x > 0.0 { 1.0 / x.sqrt() } else { 0.0 });
        let unit = Matrix3::from_diagonal(&scale);
        let scaled = unit * G * unit;
        let is_determined = scaled.symmetric_eigenvalues().min() > 1e-6 && square > 0.0;
        let Some(inverse) = scaled.try_inverse().filter(|_| is_determined) else { return failed };
        let inverse = unit * inverse * unit;
        let x = inverse * g;
        let rest = (square - 2.0 * x.dot(&g) + x.dot(&(G * x))).max(0.0);
        let variance = rest / count * count / independent.max(1.0);
        let deviations = inverse.diagonal().map(|d| (d.max(0.0) * variance).sqrt());
        Law { x, deviations, nrms: (rest / square).sqrt(), is_determined }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass with friction whose target comes 23 ms late, in steps of 0.1 ms, logged at 250 Hz.
    #[test]
    fn gains_and_delay_of_a_simulated_drive_are_found() {
        let (kp, kd, delay, rate) = (80.0, 4.0, 0.023, 250.0);
        let wanted = |t: f64| 0.6 * (2.1 * t).sin() + 0.25 * (5.3 * t).cos() + if t % 3.0 < 1.0 { 0.1 } else { 0.0 };
        let (mut theta, mut dtheta, step) = (0.2, 0.0_f64, 1e-4);
        let mut log = Samples { rate, target: Some(Vec::new()), ..Samples::default() };
        for k in 0..120_000 {
            let t = k as f64 * step;
            let tau = kp * (wanted(t - delay) - theta) - kd * dtheta;
            if k % 40 == 0 {
                log.t.push(t);
                log.theta.push(theta);
                log.dtheta.push(dtheta);
                log.tau.push(tau);
                log.is_valid.push(true);
                log.target.iter_mut().for_each(|target| target.push(wanted(t)));
            }
            let friction = 0.5 * (dtheta / 0.01).tanh() + 1.2 * theta.sin();
            dtheta += step * (tau - friction) / 0.4;
            theta += step * dtheta;
        }
        let found = servos(&["drive"], &[log], &[1.0]);
        let [servo] = found.as_slice() else { panic!("{found:?}") };
        eprintln!("{servo:?}");
        assert!((servo.stiffness[0] / kp - 1.0).abs() < 0.01, "{servo:?}");
        assert!((servo.damping[0] / kd - 1.0).abs() < 0.02, "{servo:?}");
        // the target steps between two rows, 4 ms apart
        assert!((servo.delay / delay - 1.0).abs() < 0.05, "{servo:?}");
        assert!(servo.nrms < 0.05);
    }

    #[test]
    fn a_joint_that_rests_has_no_law() {
        let still = vec![0.1; 100];
        let log = Samples {
            rate: 100.0,
            t: (0..100).map(|k| 0.01 * k as f64).collect(),
            theta: still.clone(),
            dtheta: vec![0.0; 100],
            tau: still.clone(),
            target: Some(still),
            is_valid: vec![true; 100],
            ..Samples::default()
        };
        assert!(servos(&["rests"], &[log], &[1.0]).is_empty());
        assert!(servos(&["none"], &[Samples::default()], &[1.0]).is_empty());
    }
}
