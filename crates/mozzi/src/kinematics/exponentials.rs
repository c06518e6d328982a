//! Products of exponentials of a serial chain from its lists (Modern Robotics, sections 4.1 and 5.1). The twists need
//! not be unit.

use crate::lie::SE3;
use crate::scalar::Real;
use crate::spatial::Twist;

/// T(θ) = e^{`[S_1]`θ₁} ⋯ e^{`[S_n]`θ_n} M (4.14): the end effector's pose, from its home M and the screws S in the
/// space frame. The shorter of the two lists determines n.
pub fn product_of_exponentials<S: Real>(M: SE3<S>, screws: &[Twist<S>], theta: &[S]) -> SE3<S> {
    screws.iter().zip(theta).rev().fold(M, |T, (&screw, &q)| SE3::exp(screw * q) * T)
}

/// T(θ) = M e^{`[B_1]`θ₁} ⋯ e^{`[B_n]`θ_n} (4.16), of the screws B in the end effector's frame.
pub fn body_product_of_exponentials<S: Real>(M: SE3<S>, screws: &[Twist<S>], theta: &[S]) -> SE3<S> {
    screws.iter().zip(theta).fold(M, |T, (&screw, &q)| T * SE3::exp(screw * q))
}

/// The space Jacobian of these screws, which its columns overwrite: J_i = Ad(e^{`[S_1]`θ₁} ⋯ e^{`[S_{i−1}]`θ_{i−1}})
/// S_i (5.11).
pub fn space_jacobian_of_screws<S: Real>(screws: &mut [Twist<S>], theta: &[S]) {
    let mut T = SE3::identity();
    for (column, &q) in screws.iter_mut().zip(theta) {
        let screw = *column;
        *column = T.Ad() * screw;
        T = T * SE3::exp(screw * q);
    }
}

/// The body Jacobian likewise: J_i = Ad(e^{−`[B_n]`θ_n} ⋯ e^{−`[B_{i+1}]`θ_{i+1}}) B_i (5.18).
pub fn body_jacobian_of_screws<S: Real>(screws: &mut [Twist<S>], theta: &[S]) {
    let mut T = SE3::identity();
    for (column, &q) in screws.iter_mut().zip(theta).rev() {
        let screw = *column;
        *column = T.Ad() * screw;
        T = T * SE3::exp(screw * -q);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Description, HomeFrames, Model, Screws};
    use crate::spatial::{ScrewAxis, SpatialInertia};
    use crate::testing::Random;

    #[test]
    fn a_chain_by_its_lists_is_the_chain_by_its_model() {
        let mut random = Random(11);
        let axes: Vec<ScrewAxis> =
            (0..5).map(|_| ScrewAxis::normalize(Twist::from_array(random.array())).expect("a screw").0).collect();
        let home: Vec<SE3> = (0..6).map(|_| SE3::exp(Twist::from_array(random.array()))).collect();
        let inertias = vec![SpatialInertia::point_mass(1.0, crate::Vec3([0.1, 0.2, 0.3])); 5];
        let (frames, screws) = (HomeFrames::Base(&home), Screws::Space(&axes));
        let model = Model::from_screws("chain", frames, &inertias, screws).expect("lengths");
        let checked = Description::from_screws("chain", frames, &inertias, screws).expect("lengths");
        assert_eq!(*model.description(), checked);
        let (theta, tip) = (random.array::<5>(), model.end_effector().expect("named"));
        let S: Vec<Twist> = axes.iter().map(|axis| axis.twist()).collect();
        let B: Vec<Twist> = S.iter().map(|&S| home[5].inverse().Ad() * S).collect();

        let T = model.forward_kinematics(&theta, tip).expect("lengths");
        let near = |other: SE3| (T.inverse() * other).log().norm() < 1e-13;
        assert!(near(product_of_exponentials(home[5], &S, &theta)));
        assert!(near(body_product_of_exponentials(home[5], &B, &theta)));
        // a longer screw turns as far for a smaller θ
        let (longer, less) = (S.clone().into_iter().map(|S| S * 2.0).collect::<Vec<_>>(), theta.map(|q| q / 2.0));
        assert!(near(product_of_exponentials(home[5], &longer, &less)));
        let (mut J_s, mut J_b) = (S, B);
        space_jacobian_of_screws(&mut J_s, &theta);
        body_jacobian_of_screws(&mut J_b, &theta);
        let (expected_s, expected_b) = (model.space_jacobian(&theta, tip), model.body_jacobian(&theta, tip));
        for (found, expected) in [(J_s, expected_s), (J_b, expected_b)] {
            let expected = expected.expect("lengths").0;
            assert!(found.iter().zip(&expected).all(|(&a, &b)| (a - b).norm() < 1e-13));
        }
    }
}
