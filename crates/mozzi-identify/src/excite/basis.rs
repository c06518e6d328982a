//! Motions by Fourier series that begin and end at rest.

/// θ_j(t) = θ₀_j + w(t) Σ_k (a_jk sin kωt + b_jk cos kωt), with ω = 2π/T and a window w that rises from 0 to 1 in the
/// first tenth of the time and falls in the last: position, velocity and acceleration begin and end as at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// T, s.
    pub duration: f64,
    /// Harmonics.
    pub harmonics: usize,
}

/// The share of the time in which the window rises.
const RISE: f64 = 0.1;

impl Basis {
    /// The number of coefficients of a joint: θ₀, and two for each harmonic.
    pub fn count(&self) -> usize {
        1 + 2 * self.harmonics
    }

    /// Each coefficient's share of θ, θ̇ and θ̈ at a time.
    pub fn at(&self, t: f64) -> Vec<[f64; 3]> {
        let w = core::f64::consts::TAU / self.duration;
        let window = self.window(t);
        let mut all = vec![[1.0, 0.0, 0.0]];
        for k in 1..=self.harmonics {
            let kw = k as f64 * w;
            let (s, c) = (kw * t).sin_cos();
            all.push(product(window, [s, kw * c, -kw * kw * s]));
            all.push(product(window, [c, -kw * s, -kw * kw * c]));
        }
        all
    }

    /// w, ẇ, ẅ.
    fn window(&self, t: f64) -> [f64; 3] {
        let rise = RISE * self.duration;
        let (x, sign) = if 2.0 * t <= self.duration { (t / rise, 1.0) } else { ((self.duration - t) / rise, -1.0) };
        if x >= 1.0 {
            return [1.0, 0.0, 0.0];
        }
        let x = x.max(0.0);
        // the quintic with no velocity and acceleration at both ends
        let (y, dy, ddy) = (
            x * x * x * (10.0 - 15.0 * x + 6.0 * x * x),
            30.0 * x * x * (1.0 - x) * (1.0 - x),
            60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
        );
        [y, sign * dy / rise, ddy / (rise * rise)]
    }
}

/// A product and its derivatives.
fn product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_values_and_both_ends_are_at_rest() {
        let basis = Basis { duration: 7.0, harmonics: 4 };
        let h = 1e-5;
        for t in [0.2, 0.5, 2.0, 3.4, 6.5, 6.9] {
            let (before, at, after) = (basis.at(t - h), basis.at(t), basis.at(t + h));
            for k in 0..basis.count() {
                for order in 0..2 {
                    let slope = (after[k][order] - before[k][order]) / (2.0 * h);
                    assert!((slope - at[k][order + 1]).abs() < 1e-6, "{t} {k} {order}");
                }
            }
        }
        for t in [0.0, 7.0] {
            assert!(basis.at(t)[1..].iter().flatten().all(|x| x.abs() < 1e-12));
        }
    }
}
