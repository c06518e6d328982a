//! The coefficients of exp and log, accurate to rounding for every angle θ from 0 to π.
//!
//! They are functions of z = θ², so that their derivatives at θ = 0 exist for dual numbers too.

use crate::scalar::Real;

/// sin θ / θ.
pub fn sinc<S: Real>(z: S) -> S {
    // below this the next term, z²/120, is far under rounding, and θ may be 0
    if z < S::epsilon() {
        return S::one() - z / S::from_f64(6.0);
    }
    let theta = z.sqrt();
    theta.sin_cos().0 / theta
}

/// (1 − cos θ) / θ² = ½ (sin(θ/2) / (θ/2))².
pub fn cosc<S: Real>(z: S) -> S {
    let s = sinc(z * S::from_f64(0.25));
    S::from_f64(0.5) * s * s
}

/// (θ − sin θ) / θ³.
pub fn sinc3<S: Real>(z: S) -> S {
    if z > S::one() {
        let theta = z.sqrt();
        return (theta - theta.sin_cos().0) / (z * theta);
    }
    // Σ (−1)ᵏ θ²ᵏ / (2k + 3)!, until a term is below rounding at z = 1 and with it everywhere, its derivatives too
    let (mut term, mut sum, mut largest) = (S::one() / S::from_f64(6.0), S::zero(), S::one());
    let mut k = 1.0;
    while largest > S::epsilon() {
        sum += term;
        let quotient = S::from_f64((2.0 * k + 2.0) * (2.0 * k + 3.0));
        (term, largest, k) = (-term * z / quotient, largest / quotient, k + 1.0);
    }
    sum
}

/// (1 − (θ/2) cot(θ/2)) / θ², of the inverse left Jacobian of SO(3).
pub fn cotc<S: Real>(z: S) -> S {
    if z > S::one() {
        let half = z.sqrt() * S::from_f64(0.5);
        let (s, c) = half.sin_cos();
        return (S::one() - half * c / s) / z;
    }
    // Σ |B₂ₖ| θ²ᵏ⁻² / (2k)! with the Bernoulli numbers B₂ₖ
    const COEFFICIENTS: [f64; 10] = [
        1.0 / 12.0,
        1.0 / 720.0,
        1.0 / 30240.0,
        1.0 / 1209600.0,
        1.0 / 47900160.0,
        691.0 / 1307674368000.0,
        1.0 / 74724249600.0,
        3617.0 / 10670622842880000.0,
        43867.0 / 5109094217170944000.0,
        174611.0 / 802857662698291200000.0,
    ];
    COEFFICIENTS.iter().rev().fold(S::zero(), |sum, &c| sum * z + S::from_f64(c))
}

/// 2 atan(s/c) / s, the angle over the length s of the vector part of a unit quaternion with scalar part c ≥ 0;
/// z = s².
pub fn angle_over_sine<S: Real>(z: S, c: S) -> S {
    let two = S::from_f64(2.0);
    if z < S::epsilon() {
        return two / c - z * two / (S::from_f64(3.0) * c * c * c);
    }
    let s = z.sqrt();
    two * s.atan2(c) / s
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Dual;

    #[test]
    fn limits_at_zero() {
        for z in [0.0, 1e-300, 1e-160, 1e-24] {
            assert_eq!(sinc(z), 1.0);
            assert_eq!(cosc(z), 0.5);
            assert_eq!(sinc3(z), 1.0 / 6.0);
            assert_eq!(cotc(z), 1.0 / 12.0);
            assert_eq!(angle_over_sine(z, 1.0), 2.0);
            // 2 atan(s/c)/s = 2/c − 2z/(3c³) + …
            let slope = angle_over_sine(Dual { value: z, derivative: 1.0 }, Dual::constant(1.0)).derivative;
            assert!((slope + 2.0 / 3.0).abs() < 1e-15, "{slope}");
        }
    }

    #[test]
    fn series_and_closed_forms_agree_where_both_hold() {
        for k in 0..=100 {
            let theta = 0.5 + 0.02 * k as f64; // across the switch at 1
            let direct = (theta - theta.sin()) / theta.powi(3);
            assert!((sinc3(theta * theta) / direct - 1.0).abs() < 30.0 * f64::EPSILON);
            let direct = (1.0 - 0.5 * theta / (0.5 * theta).tan()) / (theta * theta);
            assert!((cotc(theta * theta) / direct - 1.0).abs() < 100.0 * f64::EPSILON);
            let direct = (1.0 - theta.cos()) / (theta * theta);
            assert!((cosc(theta * theta) / direct - 1.0).abs() < 16.0 * f64::EPSILON);
        }
    }

    #[test]
    #[allow(clippy::excessive_precision)] // twenty digits of each
    fn reference_values() {
        // 40-digit values, rounded
        for (theta, a, b, c, d) in [
            (1e-3, 0.99999983333334166667, 0.49999995833333472222, 0.16666665833333353175, 0.083333334722222255291),
            (0.1, 0.99833416646828152307, 0.49958347219742339044, 0.16658335317184769319, 0.083347225529927457498),
            (0.75, 0.90885168003111222231, 0.47699756644654064656, 0.16204145772246716034, 0.084125195761519460634),
        ] {
            let close = |x: f64, y: f64| assert!((x / y - 1.0).abs() < 4.0 * f64::EPSILON, "{x} {y}");
            close(sinc(theta * theta), a);
            close(cosc(theta * theta), b);
            close(sinc3(theta * theta), c);
            close(cotc(theta * theta), d);
        }
    }
}
