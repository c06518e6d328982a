//! Positions as points of a manifold: how far, which way, and where from.

use crate::lie::{SE3, SO3, series};
use crate::linalg::Vec3;
use crate::model::{Base, Model};
use crate::scalar::{Dual, Real, Scalar};
use crate::spatial::Twist;
use alloc::vec;
use alloc::vec::Vec;

impl<C: Scalar> Model<C> {
    /// The positions at which every joint is at 0 and a floating base at {s}: nq numbers.
    pub fn neutral_configuration<S: Scalar>(&self) -> Vec<S> {
        let mut theta = vec![S::zero(); self.nq()];
        if self.is_floating() {
            theta[0] = S::one();
        }
        theta
    }
}

/// θ ← θ ⊕ θ̇h: where the velocities θ̇, kept for the time h, lead to. θ + θ̇h for joints, `T_sb` e^{`[𝒱_b]`h} for a floating base; its
/// quaternion leaves with length 1, and with the sign that is nearer to the one it came with.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ not n.
pub fn integrate<S: Real, C: Scalar>(model: &Model<C>, theta: &mut [S], dtheta: &[S], h: S) {
    model.assert_lengths(theta.len(), [dtheta.len()]);
    advance(model.base(), theta, dtheta, h);
}

/// θ₁ ⊖ θ₀, n numbers: the velocities that lead from θ₀ to θ₁ in one second. θ₁ − θ₀ for joints, log(T₀⁻¹T₁) for a floating base, by
/// the shorter way round.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ₀ or θ₁ is not nq long, or `difference` not n.
pub fn difference<S: Real, C: Scalar>(model: &Model<C>, theta0: &[S], theta1: &[S], difference: &mut [S]) {
    model.assert_lengths(theta0.len(), [difference.len()]);
    model.assert_lengths(theta1.len(), []);
    let (positions, velocities) = (model.base().positions(), model.base().velocities());
    if let (Some(&from), Some(&to), true) = (theta0.first_chunk(), theta1.first_chunk(), model.is_floating()) {
        let way = (SE3::from_pose(from).inverse() * SE3::from_pose(to)).log();
        difference[..6].copy_from_slice(&way.to_array());
    }
    for ((d, &q0), &q1) in difference[velocities..].iter_mut().zip(&theta0[positions..]).zip(&theta1[positions..]) {
        *d = q1 - q0;
    }
}

/// θ ⊕ δθ ε: the positions as dual numbers that move along δθ, n numbers as velocities are. What is computed of them has beside its
/// value its derivative in this direction. With θ of [`Dual`]s, and those of another direction, come second derivatives.
///
/// # Panics
/// When θ is not nq long, or δθ not n.
pub fn seed_direction<S: Real, C: Scalar>(model: &Model<C>, theta: &[S], along: &[S]) -> Vec<Dual<S>> {
    let mut theta = Dual::constants(theta);
    integrate(model, &mut theta, &Dual::constants(along), Dual { value: S::zero(), derivative: S::one() });
    theta
}

/// [`integrate`] by what of the model it needs.
pub(crate) fn advance<S: Real>(base: Base, theta: &mut [S], dtheta: &[S], h: S) {
    if let (Some(pose), Some(&V), Base::Floating) = (theta.first_chunk_mut(), dtheta.first_chunk(), base) {
        *pose = moved(*pose, Twist::from_array(V) * h);
    }
    for (q, &dq) in theta[base.positions()..].iter_mut().zip(&dtheta[base.velocities()..]) {
        *q += dq * h;
    }
}

/// T e^{`[ξ]`}, by quaternions, so that no sign jumps and no rounding adds up.
fn moved<S: Real>([w, x, y, z, px, py, pz]: [S; 7], xi: Twist<S>) -> [S; 7] {
    let v = Vec3([x, y, z]);
    let half = xi.w * S::from_f64(0.5);
    let square = half.dot(half);
    let (s, turn) = (S::one() - square * series::cosc(square), half * series::sinc(square)); // of e^[ω]
    let p = Vec3([px, py, pz]) + SO3::from_quaternion(w, v) * (SO3::left_jacobian(xi.w) * xi.v);
    let (s, v) = (w * s - v.dot(turn), turn * w + v * s + v.cross(turn));
    let one_over = S::one() / (s * s + v.dot(v)).sqrt();
    let ([x, y, z], [px, py, pz]) = ((v * one_over).0, p.0);
    [s * one_over, x, y, z, px, py, pz]
}

/// u̇ for T = T₀ e^{`[u]`} that moves with the body twist 𝒱: 𝒱 + ½`[ad_u]`𝒱 + ¹⁄₁₂`[ad_u]`²𝒱, to the third order in u, as a method of
/// order up to five needs it (Munthe-Kaas 1999).
pub fn rate_of_logarithm<S: Real>(u: Twist<S>, V: Twist<S>) -> Twist<S> {
    let once = u.ad() * V;
    V + once * S::from_f64(0.5) + u.ad() * once * S::from_f64(1.0 / 12.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, distance, floating_tree, state, twist};

    #[test]
    fn there_and_back() {
        let model = floating_tree(3, 6, 1);
        let [from, dtheta, _] = state(&model, 4);
        let mut to = from.clone();
        integrate(&model, &mut to, &dtheta, 0.5);
        let mut back = vec![0.0; model.n()];
        difference(&model, &from, &to, &mut back);
        assert!(back.iter().zip(&dtheta).all(|(b, d)| (b - 0.5 * d).abs() < 1e-14), "{back:?} {dtheta:?}");
        let pose = |theta: &[f64]| SE3::from_pose(*theta.first_chunk().expect("seven"));
        let V = Twist::from_array(*dtheta.first_chunk().expect("six"));
        assert!(distance(pose(&to), pose(&from) * SE3::exp(V * 0.5)) < 1e-15);
        assert!((to[..4].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15);
        // small steps do not turn the quaternion's sign
        let mut theta = model.neutral_configuration::<f64>();
        let spin = [&[0.0, 0.0, 1.0][..], &vec![0.0; model.n() - 3]].concat();
        for k in 1..=100 {
            integrate(&model, &mut theta, &spin, 0.1);
            assert!((theta[0] - (0.05 * k as f64).cos()).abs() < 1e-14);
        }
    }

    #[test]
    fn quaternions_of_any_length_are_rotations() {
        let mut random = Random(8);
        for _ in 0..20 {
            let T = SE3::exp(twist(random.0) * 3.0);
            let mut pose = T.to_pose();
            pose[..4].iter_mut().for_each(|q| *q *= -2.5);
            assert!(distance(SE3::from_pose(pose), T) < 1e-14);
            random.next();
        }
    }

    #[test]
    fn the_rate_of_the_logarithm_is_right_to_third_order() {
        let (u, V) = (twist(1), twist(2));
        let error = |size: f64| {
            // T₀ e^{[u]} moves with 𝒱: the logarithm's rate by differences
            let (u, e) = (u * size, 1e-5);
            let log = |t: f64| (SE3::exp(u) * SE3::exp(V * t)).log();
            ((log(e) - log(-e)) * (0.5 / e) - rate_of_logarithm(u, V)).norm()
        };
        assert!(error(0.05) < 1e-6 && error(0.4) / error(0.2) > 12.0, "{} {}", error(0.05), error(0.4) / error(0.2));
    }
}
