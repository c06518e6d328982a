//! Robots with dry friction in batches: each moves as alone, to the bit, and what friction holds stays.

use mozzi::testing::{floating_tree, state, tree};
use mozzi::{Model, Vec3, Wrench};
use mozzi_engine::{Batch, BatchEnvironment};
use mozzi_sim::{ContactPoint, Contacts, Input, Method, Options, Plane, Simulation, torque};
use std::ops::ControlFlow;

const ROBOTS: usize = 13;

/// θ, θ̇ and τ of robots.
fn starts(model: &Model) -> [Vec<f64>; 3] {
    let mut tables = [vec![], vec![], vec![]];
    for k in 0..ROBOTS {
        let [theta, dtheta, tau] = state(model, k as u64);
        let slow: Vec<f64> = dtheta.iter().map(|x| 0.3 * x).collect();
        tables.iter_mut().zip([theta, slow, tau]).for_each(|(table, row)| table.extend(row));
    }
    tables
}

#[test]
fn many_robots_with_dry_friction_move_as_each_alone() {
    let (duration, steps) = (0.05, 20);
    for model in [tree(5, 3, 0), floating_tree(3, 3, 0)] {
        assert!(model.has_dry_friction());
        let (nq, n, batch) = (model.nq(), model.n(), Batch::new(&model));
        let [theta, dtheta, tau] = starts(&model);
        let environment = BatchEnvironment::from(model.environment());
        for method in [Method::Automatic, Method::MoreauJean] {
            let (mut q, mut v) = (theta.clone(), dtheta.clone());
            batch.simulate(&mut q, &mut v, &tau, &environment, method, duration, steps).expect("motions");
            for k in 0..ROBOTS {
                let own = &tau[k * n..][..n];
                let motors = torque(|_, _, _, out| out.iter_mut().zip(own).for_each(|(out, x)| *out += x));
                let options = Options { method, ..Options::new(duration, steps) };
                let alone =
                    mozzi_sim::simulate(&model, &theta[k * nq..][..nq], &dtheta[k * n..][..n], motors, &options);
                let alone = alone.expect("a motion");
                assert_eq!(&q[k * nq..][..nq], alone.last().theta, "{}", method.name());
                assert_eq!(&v[k * n..][..n], alone.last().dtheta, "{}", method.name());
            }
            let two = batch.clone().with_threads(2).expect("threads");
            let (mut q2, mut v2) = (theta.clone(), dtheta.clone());
            two.simulate(&mut q2, &mut v2, &tau, &environment, method, duration, steps).expect("motions");
            assert!(q == q2 && v == v2);
        }
        // single numbers: computed in double ones
        let single = |table: &[f64]| table.iter().map(|&x| x as f32).collect::<Vec<f32>>();
        let (mut q, mut v) = (theta.clone(), dtheta.clone());
        batch.simulate(&mut q, &mut v, &tau, &environment, Method::Automatic, duration, steps).expect("motions");
        let (mut q32, mut v32) = (single(&theta), single(&dtheta));
        let (of_single, here) = (Batch::<f32>::of(&model), model.environment().into());
        let by = Method::Automatic;
        of_single.simulate(&mut q32, &mut v32, &single(&tau), &here, by, duration, steps).expect("motions");
        let apart = q32.iter().chain(&v32).zip(q.iter().chain(&v)).map(|(&a, b)| (f64::from(a) - b).abs());
        let apart = apart.fold(0.0, f64::max);
        println!("{}: f32 differs by {apart:.1e}", model.description().name);
        assert!(apart < 1e-3);
    }
}

#[test]
fn what_friction_holds_stays_unless_sticking_is_switched_off() {
    let mut robot = tree(2, 4, 0).description().clone();
    robot.joints.iter_mut().for_each(|joint| joint.friction = 1e4);
    let model = robot.build().expect("sound");
    let [theta, _, tau] = starts(&model);
    let still = vec![0.0; tau.len()];
    let environment = BatchEnvironment::from(model.environment());
    let (mut q, mut v) = (theta.clone(), still.clone());
    let batch = Batch::new(&model);
    batch.simulate(&mut q, &mut v, &tau, &environment, Method::Automatic, 1.0, 100).expect("motions");
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("held: θ moves {:.1e}, θ̇ is {:.1e}", apart(&q, &theta), apart(&v, &still));
    assert!(apart(&q, &theta) < 1e-12 && apart(&v, &still) < 1e-12);
    let smooth = batch.with_sticking(false);
    let (mut q, mut v) = (theta.clone(), still);
    smooth.simulate(&mut q, &mut v, &tau, &environment, Method::RungeKutta4, 1e-3, 1).expect("motions");
    assert!(q != theta, "μ sgn θ̇ is 0 at rest");
    let error = smooth.simulate(&mut q, &mut v, &tau, &environment, Method::MoreauJean, 1e-3, 1).expect_err("refused");
    assert!(error.to_string().contains("the method is Moreau-Jean"), "{error}");
}

/// Friction of a mimic joint alone, such as a gripper's finger, holds its source.
#[test]
fn friction_of_a_mimic_joint_holds() {
    let mut robot = tree(2, 4, 1).description().clone();
    for joint in &mut robot.joints {
        joint.friction = if joint.mimic.is_some() { 1e6 } else { 0.0 };
    }
    let source =
        robot.joints.iter().find_map(|joint| Some(joint.mimic.as_ref()?.joint.clone())).expect("a mimic joint");
    let model = robot.build().expect("sound");
    let held = model.joint_names().position(|name| name == source).expect("an independent joint");
    let [theta, _, tau] = starts(&model);
    let (mut q, mut v) = (theta.clone(), vec![0.0; tau.len()]);
    let environment = BatchEnvironment::from(model.environment());
    let batch = Batch::new(&model);
    batch.simulate(&mut q, &mut v, &tau, &environment, Method::Automatic, 0.1, 100).expect("motions");
    for k in 0..ROBOTS {
        let (j, n) = (held, model.n());
        assert!((q[k * n + j] - theta[k * n + j]).abs() < 1e-12 && v[k * n + j].abs() < 1e-12, "{}", v[k * n + j]);
    }
}

