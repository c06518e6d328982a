use crate::constraints::constrained_forward_dynamics;
use crate::model::description::{Anchor, Closure, Constraint, Description, Joint, JointKind};
use crate::scalar::Dual;
use crate::testing::{closed, floating_mixed_tree, four_bar, mixed_tree, state, tree};
use crate::{Environment, Error, Model, SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Vec3, Workspace};
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::DVector;

const GUESS: [f64; 3] = [1.0, -0.6, 1.6];

fn closed_four_bar() -> (Model, Vec<f64>, Vec<f64>) {
    let model = four_bar();
    let theta = model.assemble(&GUESS, &["crank_pivot"]).expect("closes");
    let dtheta = model.assemble_velocities(&theta, &[1.5, 0.0, 0.0], &["crank_pivot"]).expect("moves");
    (model, theta, dtheta)
}

#[test]
fn a_four_bar_is_assembled() {
    let (model, theta, dtheta) = closed_four_bar();
    assert_eq!((theta[0], dtheta[0]), (1.0, 1.5));
    // the coupler's and the rocker's end, by trigonometry
    let (sin, cos) = (theta[0] + theta[1]).sin_cos();
    let x = 0.3 * theta[0].cos() + 0.8 * cos - 0.9 - 0.6 * theta[2].cos();
    let z = 0.3 * theta[0].sin() + 0.8 * sin - 0.6 * theta[2].sin();
    assert!(x.abs() < 1e-14 && z.abs() < 1e-14, "{x} {z}");
    let rank = model.constraint_rank(&theta).expect("lengths");
    assert_eq!((rank.rows, rank.rank, rank.freedom), (5, 2, 1));
    assert_eq!(rank.redundant, ["loop.wx", "loop.wy", "loop.vz"], "{rank:?}");
}

