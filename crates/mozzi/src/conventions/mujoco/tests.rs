//! Derivatives, power and energy in MuJoCo's coordinates, and round trips.

use super::*;
use crate::model::Environment;
use crate::model::integrate;
use crate::testing::{Random, floating_mixed_tree, floating_tree, mixed_tree, state, tree};

/// A model, its conversion with the joints in reverse order, and its state.
fn cases() -> impl Iterator<Item = (Model, MuJoCo, [Vec<f64>; 3])> {
    let models = [
        tree(4, 7, 0),
        floating_tree(4, 7, 2),
        floating_tree(9, 3, 0),
        mixed_tree(4, 7, 0),
        floating_mixed_tree(5, 9, 2),
    ];
    models.into_iter().zip(1..).map(|(model, seed)| {
        let names: Vec<&str> = model.joint_names().collect();
        let names: Vec<&str> = names.into_iter().rev().collect();
        let mujoco = MuJoCo::with_joints(&model, &names).expect("its joints");
        let state = state(&model, seed);
        (model, mujoco, state)
    })
}

#[test]
fn accelerations_are_the_derivatives_of_velocities() {
    for (model, mujoco, [theta, dtheta, ddtheta]) in cases() {
        let qvel = |t: f64| {
            // θ ⊕ (θ̇ t + θ̈ t²/2): at second order the way in between does not matter
            let step: Vec<f64> = dtheta.iter().zip(&ddtheta).map(|(v, a)| v + 0.5 * a * t).collect();
            let (mut theta, velocity) = (theta.clone(), DVector::from_column_slice(&ddtheta) * t);
            integrate(&model, &mut theta, &step, t);
            let velocity = DVector::from_column_slice(&dtheta) + velocity;
            (mujoco.configuration(&theta).expect("nq"), mujoco.velocity(&theta, velocity.as_slice()).expect("n"))
        };
        let step = 1e-5;
        let difference = (qvel(step).1 - qvel(-step).1) / (2.0 * step);
        let qacc = mujoco.acceleration(&theta, &dtheta, &ddtheta).expect("n");
        assert!((difference - &qacc).amax() < 1e-8 * qacc.amax(), "{qacc}");
        if model.is_floating() {
            // the linear velocity is the origin's
            let rate = (qvel(step).0 - qvel(-step).0) / (2.0 * step);
            assert!((rate.rows(0, 3) - qvel(0.0).1.rows(0, 3)).amax() < 1e-8);
        }
    }
}

#[test]
fn power_energy_and_the_equation_of_motion_are_the_same() {
    for (model, mujoco, [theta, dtheta, _]) in cases() {
        let tau = Random(6).vector(model.n(), 3.0);
        let qvel = mujoco.velocity(&theta, &dtheta).expect("n");
        let qfrc = mujoco.force(&theta, &tau).expect("n");
        let power: f64 = tau.iter().zip(&dtheta).map(|(a, b)| a * b).sum();
        assert!((qfrc.dot(&qvel) - power).abs() < 1e-13);
        let M = model.mass_matrix(&theta).expect("M");
        let theirs = mujoco.mass_matrix(&theta, &M).expect("n");
        let K = model.kinetic_energy(&theta, &dtheta).expect("K");
        assert!((0.5 * qvel.dot(&(&theirs * &qvel)) - K).abs() < 1e-13 * K);
        // XᵀMX q̈ + h = Xᵀτ, by forward dynamics; and h at rest in the world is inverse dynamics with β
        let environment: Environment = model.environment();
        let h = model.bias_forces(&theta, &dtheta, &environment).expect("h");
        let bias = mujoco.bias_forces(&theta, &dtheta, &M, h.as_slice()).expect("n");
        let found = model.forward_dynamics(&theta, &dtheta, &tau, &environment).expect("θ̈");
        let qacc = mujoco.acceleration(&theta, &dtheta, found.as_slice()).expect("n");
        let friction = model.joint_friction(&dtheta).expect("f") + model.spring_forces(&theta).expect("f");
        let friction = mujoco.force(&theta, friction.as_slice()).expect("n");
        let error = (&theirs * &qacc + &bias + &friction - &qfrc).amax();
        assert!(error < 1e-13 * M.amax() * (qacc.amax() + 10.0), "{error}");
        let qpos = mujoco.configuration(&theta).expect("nq");
        let zero = alloc::vec![0.0; model.n()];
        let beta = mujoco.from_acceleration(qpos.as_slice(), qvel.as_slice(), &zero).expect("n");
        let still = model.inverse_dynamics(&theta, &dtheta, beta.as_slice(), &environment).expect("τ");
        let still = mujoco.force(&theta, still.as_slice()).expect("n") - friction;
        assert!((still - &bias).amax() < 1e-13 * (bias.amax() + M.amax() * 10.0));
    }
}

