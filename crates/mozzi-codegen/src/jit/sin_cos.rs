//! Sine and cosine as `mozzi` has them for floats ([`SinCos`]), reduced by fused products.

use super::instruction::{Operation::*, Value};
use super::lower::Builder;
use mozzi::scalar::SinCos;

/// π/2 as a sum, each part nearest to what those before it leave. Products that are rounded with a sum alone need no trailing zeros.
const HALF_PI: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591833e-33];
/// The same in `f32`.
const HALF_PI_F32: [f64; 3] = [1.5707963705062866, -4.371138828673793e-8, -1.7151245100059108e-15];

/// (sin x, cos x) for x up to the polynomials' largest argument.
pub(super) fn lower(b: &mut Builder, x: Value) -> (Value, Value) {
    let of = if b.is_f64 { SinCos::of_f64() } else { SinCos::of_f32() };
    let (two_over_pi, round) = (b.constant(std::f64::consts::FRAC_2_PI), b.constant(of.round));
    let shifted = b.apply(MulAdd, [x, two_over_pi, round]);
    let k = b.apply(Sub, [shifted, round]); // x = k π/2 + r
    // k p0 and x have their bits in the same places, so that the first difference is exact; r + tail = x − k π/2 to twice the digits
    let [p0, p1, p2] = if b.is_f64 { HALF_PI } else { HALF_PI_F32 }.map(|part| b.constant(part));
    let hi = b.apply(NegMulAdd, [k, p0, x]);
    let r = b.apply(NegMulAdd, [k, p1, hi]);
    let tail = b.apply(Sub, [hi, r]);
    let tail = b.apply(NegMulAdd, [k, p1, tail]);
    let tail = b.apply(NegMulAdd, [k, p2, tail]);
    let z = b.apply(Mul, [r, r]);
    let polynomial = |b: &mut Builder, coefficients: &[f64]| {
        let mut sum = b.constant(coefficients[0]);
        for &coefficient in &coefficients[1..] {
            let next = b.constant(coefficient);
            sum = b.apply(MulAdd, [sum, z, next]);
        }
        sum
    };
    let (s, c) = (polynomial(b, &of.sin), polynomial(b, &of.cos));
    // sin(r + tail) = r + (tail + r³ s(z)); cos(r + tail) = 1 − z/2 + (z² c(z) − r tail), 1 − z/2 compensated
    let (one, minus_half) = (b.constant(1.0), b.constant(-0.5));
    let rz = b.apply(Mul, [r, z]);
    let sin = b.apply(MulAdd, [rz, s, tail]);
    let sin = b.apply(Add, [r, sin]);
    let near = b.apply(MulAdd, [minus_half, z, one]);
    let rest = b.apply(Sub, [one, near]);
    let rest = b.apply(MulAdd, [minus_half, z, rest]);
    let rest = b.apply(NegMulAdd, [r, tail, rest]);
    let zz = b.apply(Mul, [z, z]);
    let cos = b.apply(MulAdd, [zz, c, rest]);
    let cos = b.apply(Add, [near, cos]);
    // exchange in odd quadrants, then the signs, on the bits
    let (zero, single, sign) = (b.bits(0), b.bits(1), b.sign_bit());
    let by = if b.is_f64 { 62 } else { 30 };
    let odd = b.apply(And, [shifted, single]);
    let odd = b.apply(SubBits, [zero, odd]);
    let exchange = b.apply(Xor, [sin, cos]);
    let exchange = b.apply(And, [exchange, odd]);
    let next = b.apply(AddBits, [shifted, single]);
    let signed = |b: &mut Builder, x: Value, quadrant: Value| {
        let high = b.apply(ShiftLeft(by), [quadrant]);
        let high = b.apply(And, [high, sign]);
        let x = b.apply(Xor, [x, exchange]);
        b.apply(Xor, [x, high])
    };
    (signed(b, sin, shifted), signed(b, cos, next))
}
