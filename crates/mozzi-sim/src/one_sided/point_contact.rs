//! One point contact, solved exactly.

use super::law::norm;
use nalgebra::Matrix3;

/// The impulse (n, t₁, t₂) that satisfies Coulomb's law for u = G p + c. Several may; the order is take-off, sticking,
/// sliding.
///
/// Sliding: with the normal row eliminated, p_t(λ) = −(Ĝ + λ1)⁻¹ĉ is opposite to the slip λp_t, and λ > 0 is the zero
/// of ‖p_t‖ − μ p_n, found by Newton's method within a bracket.
pub(super) fn point_contact(G: &Matrix3<f64>, c: [f64; 3], mu: f64) -> [f64; 3] {
    let [c_n, c_1, c_2] = c;
    let g_nn = G[(0, 0)];
    if c_n >= 0.0 || g_nn <= 0.0 {
        return [0.0; 3];
    }
    if mu == 0.0 {
        return [-c_n / g_nn, 0.0, 0.0];
    }
    let (g_1, g_2) = (G[(0, 1)], G[(0, 2)]);
    let a_11 = G[(1, 1)] - g_1 * g_1 / g_nn;
    let a_12 = G[(1, 2)] - g_1 * g_2 / g_nn;
    let a_22 = G[(2, 2)] - g_2 * g_2 / g_nn;
    let (c_1, c_2) = (c_1 - g_1 * c_n / g_nn, c_2 - g_2 * c_n / g_nn);
    let solve = |x: f64, y: f64, r_1: f64, r_2: f64| {
        let d = x * y - a_12 * a_12;
        (-(y * r_1 - a_12 * r_2) / d, -(x * r_2 - a_12 * r_1) / d)
    };
    let at = |lambda: f64| {
        let (t_1, t_2) = solve(a_11 + lambda, a_22 + lambda, c_1, c_2);
        [-(c_n + g_1 * t_1 + g_2 * t_2) / g_nn, t_1, t_2]
    };
    let trace = a_11 + a_22;
    if a_11 * a_22 - a_12 * a_12 > 1e-14 * trace * trace {
        let p = at(0.0);
        if p[0] >= 0.0 && norm(p[1], p[2]) <= mu * p[0] {
            return p;
        }
    }
    let (mut low, mut high) = (0.0, trace.max(f64::MIN_POSITIVE));
    for _ in 0..200 {
        let p = at(high);
        if norm(p[1], p[2]) <= mu * p[0] {
            break;
        }
        (low, high) = (high, 4.0 * high);
    }
    let mut lambda = 0.5 * (low + high);
    for _ in 0..60 {
        let [p_n, t_1, t_2] = at(lambda);
        let size = norm(t_1, t_2);
        let excess = size - mu * p_n;
        *(if excess > 0.0 { &mut low } else { &mut high }) = lambda;
        let (d_1, d_2) = solve(a_11 + lambda, a_22 + lambda, t_1, t_2);
        let slope = (t_1 * d_1 + t_2 * d_2) / size + mu * (g_1 * d_1 + g_2 * d_2) / g_nn;
        let newton = lambda - excess / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let is_close = (next - lambda).abs() <= 1e-15 * lambda || high - low <= 1e-15 * high;
        lambda = next;
        if is_close {
            break;
        }
    }
    let [p_n, t_1, t_2] = at(lambda);
    let size = norm(t_1, t_2);
    let scale = if size > 0.0 { mu * p_n / size } else { 0.0 };
    [p_n, scale * t_1, scale * t_2]
}
