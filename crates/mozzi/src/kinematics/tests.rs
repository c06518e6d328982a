//! Kinematics against the product of exponentials, dual numbers and each other, on random trees.

use crate::model::{Description, Freedom, HomeFrames, Model, Screws};
use crate::testing::{distance, floating_mixed_tree, floating_tree, mixed_tree, moving, state, tree, twist};
use crate::{Dual, FrameId, SE3, Twist, kinematics as kernel};
use alloc::vec::Vec;

fn models() -> impl Iterator<Item = (u64, Model, FrameId)> {
    let trees = [(1, 0), (4, 0), (9, 0), (9, 3), (15, 4), (1, 0), (9, 2), (1, 0), (6, 0), (15, 4), (9, 2)];
    trees.into_iter().enumerate().map(|(k, (links, mimics))| {
        let make =
            [tree, floating_tree, mixed_tree, floating_mixed_tree][[5, 7, 10, 11].partition_point(|&end| end <= k)];
        let model = make(100 + k as u64, links, mimics);
        let tip = model.end_effector().expect("named");
        (k as u64, model, tip)
    })
}

fn along(n: usize, j: usize) -> Vec<f64> {
    (0..n).map(|i| f64::from(u8::from(i == j))).collect()
}

#[test]
fn the_pose_is_the_product_of_exponentials() {
    for (seed, model, tip) in
        models().filter(|(_, model, _)| model.places().iter().all(|place| place.freedom == Freedom::One))
    {
        let [theta, _, _] = state(&model, seed);
        let lists = model.screws().expect("one axis a joint");
        let (_, home) = lists.end_effector.clone().expect("named");
        // the joints on the tip's path, base to tip
        let mut path = Vec::new();
        let mut at = model.frames[tip.0].slot;
        while at > 0 {
            path.insert(0, at - 1);
            at = lists.parents[at - 1];
        }
        let q = |i: usize| model.links[i].ratio * theta[model.links[i].q] + model.links[i].offset;
        let base = kernel::base_pose(&model, &theta);
        let space = path.iter().fold(base, |T, &i| T * SE3::exp(lists.S[i] * q(i))) * home;
        let body = path.iter().fold(base * home, |T, &i| T * SE3::exp(lists.B[i] * q(i)));
        let pose = model.forward_kinematics(&theta, tip).expect("lengths");
        let errors = [distance(pose, space), distance(pose, body)];
        assert!(errors.iter().all(|&error| error < 1e-13), "{seed} {errors:?}");
        // every frame at once, and one by one
        for (pose, (frame, _)) in model.frame_poses(&theta).expect("lengths").into_iter().zip(model.frames()) {
            assert!(distance(pose, model.forward_kinematics(&theta, frame).expect("lengths")) < 1e-13);
        }
    }
}

#[test]
fn jacobians_are_the_derivatives_of_the_pose() {
    for (seed, model, tip) in models() {
        let [theta, _, _] = state(&model, seed);
        let (Js, Jb) = (model.space_jacobian(&theta, tip), model.body_jacobian(&theta, tip));
        let (Js, Jb) = (Js.expect("lengths"), Jb.expect("lengths"));
        for j in 0..model.n() {
            let T = kernel::forward_kinematics(&model, &moving(&model, &theta, &along(model.n(), j)), tip);
            // [𝒱_s] = Ṫ T⁻¹ and [𝒱_b] = T⁻¹ Ṫ
            let (pose, dT) = (T.map(|x| x.value), T.map(|x| x.derivative));
            let w = (dT.R.matrix() * pose.R.matrix().transpose()).vee();
            let spatial = Twist { w, v: dT.p - w.cross(pose.p) };
            let scale = 1.0 + Js.0[j].norm();
            assert!((spatial - Js.0[j]).norm() < 1e-13 * scale);
            assert!((pose.inverse().Ad() * spatial - Jb.0[j]).norm() < 1e-13 * scale);
        }
    }
}

#[test]
fn rates_and_derivatives_against_dual_numbers() {
    for (seed, model, tip) in models() {
        let [theta, dtheta, _] = state(&model, seed);
        let n = model.n();
        let mut J = alloc::vec![Twist::from_array([Dual::constant(0.0); 6]); n];
        let derivative = |V: &Twist<Dual>| V.map(|x| x.derivative);
        let close =
            |a: Twist, b: Twist| assert!((a - b).norm() < 1e-12 * (1.0 + a.norm() + b.norm()), "{seed}: {a:?} {b:?}");

        kernel::space_jacobian(&model, &moving(&model, &theta, &dtheta), tip, &mut J);
        let rate = model.space_jacobian_rate(&theta, &dtheta, tip).expect("lengths");
        J.iter().zip(&rate.0).for_each(|(J, &dJ)| close(derivative(J), dJ));
        kernel::body_jacobian(&model, &moving(&model, &theta, &dtheta), tip, &mut J);
        let rate = model.body_jacobian_rate(&theta, &dtheta, tip).expect("lengths");
        J.iter().zip(&rate.0).for_each(|(J, &dJ)| close(derivative(J), dJ));

        let space = model.space_jacobian_derivative(&theta, tip).expect("lengths");
        let body = model.body_jacobian_derivative(&theta, tip).expect("lengths");
        for j in 0..n {
            kernel::space_jacobian(&model, &moving(&model, &theta, &along(n, j)), tip, &mut J);
            J.iter().zip(&space[j].0).for_each(|(J, &H)| close(derivative(J), H));
            kernel::body_jacobian(&model, &moving(&model, &theta, &along(n, j)), tip, &mut J);
            J.iter().zip(&body[j].0).for_each(|(J, &H)| close(derivative(J), H));
        }
    }
}

