//! The kernels on unusual scalars and robots: NaN, f32, recordings, NaN-filled memory, singular and extreme masses.

use super::{close, column};
use crate::model::Environment;
use crate::testing::{Random, state, tree, twist, wrench};
use crate::workspace::Workspace;
use crate::{Scalar, dynamics as kernel};
use nalgebra::DVector;

#[test]
fn nan_in_nan_out() {
    let model = tree(3, 5, 0);
    let [mut theta, dtheta, tau] = state(&model, 3);
    theta[2] = f64::NAN;
    let found = model.forward_dynamics(&theta, &dtheta, &tau, &model.environment()).expect("NaN is no error");
    assert!(found.iter().any(|x| x.is_nan()));
}

#[test]
fn f32_runs_on_the_same_source() {
    let model = tree(4, 6, 1);
    let [theta, dtheta, ddtheta] = state(&model, 4);
    let small = |x: &[f64]| x.iter().map(|&x| x as f32).collect::<alloc::vec::Vec<f32>>();
    let single = model.map(f32::from_f64);
    let mut tau = alloc::vec![0.0_f32; model.n()];
    let workspace = &mut Workspace::<f32>::new(&single);
    kernel::inverse_dynamics(
        &single,
        &small(&theta),
        &small(&dtheta),
        &small(&ddtheta),
        &single.environment(),
        workspace,
        &mut tau,
    );
    let reference = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).expect("lengths");
    let error =
        tau.iter().zip(reference.iter()).fold(0.0_f64, |m, (&a, b)| m.max((f64::from(a) - b).abs())) / reference.amax();
    assert!(error < 100.0 * f64::from(f32::EPSILON), "{error}");
}

#[test]
fn a_wrong_length_is_named() {
    let model = tree(1, 3, 0);
    let error = model.inverse_dynamics(&[0.0; 3], &[0.0; 2], &[0.0; 3], &model.environment()).expect_err("two rates");
    assert_eq!(error.to_string(), "dtheta has 2 entries, expected 3");
    let stranger = tree(9, 12, 0).end_effector().expect("named");
    let environment = Environment { applied: &[(stranger, wrench(1))], ..model.environment() };
    let error =
        model.bias_forces(&[0.0; 3], &[0.0; 3], &environment).expect_err("a frame of another model").to_string();
    assert!(error.starts_with("the frame is number 16 of another model"), "{error}");
    assert!(model.body_jacobian(&[0.0; 3], stranger).is_err());
}

#[test]
fn a_massless_tip_is_a_singular_mass_matrix() {
    use crate::model::description::{Joint, JointKind};
    use crate::{Description, SE3, ScrewAxis, SpatialInertia};
    let z = JointKind::Screw(ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).expect("unit"));
    let build = |armature: f64| {
        let origin = SE3::exp(twist(1));
        let mut last = Joint::new("last", "arm", "tip", origin, z);
        last.armature = armature;
        Description::new("robot")
            .link("base", SpatialInertia::zero())
            .link("arm", crate::testing::inertia(1))
            .link("tip", SpatialInertia::zero())
            .joint(Joint::new("first", "base", "arm", origin, z))
            .joint(last)
            .build()
            .expect("a sound robot")
    };
    let model = build(0.0);
    let (x, environment) = ([0.1, 0.2], model.environment());
    for result in [
        model.forward_dynamics(&x, &x, &x, &environment),
        model.forward_dynamics_by_mass_matrix(&x, &x, &x, &environment),
        model.forward_dynamics_by_inverse_dynamics(&x, &x, &x, &environment),
        model.forward_dynamics_derivatives(&x, &x, &x, &environment).map(|found| found.ddtheta),
    ] {
        let message = result.expect_err("nothing to accelerate").to_string();
        assert!(message.contains("singular at joint `last`"), "{message}");
    }
    let model = build(0.01);
    assert!(model.forward_dynamics(&x, &x, &x, &model.environment()).is_ok());
}

