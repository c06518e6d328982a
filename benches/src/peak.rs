//! The machine's peak rate of fused multiply-adds, measured with independent chains.

use std::time::Instant;

/// The instructions that a way of computing uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One number for each instruction.
    Scalar,
    /// Four: AVX2.
    Four,
    /// Eight: AVX-512.
    Eight,
}

impl Width {
    pub const ALL: [Width; 3] = [Width::Scalar, Width::Four, Width::Eight];

    pub fn name(self) -> &'static str {
        match self {
            Width::Scalar => "one number",
            Width::Four => "4 numbers (AVX2)",
            Width::Eight => "8 numbers (AVX-512)",
        }
    }
}

/// Floating-point operations per nanosecond, a fused multiply-add counts as two; none if the processor lacks the
/// instructions.
pub fn measure(width: Width) -> Option<f64> {
    #[cfg(target_arch = "x86_64")]
    {
        let has_fma = std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma");
        let (run, lanes): (unsafe fn(usize) -> f64, usize) = match width {
            Width::Scalar if has_fma => (x86::one, 1),
            Width::Four if has_fma => (x86::four, 4),
            Width::Eight if std::is_x86_feature_detected!("avx512f") => (x86::eight, 8),
            _ => return None,
        };
        let times = (0..500).map(|_| {
            let start = Instant::now();
            // SAFETY: the check above shows that the processor has the instructions.
            std::hint::black_box(unsafe { run(x86::ROUNDS) });
            start.elapsed().as_secs_f64() * 1e9
        });
        let least = times.fold(f64::INFINITY, f64::min);
        Some((2 * lanes * x86::CHAINS * x86::ROUNDS) as f64 / least)
    }
    #[cfg(not(target_arch = "x86_64"))]
    None
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use core::arch::x86_64::{
        _mm_cvtsd_f64, _mm_fmadd_pd, _mm_set1_pd, _mm256_cvtsd_f64, _mm256_fmadd_pd, _mm256_set1_pd, _mm512_cvtsd_f64,
        _mm512_fmadd_pd, _mm512_set1_pd,
    };

    /// Ten chains saturate two units of latency 4 or 5.
    pub const CHAINS: usize = 12;
    pub const ROUNDS: usize = 20_000;

    /// x ↦ a·x + b in 12 chains, with values unknown to the compiler.
    macro_rules! chains {
        ($name:ident, $features:literal, $set:ident, $fmadd:ident, $get:ident) => {
            #[target_feature(enable = $features)]
            pub fn $name(rounds: usize) -> f64 {
                let [a, b] = std::hint::black_box([0.999, 0.001]).map(|x| $set(x));
                let mut x: [_; CHAINS] = std::array::from_fn(|k| $set(k as f64));
                for _ in 0..rounds {
                    for k in 0..CHAINS {
                        x[k] = $fmadd(x[k], a, b);
                    }
                }
                x.into_iter().map(|x| $get(x)).sum()
            }
        };
    }
    // Pairs take as long as single numbers, but a compiler would merge single numbers into groups of four.
    chains!(one, "avx2,fma", _mm_set1_pd, _mm_fmadd_pd, _mm_cvtsd_f64);
    chains!(four, "avx2,fma", _mm256_set1_pd, _mm256_fmadd_pd, _mm256_cvtsd_f64);
    chains!(eight, "avx512f", _mm512_set1_pd, _mm512_fmadd_pd, _mm512_cvtsd_f64);
}