#[test]
fn what_cannot_be_closed_is_named() {
    let long = four_bar().description().clone();
    let mut apart = long.clone();
    apart.constraints[0] =
        Constraint::distance("rope", "coupler", Anchor::world(SE3::translation([5.0, 0.0, 0.0])), 0.1);
    let model = apart.build().expect("sound");
    let Err(Error::Unreachable { constraint, residual, .. }) = model.assemble(&GUESS, &[]) else { panic!("5 m") };
    assert!(constraint == "rope" && residual > 1.0, "{residual}");
    let model = four_bar();
    let held = model.assemble(&[1.0, 0.0, 0.0], &["crank_pivot", "coupler_pivot"]);
    assert!(held.expect_err("held").to_string().contains("no position with the held joints"));
    // a frame and itself, a length of 0, a frame that does not exist
    let mut bad = long;
    bad.constraints = vec![
        Constraint::weld("itself", "coupler", Anchor::frame("coupler").at(SE3::translation([0.1, 0.0, 0.0]))),
        Constraint::distance("nothing", "coupler", "rocker", 0.0),
        Constraint::point("nowhere", "coupler", "rokcer"),
    ];
    let message = bad.build().expect_err("three errors").to_string();
    for expected in ["`coupler` and `coupler` are fixed to each other", "is 0 m", "no link or frame `rokcer`"] {
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn the_reduction_moves_like_the_whole() {
    let (model, theta, dtheta) = closed_four_bar();
    let environment = model.environment();
    let tau = [0.7, 0.0, -0.2];
    let whole = model.constrained_forward_dynamics(&theta, &dtheta, &tau, &environment).expect("regular");
    for independent in ["crank_pivot", "rocker_pivot"] {
        let own = model.reduce(&theta, &dtheta, &[independent], &environment).expect("one degree of freedom");
        let force = own.N.transpose() * DVector::from_column_slice(&tau);
        let du = own.M.clone().cholesky().expect("positive").solve(&(force - &own.h));
        let ddtheta = &own.N * du + &own.bias;
        assert!((ddtheta - &whole.ddtheta).amax() < 1e-10 * whole.ddtheta.amax());
        let u = dtheta[own.independent[0]];
        assert!((&own.N * u - DVector::from_column_slice(&dtheta)).amax() < 1e-12);
        // inverse dynamics by one motor
        let mut robot = model.description().clone();
        robot.motors = Some(vec![independent.into()]);
        let driven = robot.build().expect("sound");
        let found = driven
            .constrained_inverse_dynamics(&theta, &dtheta, whole.ddtheta.as_slice(), &environment, None)
            .expect("one motor");
        let expected = (own.N.transpose() * DVector::from_column_slice(&tau))[0];
        let j = own.independent[0];
        assert!((found.tau[j] - expected).abs() < 1e-9, "{} {expected}", found.tau);
        assert!((0..3).all(|k| k == j || found.tau[k] == 0.0));
    }
    let error = model.reduce(&theta, &dtheta, &["crank_pivot", "rocker_pivot"], &environment).expect_err("two");
    assert!(error.to_string().contains("independently of each other"), "{error}");
    let error = model.reduce(&theta, &dtheta, &[], &environment).expect_err("none");
    assert!(error.to_string().contains("not determined"), "{error}");
}

#[test]
fn inverse_dynamics_undoes_forward_dynamics() {
    for seed in 0..6 {
        let model = [tree(seed, 9, 0), mixed_tree(seed, 8, 2)][seed as usize % 2].clone();
        let [theta, dtheta, tau] = state(&model, seed);
        let model = closed(&model, &theta, &[Closure::Point, Closure::Hinge], seed);
        let environment = model.environment();
        let dtheta = model.assemble_velocities(&theta, &dtheta, &[]).expect("moves");
        let forward = model.constrained_forward_dynamics(&theta, &dtheta, &tau, &environment).expect("regular");
        let found = model
            .constrained_inverse_dynamics(&theta, &dtheta, forward.ddtheta.as_slice(), &environment, None)
            .expect("all joints have motors");
        // the same motion, by torques that are not larger
        let again =
            model.constrained_forward_dynamics(&theta, &dtheta, found.tau.as_slice(), &environment).expect("regular");
        assert!((&again.ddtheta - &forward.ddtheta).amax() < 1e-7 * forward.ddtheta.amax());
        assert!(found.tau.norm() <= DVector::from_column_slice(&tau).norm() * (1.0 + 1e-12));
        // too few motors
        let mut robot = model.description().clone();
        robot.motors = Some(Vec::new());
        let dead = robot.build().expect("sound");
        let error = dead.constrained_inverse_dynamics(&theta, &dtheta, forward.ddtheta.as_slice(), &environment, None);
        assert!(matches!(error, Err(Error::Underactuated { motors: 0, .. })), "{error:?}");
        let mut wrong = forward.ddtheta.clone();
        wrong += model.constraint_rows_at(&theta, &dtheta).A.row(0).transpose() * (1.0 + wrong.amax());
        let error = model.constrained_inverse_dynamics(&theta, &dtheta, wrong.as_slice(), &environment, None);
        assert!(matches!(error, Err(Error::Unreachable { .. })), "{error:?}");
        let mended = model.assemble_accelerations(&theta, &dtheta, wrong.as_slice(), &[]).expect("some");
        model.constrained_inverse_dynamics(&theta, &dtheta, &mended, &environment, None).expect("allowed");
    }
}

#[test]
fn derivatives_are_those_of_dual_numbers() {
    for seed in 0..6 {
        let model = match seed % 3 {
            0 => tree(seed, 8, 0),
            1 => mixed_tree(seed, 7, 2),
            _ => floating_mixed_tree(seed, 6, 0),
        };
        let [theta, dtheta, tau] = state(&model, seed);
        let closures = [[Closure::Weld], [Closure::Rolling(0.4)], [Closure::Hinge]][seed as usize % 3];
        let model = closed(&model, &theta, &closures, seed);
        let environment = Environment { gravity: crate::Vec3([1.0, 2.0, -9.0]), ..model.environment() };
        let dtheta = model.assemble_velocities(&theta, &dtheta, &[]).expect("moves");
        let (m, n) = (model.constraint_rows(), model.n());
        let found =
            model.constrained_forward_dynamics_derivatives(&theta, &dtheta, &tau, &environment).expect("regular");
        let mut nothing = Vec::new();
        let lifted = environment.map(Dual::constant, &mut nothing);
        for j in 0..n {
            let mut e = vec![0.0; n];
            e[j] = 1.0;
            let plain = || [Dual::constants(&theta), Dual::constants(&dtheta), Dual::constants(&tau)];
            let along = |which: usize| {
                let mut inputs = plain();
                inputs[which] = match which {
                    0 => crate::model::seed_direction(&model, &theta, &e),
                    1 => Dual::list(&dtheta, &e),
                    _ => Dual::list(&tau, &e),
                };
                let (mut ddtheta, mut lambda) = (Dual::constants(&vec![0.0; n]), Dual::constants(&vec![0.0; m]));
                let (mut workspace, mut memory) = (Workspace::new(&model), crate::ConstraintMemory::new(&model));
                let [theta, dtheta, tau] = &inputs;
                constrained_forward_dynamics(
                    &model,
                    theta,
                    dtheta,
                    tau,
                    &lifted,
                    &mut workspace,
                    &mut memory,
                    &mut ddtheta,
                    &mut lambda,
                );
                let slopes = |list: Vec<Dual>| DVector::from_iterator(list.len(), list.iter().map(|x| x.derivative));
                (slopes(ddtheta), slopes(lambda))
            };
            let expected = [along(0), along(1), along(2)];
            let accelerations = [&found.d_theta, &found.d_dtheta, &found.d_tau];
            let forces = [&found.lambda_d_theta, &found.lambda_d_dtheta, &found.lambda_d_tau];
            let is_unique = model.constraint_rank(&theta).expect("lengths").redundant.is_empty();
            for k in 0..3 {
                let (x, y) = (accelerations[k].column(j).clone_owned(), forces[k].column(j).clone_owned());
                assert!(
                    (&x - &expected[k].0).amax() < 1e-7 * (1.0 + accelerations[k].amax()),
                    "{seed} {k} {j}: {x} {}",
                    expected[k].0
                );
                assert!(!is_unique || (&y - &expected[k].1).amax() < 1e-7 * (1.0 + forces[k].amax()), "{seed} {k} {j}");
            }
        }
    }
}

#[test]
fn the_nearest_closed_position_is_within_the_limits() {
    let (model, theta, _) = closed_four_bar();
    // from far: the other branch of the loop is as closed, but not as near
    for turn in [-1.0, 0.0, 1.0, 2.5] {
        let guess = [theta[0] + turn, theta[1], theta[2]];
        let found = model.assemble(&guess, &["crank_pivot"]).expect("closes");
        assert!(
            (found[1] - guess[1]).abs() <= core::f64::consts::PI
                && (found[2] - guess[2]).abs() <= core::f64::consts::PI
        );
        let rows = model.constraint_rows_at(&found, &[0.0; 3]);
        assert!(rows.phi.amax() < 1e-11 && found[0] == guess[0]);
    }
    let mut robot = model.description().clone();
    let rocker = robot.joints.iter_mut().find(|joint| joint.name == "rocker_pivot").expect("there");
    rocker.limits.position = Some([-0.2, 0.2]); // neither branch
    let error = robot.build().expect("sound").assemble(&[theta[0], 0.0, 0.0], &["crank_pivot"]).expect_err("a limit");
    assert!(error.to_string().contains("`rocker_pivot` at "), "{error}");
}

/// Two hinges about y, the second 0.3 m along x.
fn two_hinges() -> Description {
    let body = SpatialInertia::new(1.0, Vec3::zero(), Sym3::diagonal(0.1, 0.1, 0.1));
    let hinge = || JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3]).expect("unit"));
    let robot = Description::new("two").link("base", SpatialInertia::zero()).link("a", body).link("b", body);
    let robot = robot.joint(Joint::new("j1", "base", "a", SE3::identity(), hinge()));
    robot.joint(Joint::new("j2", "a", "b", SE3::translation([0.3, 0.0, 0.0]), hinge()))
}

