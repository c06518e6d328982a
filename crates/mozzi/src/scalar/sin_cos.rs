//! Sine and cosine together: reduction by π/2 in three parts (Cody and Waite), then polynomials on ±π/4.
//!
//! The polynomials interpolate (sin r − r)/r³ and (cos r − 1 + r²/2)/r⁴ in z = r² at Chebyshev points. No branch, so
//! that lanes can follow the same text. The tests bound the error: 1 ulp in `f64` up to |x| = 10⁶;
//! 1.5 ulp in `f32` up to 8192, values below 10⁻³ (close to a zero of the function) held to 10⁻³'s ulp.

use alloc::vec::Vec;

/// The numbers of the sine and cosine that `f64` or `f32` have here, for other ways to compute the same: on r = x − k π/2, |r| ≤ π/4,
/// with z = r²,
///
/// > sin r = r + r³ s(z), cos r = 1 − z/2 + z² c(z)
#[derive(Clone, Debug, PartialEq)]
pub struct SinCos {
    /// The reduction is exact to rounding up to this |x|.
    pub largest: f64,
    /// Adding and subtracting it rounds to the nearest integer, k, of which the lowest bits are the sum's.
    pub round: f64,
    /// The coefficients of s, highest first.
    pub sin: Vec<f64>,
    /// The coefficients of c, highest first.
    pub cos: Vec<f64>,
}

impl SinCos {
    /// Of `f64`.
    pub fn of_f64() -> Self {
        self::f64::numbers()
    }

    /// Of `f32`; each is one.
    pub fn of_f32() -> Self {
        self::f32::numbers()
    }
}

macro_rules! sin_cos {
    ($f:ident, $largest:expr, $round:expr, $half_pi:expr, $sin:expr, $cos:expr) => {
        pub mod $f {
            /// The reduction is exact to rounding up to here.
            pub const LARGEST: $f = $largest;
            /// Adding and subtracting this rounds to the nearest integer.
            const ROUND: $f = $round;
            /// π/2 as a sum; the leading parts have so many trailing zeros that their products with k are exact.
            const HALF_PI: [$f; 3] = $half_pi;
            /// ±1/(2k + 1)! from the highest k down to 1.
            const SIN: &[$f] = &$sin;
            /// ±1/(2k)! from the highest k down to 2.
            const COS: &[$f] = &$cos;

            pub fn numbers() -> super::SinCos {
                let list = |coefficients: &[$f]| coefficients.iter().map(|&x| x.into()).collect();
                super::SinCos { largest: LARGEST.into(), round: ROUND.into(), sin: list(SIN), cos: list(COS) }
            }

            #[inline(always)]
            pub fn sin_cos(x: $f, mul_add: impl Fn($f, $f, $f) -> $f) -> ($f, $f) {
                let shifted = x * core::$f::consts::FRAC_2_PI + ROUND;
                let k = shifted - ROUND; // x = k π/2 + r
                let quadrant = shifted.to_bits();
                let [p0, p1, p2] = HALF_PI;
                let (t, w) = (x - k * p0, k * p1); // both exact
                let hi = t - w;
                let lo = k * p2 - ((t - hi) - w);
                let r = hi - lo;
                let tail = (hi - r) - lo; // what the rounding of r lost
                let z = r * r;
                let (mut s, mut c) = (SIN[0], COS[0]);
                let mut i = 1;
                while i < SIN.len() {
                    s = mul_add(s, z, SIN[i]);
                    i += 1;
                }
                let mut i = 1;
                while i < COS.len() {
                    c = mul_add(c, z, COS[i]);
                    i += 1;
                }
                // sin(r + tail) = r + (tail + r³ s(z)); cos(r + tail) = 1 − z/2 + (z² c(z) − r tail), 1 − z/2 compensated
                let sin = r + mul_add(r * z, s, tail * (1.0 - 0.5 * z));
                let half = 0.5 * z;
                let one = 1.0 - half;
                let cos = one + (((1.0 - one) - half) + mul_add(z * z, c, -(r * tail)));
                // exchange in odd quadrants, then the signs, on the bits
                let (s, c) = (sin.to_bits(), cos.to_bits());
                let exchange = (s ^ c) & (quadrant & 1).wrapping_neg();
                let sign = |q| (q & 2) << (8 * size_of::<$f>() - 2);
                let negative = sign(quadrant.wrapping_add(1));
                ($f::from_bits(s ^ exchange ^ sign(quadrant)), $f::from_bits(c ^ exchange ^ negative))
            }
        }
    };
}

sin_cos!(
    f64,
    1.0e6,
    6755399441055744.0, // 1.5 · 2⁵²
    [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21],
    [
        1.591810123027412e-10,
        -2.5051131455427946e-8,
        2.755731610068303e-6,
        -0.0001984126983675497,
        0.008333333333330946,
        -0.16666666666666666
    ],
    [
        -1.1382614868556325e-11,
        2.0876146024689747e-9,
        -2.7557317270560326e-7,
        2.4801587298763433e-5,
        -0.0013888888888887395,
        0.041666666666666664
    ]
);

sin_cos!(
    f32,
    8192.0,
    12582912.0, // 1.5 · 2²³
    [1.5703125, 0.0004837513, 7.54979e-8],
    [2.7249864e-6, -0.00019840086, 0.008333332, -0.16666667],
    [-2.7300908e-7, 2.48006e-5, -0.0013888888, 0.041666668]
);

#[cfg(test)]
mod tests {
    use super::super::Scalar;

    /// The unit of the last of `digits` binary places of x.
    fn ulp(x: f64, digits: i32) -> f64 {
        2.0_f64.powi(x.abs().log2().floor() as i32 - digits)
    }

    #[test]
    fn f64_is_within_an_ulp_of_the_standard_library() {
        // the standard library itself is within half an ulp and a little
        let mut worst: f64 = 0.0;
        for k in 0..400_000 {
            let t = k as f64 * 1e-5 - 2.0;
            for x in [t * 1.7, t * 103.3, t * 4.9e5, core::f64::consts::FRAC_PI_2 * k as f64] {
                let (s, c) = x.sin_cos();
                let (a, b) = Scalar::sin_cos(x);
                for (x, reference) in [(a, s), (b, c)] {
                    worst = if x == reference { worst } else { worst.max((x - reference).abs() / ulp(reference, 52)) };
                }
            }
        }
        assert!(worst <= 1.0, "{worst} ulp");
    }

    #[test]
    fn f32_is_within_one_and_a_half_ulp_of_f64() {
        let near = |x: f32, reference: f64| (x as f64 - reference).abs() / ulp(reference.abs().max(1e-3), 23);
        let mut worst: f64 = 0.0;
        for k in 0..400_000 {
            let x = (k as f64 * 1e-5 - 2.0) as f32;
            for x in [x * 1.7, x * 103.3, x * 4000.0] {
                let (s, c) = (x as f64).sin_cos();
                let (a, b) = Scalar::sin_cos(x);
                worst = worst.max(near(a, s)).max(near(b, c));
            }
        }
        assert!(worst <= 1.5, "{worst} ulp");
    }

    #[test]
    fn beyond_the_range_and_not_finite() {
        assert_eq!(Scalar::sin_cos(1e22_f64), 1e22_f64.sin_cos());
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (s, c) = Scalar::sin_cos(x);
            assert!(s.is_nan() && c.is_nan());
        }
        assert_eq!(Scalar::sin_cos(0.0_f32), (0.0, 1.0));
    }
}