#[test]
fn there_and_back() {
    for (model, mujoco, [theta, dtheta, ddtheta]) in cases() {
        // a round trip of rotations: a few ε of the sizes of the rotated entries; exact if nothing is rotated
        let bound = if !model.configuration_space().is_flat() { 16.0 * f64::EPSILON } else { 0.0 };
        let close = |found: DVector<f64>, given: &[f64], size: f64| {
            let error = (found - DVector::from_column_slice(given)).amax();
            assert!(error <= bound * size, "{error:e} of {size}");
        };
        let largest = |list: &[f64]| list.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let qpos = mujoco.configuration(&theta).expect("nq");
        assert_eq!(mujoco.from_configuration(qpos.as_slice()).expect("nq").as_slice(), theta);
        let (qpos, qvel) = (qpos.as_slice(), mujoco.velocity(&theta, &dtheta).expect("n"));
        close(mujoco.from_velocity(qpos, qvel.as_slice()).expect("n"), &dtheta, largest(&dtheta));
        let qacc = mujoco.acceleration(&theta, &dtheta, &ddtheta).expect("n");
        let back = mujoco.from_acceleration(qpos, qvel.as_slice(), qacc.as_slice()).expect("n");
        close(back, &ddtheta, largest(&ddtheta) + largest(&dtheta).powi(2));
        let qfrc = mujoco.force(&theta, &ddtheta).expect("n");
        close(mujoco.from_force(qpos, qfrc.as_slice()).expect("n"), &ddtheta, largest(&ddtheta));
        let M = model.mass_matrix(&theta).expect("M");
        let theirs = mujoco.mass_matrix(&theta, &M).expect("n");
        let back = mujoco.from_mass_matrix(qpos, &theirs).expect("n");
        close(DVector::from_column_slice(back.as_slice()), M.as_slice(), M.amax());
        let h = model.bias_forces(&theta, &dtheta, &model.environment()).expect("h");
        let bias = mujoco.bias_forces(&theta, &dtheta, &M, h.as_slice()).expect("n");
        let back = mujoco.from_bias_forces(qpos, qvel.as_slice(), &M, bias.as_slice()).expect("n");
        close(back, h.as_slice(), h.amax() + M.amax() * largest(&dtheta).powi(2));
    }
}

#[test]
fn what_does_not_fit_is_an_error_that_says_so() {
    let model = floating_tree(3, 4, 0);
    let (mujoco, [theta, dtheta, _]) = (MuJoCo::new(&model), state(&model, 1));
    assert!(mujoco.joints().iter().copied().eq(0..4));
    let said = |answer: Result<DVector<f64>, Error>| alloc::format!("{}", answer.expect_err("it does not fit"));
    assert_eq!(said(mujoco.configuration(&theta[1..])), "theta has 10 entries, expected 11");
    assert_eq!(said(mujoco.from_velocity(&theta[1..], &dtheta)), "qpos has 10 entries, expected 11");
    assert_eq!(said(mujoco.acceleration(&theta, &dtheta, &theta)), "ddtheta has 11 entries, expected 10");
    let nothing = [0.0; 11];
    assert!(said(mujoco.velocity(&nothing, &dtheta)).contains("of length 0, expected a unit quaternion"));
    assert!(mujoco.from_mass_matrix(&theta, &DMatrix::zeros(3, 3)).is_err());
}