/// A weld, and a hinge with opposite axes, that are open by half a turn are not closed, and are closed by (0, π).
#[test]
fn half_turns_are_open() {
    const PI: f64 = core::f64::consts::PI;
    let at = |w: [f64; 3]| Anchor::world(SE3::new(SO3::exp(Vec3(w)), Vec3([0.3, 0.0, 0.0])));
    for constraint in [
        Constraint::weld("loop", at([0.0, PI, 0.0]), "b"),
        Constraint::hinge("loop", at([PI, 0.0, 0.0]), "b"),
        Constraint::hinge("loop", at([0.0, PI, 0.0]), "b"),
    ] {
        let mut robot = two_hinges();
        robot.constraints = vec![constraint];
        let model = robot.build().expect("sound");
        let phi = model.constraint_errors(&[0.0, 0.0]).expect("lengths");
        assert!((phi.norm() - 2.0).abs() < 1e-9, "{phi}");
        let theta = model.assemble(&[0.0, 0.0], &["j1"]).expect("closes");
        assert!(theta[0] == 0.0 && (theta[1].abs() - PI).abs() < 1e-9, "{theta:?}");
        assert!(model.constraint_errors(&theta).expect("lengths").amax() < 1e-11);
    }
}

/// The lowest point of a wheel that lies flat is no point: an error, not a search without end.
#[test]
fn a_wheel_that_lies_flat_is_refused() {
    let wheel = SpatialInertia::new(2.0, Vec3::zero(), Sym3::diagonal(0.01, 0.01, 0.02));
    let mut robot = Description::new("wheel").link("wheel", wheel).floating();
    robot.constraints = vec![Constraint::rolling("rolls", Anchor::world(SE3::identity()), "wheel", 0.1)];
    let model = robot.build().expect("sound");
    let theta = model.start().theta;
    for error in [
        model.assemble(&theta, &[]).expect_err("flat"),
        model.assemble_velocities(&theta, &[0.0; 6], &[]).expect_err("flat"),
        model.assemble_accelerations(&theta, &[0.0; 6], &[0.0; 6], &[]).expect_err("flat"),
    ] {
        assert!(error.to_string().contains("constraint `rolls` is undefined"), "{error}");
    }
}

/// A decomposition of what is not a number would not end, or find no rank.
#[test]
fn constraints_at_no_position_are_refused() {
    let (model, theta, dtheta) = closed_four_bar();
    let (nowhere, environment) = ([f64::NAN, theta[1], theta[2]], model.environment());
    for error in [
        model.constraint_rank(&nowhere).expect_err("NaN"),
        model.reduce(&nowhere, &dtheta, &["crank_pivot"], &environment).expect_err("NaN"),
        model.reduce(&theta, &[f64::NAN; 3], &["crank_pivot"], &environment).expect_err("NaN"),
    ] {
        assert!(error.to_string().contains("constraint `loop` is undefined"), "{error}");
    }
}
