//! Sine and cosine together: reduction by π/2 in three parts (Cody and Waite), then polynomials on ±π/4.
//!
//! The polynomials interpolate (sin r − r)/r³ and (cos r − 1 + r²/2)/r⁴ in z = r² at Chebyshev points. The same code
//! serves a number and a register of numbers: it has no branches, and handles the quadrants by bit operations. The
//! tests bound the error: 1 ulp in `f64` up to |x| = 10⁶; 1.5 ulp in `f32` up to 8192, where errors of values below
//! 10⁻³ (close to a zero of the function) are measured in ulps of 10⁻³.

use super::Scalar;

/// `f64` or `f32`, with the numbers of its [`sin_cos`].
pub trait Float: super::Real + Send + Sync + 'static {
    /// From 1 to the next number.
    const EPSILON: Self;
    /// [`sin_cos`] is exact to rounding up to this |x|.
    const LARGEST: Self;
    /// 1.5 · 2⁵² or 1.5 · 2²³: adding and subtracting it rounds to the nearest integer.
    const ROUND: Self;
    /// 2/π.
    const TWO_OVER_PI: Self;
    /// π/2 as a sum; the leading parts have enough trailing zeros that their products with k are exact.
    const HALF_PI: [Self; 3];
    /// ±1/(2k + 1)! from the highest k down to 1.
    const SIN: &[Self];
    /// ±1/(2k)! from the highest k down to 2.
    const COS: &[Self];
}

/// Operations that [`sin_cos`] needs beyond arithmetic, on a number or a register of numbers: constants and bit
/// operations.
#[doc(hidden)]
pub trait Bits: Scalar {
    /// The type of the numbers in a register.
    type Number: Float;

    /// A constant.
    fn constant(x: Self::Number) -> Self;
    /// Bitwise exclusive or.
    fn xor(self, other: Self) -> Self;
    /// Bitwise and.
    fn and(self, other: Self) -> Self;
    /// All bits if the lowest is set, else none.
    fn lowest_everywhere(self) -> Self;
    /// The sign bit if the second lowest is set, else none.
    fn second_lowest_as_sign(self) -> Self;
}

/// (sin x, cos x) for |x| ≤ [`Float::LARGEST`]; NaN for NaN and ±∞; beyond, the caller reduces x first.
#[inline(always)]
pub fn sin_cos<S: Bits>(x: S) -> (S, S) {
    let constant = S::constant;
    let [p0, p1, p2] = S::Number::HALF_PI.map(constant);
    let (minus_half, one, minus_zero) = (S::from_f64(-0.5), S::one(), S::from_f64(-0.0));
    let quadrant = x.mul_add(constant(S::Number::TWO_OVER_PI), constant(S::Number::ROUND)); // k in the lowest bits
    let k = quadrant - constant(S::Number::ROUND); // x = k π/2 + r
    let (t, w) = ((-k).mul_add(p0, x), k * p1); // both exact
    let hi = t - w;
    let lo = k.mul_add(p2, w - (t - hi));
    let r = hi - lo;
    let tail = (hi - r) - lo; // the rounding error of r
    let z = r * r;
    let s = polynomial(S::Number::SIN, z);
    let c = polynomial(S::Number::COS, z);
    // sin(r + tail) = r + (tail + r³ s(z)); cos(r + tail) = 1 − z/2 + (z² c(z) − r tail), 1 − z/2 compensated
    let near_one = minus_half.mul_add(z, one);
    let sin = r + (r * z).mul_add(s, tail * near_one);
    let cos = near_one + (minus_half.mul_add(z, one - near_one) + (z * z).mul_add(c, -(r * tail)));
    // exchange in odd quadrants; sin is negative in quadrants 2 and 3, cos in 1 and 2
    let odd = quadrant.lowest_everywhere();
    let (exchange, negative) = (sin.xor(cos).and(odd), quadrant.second_lowest_as_sign());
    (sin.xor(exchange).xor(negative), cos.xor(exchange).xor(negative).xor(odd.and(minus_zero)))
}

#[inline(always)]
fn polynomial<S: Bits>(coefficients: &[S::Number], z: S) -> S {
    let mut sum = S::constant(coefficients[0]);
    let mut i = 1;
    while i < coefficients.len() {
        sum = sum.mul_add(z, S::constant(coefficients[i]));
        i += 1;
    }
    sum
}

impl Float for f64 {
    const EPSILON: f64 = f64::EPSILON;
    const LARGEST: f64 = 1.0e6;
    const ROUND: f64 = 6755399441055744.0;
    const TWO_OVER_PI: f64 = core::f64::consts::FRAC_2_PI;
    const HALF_PI: [f64; 3] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21];
    const SIN: &[f64] = &[
        1.591810123027412e-10,
        -2.5051131455427946e-8,
        2.755731610068303e-6,
        -0.0001984126983675497,
        0.008333333333330946,
        -0.16666666666666666,
    ];
    const COS: &[f64] = &[
        -1.1382614868556325e-11,
        2.0876146024689747e-9,
        -2.7557317270560326e-7,
        2.4801587298763433e-5,
        -0.0013888888888887395,
        0.041666666666666664,
    ];
}

impl Float for f32 {
    const EPSILON: f32 = f32::EPSILON;
    const LARGEST: f32 = 8192.0;
    const ROUND: f32 = 12582912.0;
    const TWO_OVER_PI: f32 = core::f32::consts::FRAC_2_PI;
    const HALF_PI: [f32; 3] = [1.5703125, 0.0004837513, 7.54979e-8];
    const SIN: &[f32] = &[2.7249864e-6, -0.00019840086, 0.008333332, -0.16666667];
    const COS: &[f32] = &[-2.7300908e-7, 2.48006e-5, -0.0013888888, 0.041666668];
}

macro_rules! bits {
    ($($f:ident),*) => { $(impl Bits for $f {
        type Number = $f;
        #[inline(always)]
        fn constant(x: $f) -> Self { x }
        #[inline(always)]
        fn xor(self, other: Self) -> Self { $f::from_bits(self.to_bits() ^ other.to_bits()) }
        #[inline(always)]
        fn and(self, other: Self) -> Self { $f::from_bits(self.to_bits() & other.to_bits()) }
        #[inline(always)]
        fn lowest_everywhere(self) -> Self { $f::from_bits((self.to_bits() & 1).wrapping_neg()) }
        #[inline(always)]
        fn second_lowest_as_sign(self) -> Self { $f::from_bits((self.to_bits() & 2) << (8 * size_of::<$f>() - 2)) }
    })* };
}
bits!(f64, f32);

#[cfg(test)]
mod tests {
    use super::super::Scalar;

    /// The unit of the last of `digits` binary places of x.
    fn ulp(x: f64, digits: i32) -> f64 {
        2.0_f64.powi(x.abs().log2().floor() as i32 - digits)
    }

    #[test]
    fn f64_is_within_an_ulp_of_the_standard_library() {
        // the standard library's own error is at most slightly above half an ulp
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