#[test]
fn mimic_joints_have_entries_if_they_are_named() {
    for (model, seed) in [(tree(4, 7, 2), 1), (floating_tree(4, 7, 2), 2), (floating_mixed_tree(5, 9, 2), 3)] {
        let [theta, dtheta, ddtheta] = state(&model, seed);
        let mut names: Vec<&str> = model.moving_joints().map(|joint| joint.name.as_str()).collect();
        names.reverse();
        let short: Vec<&str> =
            names.iter().copied().filter(|name| model.joint_names().any(|one| one == *name)).collect();
        let count = names.len() - short.len();
        assert!(count > 0);
        let [to, plain] = [&names, &short].map(|names| MuJoCo::with_joints(&model, names).expect("its joints"));
        let first = model.base().velocities();
        let qpos = to.configuration(&theta).expect("nq");
        let (qvel, qacc) =
            (to.velocity(&theta, &dtheta).expect("n"), to.acceleration(&theta, &dtheta, &ddtheta).expect("n"));
        assert_eq!([qpos.len(), qvel.len()], [theta.len() + count, dtheta.len() + count]);
        // each follower's entries are those of its source
        let offset = |k: usize, of: fn(&Freedom) -> usize| -> usize {
            let freedom = |name: &&str| {
                model.joint_names().position(|one| one == *name).map_or(Freedom::One, |j| model.places()[j].freedom)
            };
            names[..k].iter().map(|name| of(&freedom(name))).sum()
        };
        for (joint, source) in model.moving_joints().zip(model.sources()).filter(|(joint, _)| joint.mimic.is_some()) {
            let k = names.iter().position(|name| *name == joint.name).expect("named");
            let (place, base) = (model.places()[source.joint], model.base().positions());
            let q = base + offset(k, |freedom| freedom.positions());
            let v = first + offset(k, |freedom| freedom.velocities());
            assert_eq!(qpos[q], source.ratio * theta[place.q] + source.offset);
            assert_eq!([qvel[v], qacc[v]], [source.ratio * dtheta[place.j], source.ratio * ddtheta[place.j]]);
        }
        let qpos = qpos.as_slice();
        assert_eq!(to.from_configuration(qpos).expect("nq").as_slice(), theta);
        let there = plain.configuration(&theta).expect("nq");
        let same = |a: DVector<f64>, b: DVector<f64>| assert!((&a - &b).amax() < 1e-13 * (1.0 + a.amax()), "{a}{b}");
        let short_qvel = plain.velocity(&theta, &dtheta).expect("n");
        same(
            to.from_velocity(qpos, qvel.as_slice()).expect("n"),
            plain.from_velocity(there.as_slice(), short_qvel.as_slice()).expect("n"),
        );
        same(
            to.from_acceleration(qpos, qvel.as_slice(), qacc.as_slice()).expect("n"),
            DVector::from_column_slice(&ddtheta),
        );
        let qfrc = to.force(&theta, &ddtheta).expect("n");
        same(to.from_force(qpos, qfrc.as_slice()).expect("n"), DVector::from_column_slice(&ddtheta));
        // any forces have the same power, any matrix the same energy
        let forces = Random(7).vector(qvel.len(), 1.0);
        let tau = to.from_force(qpos, &forces).expect("n");
        let power = tau.dot(&DVector::from_column_slice(&dtheta));
        assert!((power - DVector::from_column_slice(&forces).dot(&qvel)).abs() < 1e-12);
        let A = DMatrix::from_column_slice(qvel.len(), qvel.len(), &Random(8).vector(qvel.len().pow(2), 1.0));
        let theirs = &A * A.transpose();
        let mine = to.from_mass_matrix(qpos, &theirs).expect("n");
        let dtheta = DVector::from_column_slice(&dtheta);
        let (one, other) = (dtheta.dot(&(mine * &dtheta)), qvel.dot(&(theirs * &qvel)));
        assert!((one - other).abs() < 1e-12 * other, "{one} {other}");
        let M = model.mass_matrix(&theta).expect("M");
        let said = to.mass_matrix(&theta, &M).expect_err("a row is missing");
        assert!(alloc::format!("{said}").starts_with("M is that of a robot with the mimic joint `joint"), "{said}");
        assert!(to.bias_forces(&theta, dtheta.as_slice(), &M, tau.as_slice()).is_err());
        let twice: Vec<&str> = names.iter().chain(&names).copied().collect();
        assert!(MuJoCo::with_joints(&model, &twice).is_err());
    }
}

#[test]
fn quaternions_of_qpos_are_normalized() {
    let model = floating_mixed_tree(5, 9, 0);
    let (mujoco, [theta, dtheta, _]) = (MuJoCo::new(&model), state(&model, 1));
    let qpos = mujoco.configuration(&theta).expect("nq");
    let (mut long, mut at) = (qpos.clone(), 0);
    for place in model.configuration_space().places() {
        let quaternion = match place.freedom {
            Freedom::Free => at + 3..at + 7,
            Freedom::Ball => at..at + 4,
            Freedom::One => at..at,
        };
        quaternion.for_each(|k| long[k] *= 1.7);
        at += place.freedom.positions();
    }
    assert!(long != qpos);
    let close = |a: DVector<f64>, b: DVector<f64>| assert!((a - b).amax() < 1e-14);
    close(mujoco.from_configuration(long.as_slice()).expect("nq"), DVector::from_column_slice(&theta));
    let [a, b] = [&long, &qpos].map(|qpos| mujoco.from_velocity(qpos.as_slice(), &dtheta).expect("n"));
    close(a, b);
    assert_eq!(turns::normalized([0.0; 4]), [1.0, 0.0, 0.0, 0.0]);
}