#[test]
fn random_states_many() {
    let model = tree(42, 10, 0);
    let mut random = Random(7);
    for _ in 0..50 {
        let theta = random.vector(10, 3.0);
        let M = model.mass_matrix(&theta).expect("lengths");
        assert!(M.clone().cholesky().is_some(), "M is positive definite");
        assert_eq!(M, M.transpose());
    }
}

/// Every quantity on a scalar without value and order, on which a kernel cannot branch: equal bit for bit.
#[test]
fn a_recording_plays_back_bit_for_bit() {
    use crate::quantities::{Dim, LIST, Memory, Of, Query};
    use crate::scalar::recorded::{Recorded, play};
    use alloc::vec::Vec;
    for (seed, mimics) in [(1, 0), (2, 2)] {
        let model = tree(seed, 6, mimics);
        let ([theta, dtheta, ddtheta], [_, x, _]) = (state(&model, seed), state(&model, seed + 1));
        let (state, w) = ([theta, dtheta, ddtheta, x], [0.3, -0.7, 1.1, 2.0, -1.5, 0.4]);
        let frame = model.end_effector().expect("named");
        for index in 0..LIST.len() {
            let rows = &[0];
            let task = crate::Task { frame, coordinates: crate::TaskFrame::Body, rows };
            let query = match LIST[index].of {
                Of::Task => Query::at(index).of_task(task),
                _ => Query::at(index).of(frame),
            };
            let declared = query.declaration().inputs.iter().zip(&state);
            let numbers = declared.map(|(input, x)| if input.dim == Dim::Is(6) { &w[..] } else { x });
            let numbers: Vec<&[f64]> = numbers.collect();
            let mut places = 0..;
            let inputs = numbers.iter().map(|x| x.iter().zip(&mut places).map(|(_, k)| Recorded::input(k)).collect());
            let inputs: Vec<Vec<Recorded>> = inputs.collect();
            let given: Vec<&[Recorded]> = inputs.iter().map(Vec::as_slice).collect();
            let mut found: Vec<Vec<Recorded>> =
                query.output_lengths(&model).map(|length| alloc::vec![Recorded::Constant(f64::NAN); length]).collect();
            let mut slices: Vec<&mut [Recorded]> = found.iter_mut().map(Vec::as_mut_slice).collect();
            let (environment, memory) = (model.environment::<Recorded>(), &mut Memory::new(&model));
            query.evaluate(&model, &given, &environment, memory, &mut slices);
            let value = play(&numbers.concat());
            let expected = model.compute(query, &numbers, &model.environment()).expect("regular");
            for (found, expected) in found.iter().zip(&expected) {
                let played: Vec<f64> = found.iter().map(|&x| value(x)).collect();
                assert_eq!(&played, expected, "{}", query.name());
            }
        }
    }
}

#[test]
fn extreme_mass_ratios() {
    use crate::model::Description;
    // every other link ten orders of magnitude lighter than the one before, or heavier
    for heavier in [1.0e10, 1.0e-10] {
        let mut robot: Description = tree(8, 10, 0).description().clone();
        for (i, link) in robot.links.iter_mut().enumerate().filter(|(i, _)| i % 2 == 0) {
            link.inertia = link.inertia * if i > 0 { heavier } else { 1.0 };
        }
        robot.joints.iter_mut().for_each(|joint| joint.armature = 0.0);
        let model = robot.build().expect("a sound robot");
        let [theta, dtheta, ddtheta] = state(&model, 8);
        let environment = model.environment();
        let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("lengths");
        let form = model.closed_form(&theta, &dtheta, &environment).expect("lengths");
        close(&column(&tau), &column(&form.inverse_dynamics(&DVector::from_column_slice(&ddtheta))), 0.0, 1000.0, "τ");
        let found = model.forward_dynamics(&theta, &dtheta, tau.as_slice(), &environment).expect("regular");
        let again = model.inverse_dynamics(&theta, &dtheta, found.as_slice(), &environment).expect("lengths");
        let scale = model.mass_matrix(&theta).expect("lengths").amax() * found.amax();
        close(&column(&again), &column(&tau), scale, 1000.0, "FD∘ID");
    }
}
