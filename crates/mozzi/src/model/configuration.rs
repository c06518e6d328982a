//! Positions as points of a manifold: integration, differences, and neutral configurations.

use super::{Freedom, Model, Place};
use crate::lie::{SE3, SO3, series};
use crate::linalg::Vec3;
use crate::scalar::{Dual, Real, Scalar};
use crate::spatial::Twist;
use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

/// The configuration manifold: lines and angles, SO(3) for balls, SE(3) for a floating base and free joints, each with
/// its indices in θ and θ̇.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigurationSpace(pub(crate) Arc<[Place]>);

impl<C: Scalar> Model<C> {
    /// The space of the robot's configurations.
    pub fn configuration_space(&self) -> &ConfigurationSpace {
        &self.structure.space
    }

    /// The positions at which every joint is at 0 and a floating base at {s}: nq numbers.
    pub fn neutral_configuration<S: Scalar>(&self) -> Vec<S> {
        let mut theta = vec![S::zero(); self.nq()];
        for place in &*self.structure.space.0 {
            if place.freedom != Freedom::One {
                theta[place.q] = S::one();
            }
        }
        theta
    }
}

impl ConfigurationSpace {
    /// A flat space of n numbers.
    pub fn of_numbers(n: usize) -> Self {
        ConfigurationSpace((0..n).map(|k| Place { freedom: Freedom::One, q: k, j: k }).collect())
    }

    /// A floating base's place, then each independent joint's.
    pub fn places(&self) -> &[Place] {
        &self.0
    }

    /// Whether the space is flat, so that ⊕ is +.
    pub fn is_flat(&self) -> bool {
        self.0.iter().all(|place| place.freedom == Freedom::One)
    }

    /// θ ← θ ⊕ θ̇h: see [`integrate`].
    ///
    /// # Panics
    /// When θ or θ̇ is too short.
    pub fn advance<S: Real>(&self, theta: &mut [S], dtheta: &[S], h: S) {
        for &Place { freedom, q, j } in &*self.0 {
            match (freedom, &mut theta[q..], &dtheta[j..]) {
                (Freedom::One, [q, ..], [dq, ..]) => *q += *dq * h,
                (Freedom::Ball, [w, x, y, z, ..], &[a, b, c, ..]) => {
                    let turn = turned([*w, *x, *y, *z], Vec3([a, b, c]) * h);
                    [*w, *x, *y, *z] = turn;
                }
                (_, theta, V) => {
                    let (Some(pose), Some(&V)) = (theta.first_chunk_mut(), V.first_chunk()) else {
                        panic!("theta or dtheta is too short");
                    };
                    *pose = moved(*pose, Twist::from_array(V) * h);
                }
            }
        }
    }

    /// θ₁ ⊖ θ₀: see [`difference`].
    ///
    /// # Panics
    /// When a slice is too short.
    pub fn difference<S: Real>(&self, theta0: &[S], theta1: &[S], difference: &mut [S]) {
        for place in &*self.0 {
            let (from, to, way) =
                (&theta0[place.positions()], &theta1[place.positions()], &mut difference[place.velocities()]);
            let turn = |q: &[S]| SO3::from_quaternion(q[0], Vec3([q[1], q[2], q[3]]));
            match place.freedom {
                Freedom::One => way[0] = to[0] - from[0],
                Freedom::Ball => way.copy_from_slice(&(turn(from).inverse() * turn(to)).log().0),
                Freedom::Free => {
                    let pose = |q: &[S]| SE3::from_pose(core::array::from_fn(|k| q[k]));
                    way.copy_from_slice(&(pose(from).inverse() * pose(to)).log().to_array());
                }
            }
        }
    }

