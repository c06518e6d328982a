//! Power spectra, for the choice of a cut-off and for the judgement of residuals.

use core::f64::consts::PI;

/// A one-sided power spectrum at frequencies 0, Δ, 2Δ, …
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// Δ, Hz.
    pub step: f64,
    /// Power in each band of width Δ, in the signal's unit squared.
    pub power: Vec<f64>,
}

impl Spectrum {
    /// The spectrum of a signal sampled at `rate`, Hz, without its mean, through Hann's window.
    pub fn new(x: &[f64], rate: f64) -> Self {
        let N = x.len();
        let mean = x.iter().sum::<f64>() / N.max(1) as f64;
        let length = N.max(2).next_power_of_two();
        let mut z = vec![[0.0; 2]; length];
        let mut weight = 0.0;
        for (k, x) in x.iter().enumerate() {
            let w = (PI * (k as f64 + 0.5) / N as f64).sin().powi(2);
            z[k][0] = w * (x - mean);
            weight += w * w;
        }
        transform(&mut z);
        let scale = 2.0 / (weight.max(f64::MIN_POSITIVE) * length as f64);
        let power = z[..length / 2].iter().map(|[re, im]| scale * (re * re + im * im)).collect();
        Spectrum { step: rate / length as f64, power }
    }

    /// The frequency below which this share of the power lies, Hz.
    pub fn band(&self, share: f64) -> f64 {
        let total: f64 = self.power.iter().sum();
        let mut sum = 0.0;
        for (k, power) in self.power.iter().enumerate() {
            sum += power;
            if sum >= share * total {
                return k as f64 * self.step;
            }
        }
        self.power.len() as f64 * self.step
    }

    /// The frequency of the largest power, Hz, and its share of the power.
    pub fn peak(&self) -> (f64, f64) {
        let total: f64 = self.power.iter().sum();
        let (k, most) =
            self.power.iter().enumerate().fold((0, 0.0), |(i, a), (k, &b)| if b > a { (k, b) } else { (i, a) });
        (k as f64 * self.step, if total > 0.0 { most / total } else { 0.0 })
    }
}

/// The discrete Fourier transform of 2ᵐ complex numbers in place (Cooley and Tukey 1965).
fn transform(z: &mut [[f64; 2]]) {
    let N = z.len();
    let bits = N.trailing_zeros();
    for k in 0..N {
        let reversed = k.reverse_bits() >> (usize::BITS - bits);
        if k < reversed {
            z.swap(k, reversed);
        }
    }
    let mut half = 1;
    let mut turns = Vec::with_capacity(N / 2);
    while half < N {
        turns.clear();
        turns.extend((0..half).map(|k| (-PI * k as f64 / half as f64).sin_cos()));
        // block by block, in the order of memory
        for block in z.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((low, high), &(s, c)) in low.iter_mut().zip(high).zip(&turns) {
                let ([a, b], [x, y]) = (*low, *high);
                let (x, y) = (c * x - s * y, s * x + c * y);
                *low = [a + x, b + y];
                *high = [a - x, b - y];
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum_of_its_definition() {
        let mut random = mozzi::random::Random(3);
        let z: Vec<[f64; 2]> = (0..64).map(|_| random.array()).collect();
        let mut fast = z.clone();
        transform(&mut fast);
        for (k, found) in fast.iter().enumerate() {
            let sum = z.iter().enumerate().fold([0.0, 0.0], |[a, b], (i, [x, y])| {
                let (s, c) = (-2.0 * PI * (i * k) as f64 / 64.0).sin_cos();
                [a + c * x - s * y, b + s * x + c * y]
            });
            assert!((0..2).all(|i| (found[i] - sum[i]).abs() < 1e-12), "{k}");
        }
    }

    #[test]
    fn a_sine_has_its_frequency_and_its_power() {
        let x: Vec<f64> = (0..3000).map(|k| 5.0 + 2.0 * (2.0 * PI * 3.0 * k as f64 / 100.0).sin()).collect();
        let spectrum = Spectrum::new(&x, 100.0);
        assert!((spectrum.peak().0 - 3.0).abs() < 2.0 * spectrum.step);
        assert!((spectrum.power.iter().sum::<f64>() - 2.0).abs() < 1e-3); // A²/2
        assert!((spectrum.band(0.99) - 3.0).abs() < 0.2, "{}", spectrum.band(0.99));
    }
}