#[test]
fn second_derivatives_by_nested_duals() {
    // ∂²T/∂θ₀∂θ₁ of a pose, against the derivative of the Jacobian
    let model = tree(7, 5, 0);
    let tip = model.end_effector().expect("named");
    let [theta, _, _] = state(&model, 7);
    let H = &model.space_jacobian_derivative(&theta, tip).expect("lengths")[0];
    let theta: Vec<Dual<Dual>> = theta
        .iter()
        .enumerate()
        .map(|(i, &value)| Dual {
            value: Dual { value, derivative: f64::from(u8::from(i == 0)) },
            derivative: Dual::constant(f64::from(u8::from(i == 1))),
        })
        .collect();
    let T = kernel::forward_kinematics(&model, &theta, tip);
    let (R, dR) = (T.R.matrix().map(|x| x.value), T.R.matrix().map(|x| x.derivative));
    let w = (dR * R.transpose()).vee(); // the angular part of J_1, with its derivative along θ₀
    assert!((w.map(|x| x.derivative) - H.0[1].w).norm() < 1e-13);
}

#[test]
fn the_books_lists_make_the_same_robot_in_every_form() {
    // a serial chain as lists: home frames or relative ones; space, body or link screws
    let mut chain = Vec::new();
    for i in 0..5 {
        let (A, _) = crate::ScrewAxis::normalize(twist(60 + i)).expect("a screw");
        chain.push((SE3::exp(twist(50 + i)), A, crate::testing::inertia(70 + i)));
    }
    let mut relative: Vec<SE3> = chain.iter().map(|link| link.0).collect();
    relative.push(SE3::exp(twist(99)));
    let inertias: Vec<_> = chain.iter().map(|link| link.2).collect();
    let A: Vec<_> = chain.iter().map(|link| link.1).collect();
    let mut home = relative.clone();
    (1..home.len()).for_each(|i| home[i] = home[i - 1] * home[i]);
    let S: Vec<_> = A.iter().zip(&home).map(|(A, &M)| A.transformed(M)).collect();
    let B: Vec<_> = S.iter().map(|S| S.transformed(home[5].inverse())).collect();

    let build = |frames, screws| {
        Description::from_screws("chain", frames, &inertias, screws).expect("lengths").build().expect("a sound robot")
    };
    let reference = build(HomeFrames::Relative(&relative), Screws::Link(&A));
    let [theta, dtheta, ddtheta] = state(&reference, 5);
    let tau = reference.inverse_dynamics(&theta, &dtheta, &ddtheta, &reference.environment()).expect("lengths");
    let tip = reference.end_effector().expect("named");
    let pose = reference.forward_kinematics(&theta, tip).expect("lengths");
    for frames in [HomeFrames::Relative(&relative), HomeFrames::Base(&home)] {
        for screws in [Screws::Space(&S), Screws::Body(&B), Screws::Link(&A)] {
            let model = build(frames, screws);
            let again = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
            assert!((&again - &tau).amax() < 1e-11 * tau.amax());
            assert!(distance(model.forward_kinematics(&theta, tip).expect("lengths"), pose) < 1e-13);
        }
    }
    // round trip: the lists in centre-of-mass frames make the same robot again
    let out = reference.screws().expect("one axis a joint");
    let again = Description::from_screws("again", HomeFrames::Base(&out.home_frames()), &out.G, Screws::Space(&out.S));
    let again = again.expect("lengths").build().expect("a sound robot");
    let again = again.inverse_dynamics(&theta, &dtheta, &ddtheta, &again.environment()).expect("lengths");
    assert!((&again - &tau).amax() < 1e-11 * tau.amax());
    // 𝒢 at the centre of mass is the book's block-diagonal one
    assert!(out.G.iter().all(|G| G.mc == crate::Vec3::zero()));

    let message = Description::from_screws("short", HomeFrames::Base(&home[1..]), &inertias, Screws::Space(&S));
    let message = message.expect_err("a frame is missing").to_string();
    assert_eq!(
        message,
        "the list of home frames (one for each link, and the end effector's) has 5 entries, expected 6"
    );
}
