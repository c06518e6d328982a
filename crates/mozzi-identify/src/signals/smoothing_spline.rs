//! The cubic smoothing spline (Reinsch 1967): a curve with its first two derivatives, from samples at any times.

/// Values, first and second derivatives of a smoothing spline at its knots.
#[derive(Clone, Debug)]
pub struct SmoothingSpline {
    /// The smoothed values.
    pub value: Vec<f64>,
    /// First derivatives.
    pub first: Vec<f64>,
    /// Second derivatives, 0 at both ends.
    pub second: Vec<f64>,
}

impl SmoothingSpline {
    /// The spline that minimizes Σ(y − f)² + p ∫ f″² dt. For samples every h seconds it is a low-pass filter without
    /// phase, of gain 1 / (1 + p h ω⁴): `cutoff`, Hz, is where the gain is ½, so p = 1/(h ω_c⁴).
    ///
    /// Cost O(N).
    ///
    /// # Panics
    /// When there are not as many values as times, or fewer than four.
    pub fn new(t: &[f64], y: &[f64], cutoff: f64) -> Self {
        let N = t.len();
        assert!(N == y.len() && N >= 4, "{} values at {N} times, expected as many, and four or more", y.len());
        let h: Vec<f64> = t.windows(2).map(|w| w[1] - w[0]).collect();
        let mean = (t[N - 1] - t[0]) / (N - 1) as f64;
        let p = 1.0 / (mean * (2.0 * core::f64::consts::PI * cutoff).powi(4));
        // (R + p QᵀQ) γ = Qᵀy, of bandwidth 2; Q has the columns (1/h_k, −1/h_k − 1/h_k+1, 1/h_k+1)
        let m = N - 2;
        let column = |k: usize| [1.0 / h[k], -1.0 / h[k] - 1.0 / h[k + 1], 1.0 / h[k + 1]];
        let dot = |a: [f64; 3], b: [f64; 3], shift: usize| (shift..3).map(|i| a[i] * b[i - shift]).sum::<f64>();
        let mut band = vec![[0.0; 3]; m]; // diagonal, and one and two below it
        let mut rhs = vec![0.0; m];
        for k in 0..m {
            let c = column(k);
            band[k][0] = (h[k] + h[k + 1]) / 3.0 + p * dot(c, c, 0);
            if k + 1 < m {
                band[k][1] = h[k + 1] / 6.0 + p * dot(c, column(k + 1), 1);
            }
            if k + 2 < m {
                band[k][2] = p * dot(c, column(k + 2), 2);
            }
            rhs[k] = c[0] * y[k] + c[1] * y[k + 1] + c[2] * y[k + 2];
        }
        solve(&mut band, &mut rhs);
        let mut second = vec![0.0; N];
        second[1..=m].copy_from_slice(&rhs);
        let mut value = y.to_vec();
        for k in 0..m {
            for (i, c) in column(k).into_iter().enumerate() {
                value[k + i] -= p * c * rhs[k];
            }
        }
        let slope = |k: usize| (value[k + 1] - value[k]) / h[k];
        let mut first: Vec<f64> =
            (0..N - 1).map(|k| slope(k) - h[k] / 6.0 * (2.0 * second[k] + second[k + 1])).collect();
        first.push(slope(N - 2) + h[N - 2] / 6.0 * (2.0 * second[N - 1] + second[N - 2]));
        SmoothingSpline { value, first, second }
    }
}

/// Solves a positive definite system of bandwidth 2 by L D Lᵀ.
fn solve(band: &mut [[f64; 3]], rhs: &mut [f64]) {
    let m = band.len();
    for k in 0..m {
        let [d, a, b] = band[k];
        if k + 1 < m {
            band[k + 1][0] -= a * a / d;
            band[k + 1][1] -= a * b / d;
            rhs[k + 1] -= a / d * rhs[k];
        }
        if k + 2 < m {
            band[k + 2][0] -= b * b / d;
            rhs[k + 2] -= b / d * rhs[k];
        }
    }
    for k in (0..m).rev() {
        let [d, a, b] = band[k];
        let one = if k + 1 < m { a * rhs[k + 1] } else { 0.0 };
        let two = if k + 2 < m { b * rhs[k + 2] } else { 0.0 };
        rhs[k] = (rhs[k] - one - two) / d;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_are_damped_by_the_formula_and_differentiated() {
        let (h, cutoff) = (0.01, 5.0);
        let t: Vec<f64> = (0..1500).map(|k| k as f64 * h).collect();
        for f in [0.5, 2.0, 5.0, 8.0] {
            let w = 2.0 * core::f64::consts::PI * f;
            let y: Vec<f64> = t.iter().map(|t| (w * t).sin()).collect();
            let spline = SmoothingSpline::new(&t, &y, cutoff);
            let gain = 1.0 / (1.0 + (f / cutoff).powi(4));
            let mut errors = [0.0_f64; 3];
            for k in 400..1100 {
                let expected = [y[k] * gain, w * (w * t[k]).cos() * gain, -w * w * y[k] * gain];
                let found = [spline.value[k], spline.first[k], spline.second[k]];
                for i in 0..3 {
                    errors[i] = errors[i].max((found[i] - expected[i]).abs() / w.powi(i as i32));
                }
            }
            // a cubic spline's own error is O((ω h)²) in the second derivative
            assert!(errors.iter().all(|e| *e < 0.2 * (w * h).powi(2)), "{f} Hz: {errors:?}");
        }
    }

    #[test]
    fn uneven_times_of_a_parabola_are_exact_inside() {
        let t: Vec<f64> = (0..400).map(|k| 0.01 * k as f64 + 0.003 * (k as f64).sin()).collect();
        let y: Vec<f64> = t.iter().map(|t| 1.0 - 2.0 * t + 3.0 * t * t).collect();
        let spline = SmoothingSpline::new(&t, &y, 20.0);
        for k in 150..250 {
            let errors = [spline.value[k] - y[k], spline.first[k] - (6.0 * t[k] - 2.0), spline.second[k] - 6.0];
            assert!(errors.iter().all(|e| e.abs() < 1e-6), "{errors:?}");
        }
    }
}