#[test]
fn environments_and_parameters_of_each_robot_count() {
    let model = floating_tree(2, 3, 0);
    let (nq, n, p) = (model.nq(), model.n(), model.parameter_count());
    let [theta, dtheta, tau] = starts(&model);
    let frame = model.frames().last().expect("a frame").0;
    let wrenches: Vec<f64> = (0..6 * ROBOTS).map(|k| 0.1 * (k % 7) as f64).collect();
    let gravity: Vec<f64> = (0..3 * ROBOTS).map(|k| -3.0 + 0.2 * (k % 5) as f64).collect();
    let own = model.parameters();
    let parameters: Vec<f64> = (0..ROBOTS * p).map(|i| own[i % p] * (1.0 + 0.01 * (i / p) as f64)).collect();
    let tables = [(frame, &wrenches[..])];
    let environment = BatchEnvironment::from(model.environment()).with_wrenches(&tables);
    let environment = BatchEnvironment { gravity: Some(&gravity), parameters: Some(&parameters), ..environment };
    let (mut q, mut v) = (theta.clone(), dtheta.clone());
    Batch::new(&model).simulate(&mut q, &mut v, &tau, &environment, Method::Automatic, 0.05, 20).expect("motions");
    for k in 0..ROBOTS {
        struct Own<'a>(&'a [f64], mozzi::FrameId, Wrench);
        impl Input for Own<'_> {
            fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
                tau.iter_mut().zip(self.0).for_each(|(tau, x)| *tau += x);
                Ok(())
            }
            fn applied(
                &mut self,
                _: f64,
                _: &[f64],
                _: &[f64],
                wrenches: &mut Vec<(mozzi::FrameId, Wrench)>,
            ) -> Result<(), mozzi_sim::Error> {
                wrenches.push((self.1, self.2));
                Ok(())
            }
        }
        let F = Wrench::from_array([0, 1, 2, 3, 4, 5].map(|i| wrenches[6 * k + i]));
        let own: Model = model.with_parameters(&parameters[k * p..][..p]);
        let g = Vec3([gravity[3 * k], gravity[3 * k + 1], gravity[3 * k + 2]]);
        let options = Options { gravity: Some(g), ..Options::new(0.05, 20) };
        let start = [&theta[k * nq..][..nq], &dtheta[k * n..][..n]];
        let alone = mozzi_sim::simulate(&own, start[0], start[1], Own(&tau[k * n..][..n], frame, F), &options)
            .expect("a motion");
        assert_eq!(&q[k * nq..][..nq], alone.last().theta);
        assert_eq!(&v[k * n..][..n], alone.last().dtheta);
    }
    // {s} that moves is known to the batch in registers alone
    let mut moving = model.environment();
    moving.base_twist.v = Vec3([1.0, 0.0, 0.0]);
    let error = Batch::new(&model).simulate(&mut q, &mut v, &tau, &moving.into(), Method::Automatic, 0.05, 20);
    assert!(error.expect_err("refused").to_string().contains("with_sticking(false)"));
}

#[test]
fn robots_with_contacts_run_each_as_alone() {
    let model = floating_tree(4, 3, 0);
    let (nq, n) = (model.nq(), model.n());
    let [mut theta, dtheta, _] = starts(&model);
    let contacts = || {
        let point = |(frame, name): (_, &str)| ContactPoint::new(name, frame, Vec3::zero(), 0.6);
        Contacts { points: model.frames().take(5).map(point).collect(), planes: vec![Plane::ground()] }
    };
    for theta in theta.chunks_exact_mut(nq) {
        theta[6] += 0.02 - contacts().gaps(&model, 0.0, theta).into_iter().fold(f64::INFINITY, f64::min);
    }
    let simulation = |_| Simulation { contacts: contacts(), ..Simulation::new(Options::new(0.1, 50)) };
    let batch = Batch::new(&model).with_threads(2).expect("threads");
    let go_on = |_| ControlFlow::Continue(());
    let runs = batch.simulate_each([&theta, &dtheta], simulation, |_| Box::new(mozzi_sim::Zero), go_on);
    let runs = runs.expect("motions");
    assert_eq!(runs.len(), ROBOTS);
    for (k, run) in runs.iter().enumerate() {
        let start = [&theta[k * nq..][..nq], &dtheta[k * n..][..n]];
        let alone = simulation(k).run(&model, start[0], start[1], mozzi_sim::Zero).expect("a motion");
        assert_eq!(*run, alone);
    }
    assert!(runs.iter().filter(|run| !run.contact_events.is_empty()).count() > ROBOTS / 2);
    // the first that fails is named; progress may stop all
    let mut broken = dtheta.clone();
    broken[3 * n] = f64::NAN;
    let zero = |_| -> Box<dyn Input> { Box::new(mozzi_sim::Zero) };
    let error = batch.simulate_each([&theta, &broken], simulation, zero, go_on).expect_err("NaN");
    assert!(error.to_string().starts_with("state 3 (counted from 0)"), "{error}");
    let stopped = batch.simulate_each([&theta, &dtheta], simulation, zero, |_| ControlFlow::Break(()));
    assert!(stopped.expect("motions").iter().all(|run| !run.motion.complete && run.motion.len() == 2));
}
