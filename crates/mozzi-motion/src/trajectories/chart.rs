//! Polynomials between two states on any configuration space: θ = θ₀ ⊕ u, where u is one of the n numbers of a vector
//! space. On a flat space ⊕ is +, and u is θ − θ₀.
//!
//! ⊕ and ⊖ of second-order dual numbers give the rates: θ̇ and θ̈ of θ(t) are the first and second derivatives of
//! θ(t + τ) ⊖ θ(t) with respect to τ, exactly.

use super::path::Point;
use mozzi::ConfigurationSpace;
use mozzi::scalar::Dual;

/// θ, θ̇ and, if known, θ̈ at an end of a piece.
pub(super) struct State<'a> {
    pub theta: &'a [f64],
    pub rate: &'a [f64],
    pub second: Option<&'a [f64]>,
}

/// θ, θ̇ and θ̈ at the time x of a piece from 0 to h that meets both ends: u is a quintic if both θ̈ are known, else
/// a cubic.
pub(super) fn between(space: &ConfigurationSpace, h: f64, x: f64, [from, to]: [State; 2]) -> Point {
    let n = from.rate.len();
    let still = vec![0.0; n];
    let [way, rate, bend] = seen_from(space, from.theta, to.theta, [to.rate, to.second.unwrap_or(&still)]);
    let ends = from.second.zip(to.second);
    let [mut u, mut du, mut ddu] = [(); 3].map(|()| vec![0.0; n]);
    for j in 0..n {
        let second = ends.map(|(first, _)| [first[j], bend[j]]);
        [u[j], du[j], ddu[j]] = hermite(h, x, [[0.0, from.rate[j]], [way[j], rate[j]]], second);
    }
    moved(space, from.theta, [&u, &du, &ddu])
}

/// θ, θ̇ and θ̈ of θ₀ ⊕ u, from u, u̇ and ü.
fn moved(space: &ConfigurationSpace, from: &[f64], [u, du, ddu]: [&[f64]; 3]) -> Point {
    if space.is_flat() {
        let theta = from.iter().zip(u).map(|(a, u)| a + u).collect();
        return Point { theta, slope: du.to_vec(), curvature: ddu.to_vec() };
    }
    let mut along = constants(from);
    space.advance(&mut along, &curve([u, du, ddu]), constant(1.0));
    let theta: Vec<f64> = along.iter().map(|x| x.value.value).collect();
    let [_, slope, curvature] = difference(space, &theta, &along, u.len());
    Point { theta, slope, curvature }
}

/// u, u̇ and ü of u = θ₁ ⊖ θ₀, where θ₁ moves with θ̇ and θ̈.
fn seen_from(space: &ConfigurationSpace, from: &[f64], to: &[f64], [rate, second]: [&[f64]; 2]) -> [Vec<f64>; 3] {
    if space.is_flat() {
        return [to.iter().zip(from).map(|(b, a)| b - a).collect(), rate.to_vec(), second.to_vec()];
    }
    let mut along = constants(to);
    space.advance(&mut along, &curve([&vec![0.0; rate.len()], rate, second]), constant(1.0));
    difference(space, from, &along, rate.len())
}

/// Value, first and second derivative with respect to τ: terms of 1, of ε₁ (and ε₂), and of ε₁ε₂ at τ = ε₁ + ε₂.
type Second = Dual<Dual>;

fn constant(x: f64) -> Second {
    Dual::constant(Dual::constant(x))
}

fn constants(list: &[f64]) -> Vec<Second> {
    list.iter().map(|&x| constant(x)).collect()
}

/// y + ẏτ + ½ÿτ².
fn curve([y, dy, ddy]: [&[f64]; 3]) -> Vec<Second> {
    let at = |j: usize| Dual {
        value: Dual { value: y[j], derivative: dy[j] },
        derivative: Dual { value: dy[j], derivative: ddy[j] },
    };
    (0..y.len()).map(at).collect()
}

/// θ(τ) ⊖ θ₀ with its derivatives.
fn difference(space: &ConfigurationSpace, from: &[f64], along: &[Second], n: usize) -> [Vec<f64>; 3] {
    let mut way = constants(&vec![0.0; n]);
    space.difference(&constants(from), along, &mut way);
    let part = |pick: fn(&Second) -> f64| way.iter().map(pick).collect();
    [part(|x| x.value.value), part(|x| x.derivative.value), part(|x| x.derivative.derivative)]
}

/// y, y′ and y″ at x of the polynomial on [0, h] that has these values and slopes at its ends, and these second
/// derivatives.
fn hermite(h: f64, x: f64, [[y0, v0], [y1, v1]]: [[f64; 2]; 2], second: Option<[f64; 2]>) -> [f64; 3] {
    let rest = y1 - y0 - v0 * h;
    let c = match second {
        None => {
            let (p, q) = (rest / (h * h), (v1 - v0) / h);
            [3.0 * p - q, (q - 2.0 * p) / h, 0.0, 0.0]
        }
        Some([a0, a1]) => {
            let p = (rest - 0.5 * a0 * h * h) / (h * h * h);
            let q = (v1 - v0 - a0 * h) / (h * h);
            let r = (a1 - a0) / h;
            [
                0.5 * a0,
                10.0 * p - 4.0 * q + 0.5 * r,
                (-15.0 * p + 7.0 * q - r) / h,
                (6.0 * p - 3.0 * q + 0.5 * r) / (h * h),
            ]
        }
    };
    let [a, b, c, d] = c;
    [
        y0 + x * (v0 + x * (a + x * (b + x * (c + x * d)))),
        v0 + x * (2.0 * a + x * (3.0 * b + x * (4.0 * c + x * 5.0 * d))),
        2.0 * a + x * (6.0 * b + x * (12.0 * c + x * 20.0 * d)),
    ]
}
