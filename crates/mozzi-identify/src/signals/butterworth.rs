//! A low-pass filter without phase: Butterworth's, forwards and backwards (Gustafsson 1996 for the ends).

use crate::Error;

/// A second-order section, b₀(1 + 2z⁻¹ + z⁻²) / (1 + a₁z⁻¹ + a₂z⁻²).
#[derive(Clone, Copy, Debug)]
struct Section {
    b: f64,
    a: [f64; 2],
}

/// Butterworth's low-pass filter of an even order, as second-order sections.
#[derive(Clone, Debug)]
pub struct LowPass {
    sections: Vec<Section>,
    /// Rows by which a signal is continued at each end.
    padding: usize,
    order: usize,
    /// tan(πf_c/r).
    w: f64,
}

impl LowPass {
    /// A filter of gain 1 at 0 Hz and 1/√2 at the cut-off, by the bilinear transform with the cut-off kept. Run
    /// forwards and backwards, the gain at the cut-off is ½.
    ///
    /// # Errors
    /// [`Error::BadOption`] if the order is odd or 0, or the cut-off not below half of the sampling rate (both Hz).
    pub fn new(order: usize, cutoff: f64, rate: f64) -> Result<Self, Error> {
        if order == 0 || !order.is_multiple_of(2) || order > 8 {
            let found = order.to_string();
            return Err(Error::BadOption { option: "the filter's order", found, expected: "2, 4, 6 or 8".into() });
        }
        if !(cutoff > 0.0 && cutoff < 0.5 * rate) {
            return Err(Error::BadOption {
                option: "the cut-off frequency",
                found: format!("{cutoff} Hz"),
                expected: format!("between 0 and {} Hz, half of the sampling rate", 0.5 * rate),
            });
        }
        let w = (core::f64::consts::PI * cutoff / rate).tan();
        let section = |k: usize| {
            let damping = 2.0 * (core::f64::consts::PI * (2 * k + 1) as f64 / (2 * order) as f64).sin();
            let size = 1.0 + damping * w + w * w;
            Section { b: w * w / size, a: [2.0 * (w * w - 1.0) / size, (1.0 - damping * w + w * w) / size] }
        };
        let padding = ((3.0 * rate / cutoff) as usize).max(3 * (order + 1));
        Ok(LowPass { sections: (0..order / 2).map(section).collect(), padding, order, w })
    }

    /// The share of white noise's power that passes forwards and backwards, (1/π) ∫₀^π |H|⁴ dω with |H|² = 1/(1 +
    /// (u/w)^2·order), u = tan ω/2: about (1 − 1/(2 order)) 2f_c/r.
    pub fn noise(&self) -> f64 {
        const STEPS: usize = 2000;
        let at = |k: usize| {
            let x = (k as f64 + 0.5) / STEPS as f64;
            let ratio = x / (1.0 - x); // u/w, from 0 to ∞
            let u = self.w * ratio;
            self.w / ((1.0 - x) * (1.0 - x) * (1.0 + u * u) * (1.0 + ratio.powi(2 * self.order as i32)).powi(2))
        };
        core::f64::consts::FRAC_2_PI * (0..STEPS).map(at).sum::<f64>() / STEPS as f64
    }

    /// Filters a signal forwards and backwards in place. At each end it is continued by its point reflection.
    pub fn filter(&self, x: &mut [f64]) {
        let N = x.len();
        if N < 2 {
            return;
        }
        let pad = self.padding.min(N - 1);
        let before = (0..pad).map(|k| 2.0 * x[0] - x[pad - k]);
        let after = (0..pad).map(|k| 2.0 * x[N - 1] - x[N - 2 - k]);
        let mut y: Vec<f64> = before.chain(x.iter().copied()).chain(after).collect();
        self.pass(&mut y);
        y.reverse();
        self.pass(&mut y);
        y.reverse();
        x.copy_from_slice(&y[pad..pad + N]);
    }

    /// One pass, from the state of rest at the first value.
    fn pass(&self, x: &mut [f64]) {
        let first = x.first().copied().unwrap_or_default();
        for &Section { b, a: [a1, a2] } in &self.sections {
            // a constant input 1 gives 1: the states of the transposed form are then constant, too
            let (mut z1, mut z2) = ((1.0 - b) * first, (b - a2) * first);
            for value in &mut *x {
                let y = b * *value + z1;
                z1 = 2.0 * b * *value - a1 * y + z2;
                z2 = b * *value - a2 * y;
                *value = y;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_keep_their_phase_and_lose_what_the_formula_says() {
        // |H|² = 1 / (1 + (tan(πf/r) / tan(πf_c/r))^2·order), forwards and backwards
        let (rate, cutoff, order) = (100.0, 5.0, 4);
        let filter = LowPass::new(order, cutoff, rate).expect("an order and a cut-off");
        for f in [1.0, 4.0, 5.0, 7.0, 12.0] {
            let wave = |k: usize| (2.0 * core::f64::consts::PI * f * k as f64 / rate).sin();
            let mut x: Vec<f64> = (0..2000).map(wave).collect();
            filter.filter(&mut x);
            let ratio = (core::f64::consts::PI * f / rate).tan() / (core::f64::consts::PI * cutoff / rate).tan();
            let gain = 1.0 / (1.0 + ratio.powi(2 * order as i32));
            let error = (500..1500).map(|k| (x[k] - gain * wave(k)).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "{f} Hz: {error:e}");
        }
    }

    #[test]
    fn the_share_of_noise_is_the_power_of_an_impulse() {
        for (order, cutoff) in [(4, 5.0), (2, 1.0), (8, 30.0)] {
            let filter = LowPass::new(order, cutoff, 100.0).expect("an order and a cut-off");
            let mut x = vec![0.0; 4001];
            x[2000] = 1.0;
            filter.filter(&mut x);
            let power: f64 = x.iter().map(|x| x * x).sum();
            assert!((filter.noise() / power - 1.0).abs() < 1e-6, "{order}: {} and {power}", filter.noise());
        }
    }

    #[test]
    fn lines_pass_unchanged() {
        let filter = LowPass::new(4, 2.0, 100.0).expect("an order and a cut-off");
        let line = |k: usize| 3.0 - 0.02 * k as f64;
        let mut x: Vec<f64> = (0..600).map(line).collect();
        filter.filter(&mut x);
        let error = |rows: core::ops::Range<usize>| rows.map(|k| (x[k] - line(k)).abs()).fold(0.0, f64::max);
        assert!(error(200..400) < 1e-6 && error(0..600) < 1e-3, "{:e} {:e}", error(200..400), error(0..600));
    }

    #[test]
    fn wrong_options_are_named() {
        for (order, cutoff) in [(3, 5.0), (0, 5.0), (4, 50.0), (4, 0.0), (4, f64::NAN)] {
            let error = LowPass::new(order, cutoff, 100.0).expect_err("wrong").to_string();
            assert!(error.contains("expected"), "{error}");
        }
    }
}