    /// u̇ for θ = θ₀ ⊕ u moving with θ̇: θ̇ itself for lines, [`rate_of_logarithm`] for a twist.
    ///
    /// # Panics
    /// When a slice is too short.
    pub fn rate<S: Real>(&self, u: &[S], dtheta: &mut [S]) {
        for place in self.0.iter().filter(|place| place.freedom != Freedom::One) {
            let (V, u) = (&mut dtheta[place.velocities()], &u[place.velocities()]);
            let twist = |x: &[S]| Twist::from_array(core::array::from_fn(|k| x.get(k).copied().unwrap_or(S::zero())));
            let rate = rate_of_logarithm(twist(u), twist(V)).to_array();
            V.copy_from_slice(&rate[..V.len()]);
        }
    }
}

/// θ ← θ ⊕ θ̇h: the positions after constant velocities θ̇ for the time h. θ + θ̇h for joints of one axis, R e^{`[ω]`h}
/// for a ball, T e^{`[𝒱]`h} for a floating base and a free joint. Resulting quaternions are unit, with the sign closer
/// to the given one.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ not n.
pub fn integrate<S: Real, C: Scalar>(model: &Model<C>, theta: &mut [S], dtheta: &[S], h: S) {
    model.assert_lengths(theta.len(), [dtheta.len()]);
    model.configuration_space().advance(theta, dtheta, h);
}

/// θ₁ ⊖ θ₀, n numbers: the constant velocities from θ₀ to θ₁ in one second. θ₁ − θ₀ for joints of one axis, log(R₀⁻¹R₁)
/// for a ball, log(T₀⁻¹T₁) for a floating base and a free joint, by the shorter rotation.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ₀ or θ₁ is not nq long, or `difference` not n.
pub fn difference<S: Real, C: Scalar>(model: &Model<C>, theta0: &[S], theta1: &[S], difference: &mut [S]) {
    model.assert_lengths(theta0.len(), [difference.len()]);
    model.assert_lengths(theta1.len(), []);
    model.configuration_space().difference(theta0, theta1, difference);
}

/// θ ⊕ δθ ε: the positions as dual numbers with the direction δθ, n numbers like velocities. Results computed from them
/// have their derivative in this direction. With θ of [`Dual`]s, which have another direction, second derivatives
/// result.
///
/// # Panics
/// When θ is not nq long, or δθ not n.
pub fn seed_direction<S: Real, C: Scalar>(model: &Model<C>, theta: &[S], along: &[S]) -> Vec<Dual<S>> {
    let mut theta = Dual::constants(theta);
    integrate(model, &mut theta, &Dual::constants(along), Dual { value: S::zero(), derivative: S::one() });
    theta
}

/// T e^{`[ξ]`}, by quaternions, without sign jumps or accumulated rounding.
fn moved<S: Real>([w, x, y, z, px, py, pz]: [S; 7], xi: Twist<S>) -> [S; 7] {
    let R = SO3::from_quaternion(w, Vec3([x, y, z]));
    let [px, py, pz] = (Vec3([px, py, pz]) + R * (SO3::left_jacobian(xi.w) * xi.v)).0;
    let [w, x, y, z] = turned([w, x, y, z], xi.w);
    [w, x, y, z, px, py, pz]
}

/// R e^{`[ω]`}.
fn turned<S: Real>([w, x, y, z]: [S; 4], omega: Vec3<S>) -> [S; 4] {
    let (v, half) = (Vec3([x, y, z]), omega * S::from_f64(0.5));
    let square = half.dot(half);
    let (s, turn) = (S::one() - square * series::cosc(square), half * series::sinc(square)); // of e^[ω]
    let (s, v) = (w * s - v.dot(turn), turn * w + v * s + v.cross(turn));
    let one_over = S::one() / (s * s + v.dot(v)).sqrt();
    let [x, y, z] = (v * one_over).0;
    [s * one_over, x, y, z]
}

/// u̇ for T = T₀ e^{`[u]`} moving with the body twist 𝒱: 𝒱 + ½`[ad_u]`𝒱 + ¹⁄₁₂`[ad_u]`²𝒱, to third order in u,
/// sufficient for methods of order up to five (Munthe-Kaas 1999).
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
