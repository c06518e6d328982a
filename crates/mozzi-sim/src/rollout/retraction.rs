//! The transposed derivatives of ⊕ and of the rate of the logarithm.
//!
//! A change of a configuration is a body twist δ in its own coordinates, T e^{`[δ]`}. Moved along, it is
//!
//! > T e^{`[δ]`} e^{`[u]`} = T e^{`[u]`} e^{`[Ad_e^{−u}]`δ},  T e^{`[u + δu]`} = T e^{`[u]`} e^{`[J_r(u) δu]`},
//! > J_r(u) = Σ (−`[ad_u]`)ʲ/(j+1)!
//!
//! to first order, with the right Jacobian J_r of SE(3). A cotangent 𝓕 at T e^{`[u]`} has therefore the cotangents
//! `[Ad_e^{−u}]`ᵀ𝓕 at T and J_r(u)ᵀ𝓕 at u. A ball's twists have v = 0, so that its cotangents are moments.
//!
//! The rate ẇ = V + ½`[ad_u]`V + ¹⁄₁₂`[ad_u]`²V of a stage is linear in V, and with `[ad_δ]`V = −`[ad_V]`δ
//!
//! > ∂w/∂u = −½`[ad_V]` − ¹⁄₁₂(`[ad_W]` + `[ad_u]``[ad_V]`),  W = `[ad_u]`V

use mozzi::lie::SE3;
use mozzi::model::ConfigurationSpace;
use mozzi::model::{Freedom, Place};
use mozzi::scalar::Real;
use mozzi::spatial::{Twist, Wrench};

/// Replaces the cotangent of θ ⊕ u by that of θ, and writes that of u.
pub fn advance_vjp(space: &ConfigurationSpace, u: &[f64], theta_bar: &mut [f64], u_bar: &mut [f64]) {
    u_bar.copy_from_slice(theta_bar);
    for place in curved(space) {
        let (back, F) = (twist(place, u) * -1.0, wrench(place, theta_bar));
        write(place, SE3::exp(back).Ad().transpose() * F, theta_bar);
        write(place, series(back, F), u_bar);
    }
}

/// The cotangents of V and u from that of w, the [rate](ConfigurationSpace::rate) of u: `bar` is w's and becomes V's;
/// u's is written.
pub fn rate_vjp(space: &ConfigurationSpace, u: &[f64], V: &[f64], bar: &mut [f64], u_bar: &mut [f64]) {
    u_bar.fill(0.0);
    for place in curved(space) {
        let (u, V, F) = (twist(place, u), twist(place, V), wrench(place, bar));
        let once = u.ad().transpose() * F;
        let (twelfth, W) = (1.0 / 12.0, u.ad() * V);
        let by_u = V.ad().transpose() * F * -0.5 - (W.ad().transpose() * F + V.ad().transpose() * once) * twelfth;
        write(place, F + once * 0.5 + u.ad().transpose() * once * twelfth, bar);
        write(place, by_u, u_bar);
    }
}

/// Σ (`[ad_X]`ᵀ)ʲF/(j+1)!, to rounding. With φ(A) = Σ Aʲ/(j+1)!, φ(2A) = ½(e^A + 1)φ(A): rotations above 1 rad are
/// halved, so that no terms cancel. Dual numbers' derivatives converge, too.
pub fn series<S: Real>(X: Twist<S>, F: Wrench<S>) -> Wrench<S> {
    if X.w.dot(X.w) > S::one() {
        let half = S::from_f64(0.5);
        let once = series(X * half, F);
        return (SE3::exp(X * half).Ad().transpose() * once + once) * half;
    }
    let (mut sum, mut term) = (F, F);
    for j in 1..40 {
        term = X.ad().transpose() * term * S::from_f64(1.0 / (j as f64 + 1.0));
        let next = sum + term;
        if (next - sum).to_array().into_iter().all(S::is_identically_zero) {
            break;
        }
        sum = next;
    }
    sum
}

fn curved(space: &ConfigurationSpace) -> impl Iterator<Item = &Place> {
    space.places().iter().filter(|place| place.freedom != Freedom::One)
}

/// The entries of a place: a ball's are followed by zeros.
fn entries(place: &Place, x: &[f64]) -> [f64; 6] {
    let x = &x[place.velocities()];
    core::array::from_fn(|k| x.get(k).copied().unwrap_or(0.0))
}

fn twist(place: &Place, x: &[f64]) -> Twist {
    Twist::from_array(entries(place, x))
}

fn wrench(place: &Place, x: &[f64]) -> Wrench {
    Wrench::from_array(entries(place, x))
}

fn write(place: &Place, F: Wrench, x: &mut [f64]) {
    let x = &mut x[place.velocities()];
    x.copy_from_slice(&F.to_array()[..x.len()]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::Description;
    use mozzi::Dual;
    use mozzi::model::rate_of_logarithm;
    use mozzi::testing::{inertia, twist, wrench};

    fn along(X: Twist, by: Twist) -> Twist<Dual> {
        let (X, by) = (X.to_array(), by.to_array());
        Twist::from_array(core::array::from_fn(|k| Dual { value: X[k], derivative: by[k] }))
    }

    /// A body with a floating base alone.
    fn body() -> ConfigurationSpace {
        let body = Description::new("body").link("it", inertia(1)).floating().build().expect("sound");
        body.configuration_space().clone()
    }

    #[test]
    fn powers_are_kept() {
        // 𝓕ᵀ J δ by dual numbers is (Jᵀ𝓕)ᵀδ, for small and large rotations
        let (F, d, V) = (wrench(1), twist(2), twist(3));
        for size in [0.0, 1e-9, 0.1, 1.0, 4.0] {
            let u = twist(5) * size;
            let zero = Twist::zero();
            let (mut bar, mut u_bar) = (F.to_array(), [0.0; 6]);
            advance_vjp(&body(), &u.to_array(), &mut bar, &mut u_bar);
            let moved = |T0: Twist<Dual>, u: Twist<Dual>| {
                let back = SE3::exp(u.map(|x| Dual::constant(x.value))).inverse();
                (back * SE3::exp(T0) * SE3::exp(u)).log().map(|x| x.derivative)
            };
            let scale = 1e-14 * (1.0 + size * size) * F.norm();
            for (found, rate) in
                [(bar, moved(along(zero, d), along(u, zero))), (u_bar, moved(along(zero, zero), along(u, d)))]
            {
                let error = d.dot(Wrench::from_array(found)) - rate.dot(F);
                assert!(error.abs() < scale, "{size}: {error:e}");
            }
            let (mut bar, mut u_bar) = (F.to_array(), [0.0; 6]);
            rate_vjp(&body(), &u.to_array(), &V.to_array(), &mut bar, &mut u_bar);
            let rate = |u, V| rate_of_logarithm(u, V).map(|x: Dual| x.derivative);
            for (found, rate) in [(bar, rate(along(u, zero), along(V, d))), (u_bar, rate(along(u, d), along(V, zero)))]
            {
                let error = d.dot(Wrench::from_array(found)) - rate.dot(F);
                assert!(error.abs() < scale, "{size}: {error:e}");
            }
        }
    }
}
