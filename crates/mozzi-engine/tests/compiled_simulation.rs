//! Simulation by machine code, compared with simulation by the kernels.
#![allow(missing_docs)]

use crate::common;

use common::{error, robots, state};
use mozzi::quantities::ForwardDynamics;
use mozzi::{Model, Vec3, Wrench};
use mozzi_engine::{Compiled, compile};
use mozzi_sim::{Equation, Friction, GravityCompensation, Input, Method, Options, Simulation, Zero, applied, torque};
use mozzi_sim::{Error, Trajectory};
use std::ops::ControlFlow;

fn compiled(model: &Model) -> Compiled {
    compile(model, &[ForwardDynamics.into()]).expect("no frames")
}

fn end(motion: Result<Trajectory, Error>) -> Vec<f64> {
    let motion = motion.expect("a motion");
    [motion.last().theta, motion.last().dtheta, motion.last().ddtheta].concat()
}

#[test]
fn a_motion_is_the_kernels() {
    for (name, model) in robots() {
        let robot = compiled(&model);
        let [theta, dtheta, tau] = &state(&model, 5);
        let motors = || torque(|_, _, _, x| x.iter_mut().zip(tau).for_each(|(x, tau)| *x += tau));
        for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4] {
            let friction = Friction::Smooth { slip_speed: 1.0 };
            let options = Options { method, friction, ..Options::new(4e-4, 40) }; // the robots' damped wrists are stiff
            let found = end(robot.simulate(theta, dtheta, motors(), &options));
            let expected = end(mozzi_sim::simulate(&model, theta, dtheta, motors(), &options));
            let error = error(&found, &expected);
            assert!(error < 1e-9, "{name}, {}: {error:e}", method.name());
        }
    }
}

#[test]
fn another_gravity_and_contact_go_to_the_kernels() {
    let model = common::tree(4, 6, 1).build().expect("sound");
    let (robot, [theta, dtheta, _]) = (compiled(&model), state(&model, 2));
    let frame = model.frames().last().expect("a frame").0;
    let moon = Options { gravity: Some(Vec3([0.0, 0.3, -1.62])), ..Options::new(0.1, 50) };
    let held = || GravityCompensation::against(&model, moon.gravity.expect("given"));
    assert_eq!(
        end(robot.simulate(&theta, &dtheta, held(), &moon)),
        end(mozzi_sim::simulate(&model, &theta, &dtheta, held(), &moon))
    );
    let push = || applied(frame, |_, _, _| Wrench::from_array([0.1, 0.2, -0.3, 4.0, -5.0, 6.0]));
    let here = Options::new(0.1, 50);
    assert_eq!(
        end(robot.simulate(&theta, &dtheta, push(), &here)),
        end(mozzi_sim::simulate(&model, &theta, &dtheta, push(), &here))
    );
}

#[test]
fn what_cannot_be_is_refused_as_by_the_model() {
    let model = common::tree(4, 6, 1).build().expect("sound");
    let (robot, [theta, dtheta, _], options) = (compiled(&model), state(&model, 2), Options::new(0.1, 10));
    let both = |theta: &[f64], dtheta: &[f64], input: fn() -> Box<dyn Input>, options: &Options| {
        let errors = [
            robot.simulate(theta, dtheta, input(), options),
            mozzi_sim::simulate(&model, theta, dtheta, input(), options),
        ];
        let [found, expected] = errors.map(|motion| motion.expect_err("refused").to_string());
        assert_eq!(found, expected);
    };
    both(&theta[1..], &dtheta, || Box::new(Zero), &options);
    both(&theta, &vec![f64::NAN; model.n()], || Box::new(Zero), &options);
    both(&theta, &dtheta, || Box::new(Zero), &Options { steps: 0, ..options });
    both(&theta, &dtheta, || Box::new(torque(|_, _, _, tau| tau[0] = f64::INFINITY)), &options);

    let other = common::tree(5, 6, 1).build().expect("sound");
    let error =
        Equation::new(&other, Zero, &options).with_forward_dynamics(Some(&robot)).map(|_| ()).expect_err("another's");
    assert!(error.to_string().contains("that of another robot, `tree 4`"), "{error}");
    let heavier = model.with_parameters(&model.parameters().iter().map(|x| 1.1 * x).collect::<Vec<_>>());
    let error =
        Equation::new(&heavier, Zero, &options).with_forward_dynamics(Some(&robot)).map(|_| ()).expect_err("light");
    assert!(error.to_string().contains("that of a robot with other parameters"), "{error}");

    // a massless tip that turns freely
    let mut massless = common::tree(2, 3, 0);
    let joint = massless.joints.last_mut().expect("one");
    (joint.armature, joint.damping, joint.friction) = (0.0, 0.0, 0.0);
    massless.links.last_mut().expect("one").inertia = mozzi::SpatialInertia::zero();
    let massless = massless.build().expect("sound");
    let error = compiled(&massless).simulate(&[0.0; 3], &[0.1; 3], Zero, &options).expect_err("singular");
    assert!(error.to_string().contains("singular at joint `joint3`"), "{error}");
}

#[test]
fn progress_can_stop_it() {
    let model = common::tree(4, 6, 0).build().expect("sound");
    let [theta, dtheta, _] = state(&model, 2);
    let half = |t: f64| if t >= 0.0499 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let robot = compiled(&model);
    let simulation = Simulation { forward_dynamics: robot.simulator(), ..Simulation::new(Options::new(0.1, 100)) };
    let motion = simulation.run_with_progress(&model, &theta, &dtheta, Zero, half).expect("a part").motion;
    assert!(!motion.complete && motion.steps == 50);
}

#[test]
fn not_compiled_it_is_the_kernels() {
    let model = common::tree(4, 6, 0).build().expect("sound");
    let robot = compile(&model, &[]).expect("nothing");
    assert!(robot.simulator().is_none());
    let ([theta, dtheta, _], options) = (state(&model, 2), Options::new(0.1, 10));
    let found = end(robot.simulate(&theta, &dtheta, Zero, &options));
    assert_eq!(found, end(mozzi_sim::simulate(&model, &theta, &dtheta, Zero, &options)));
}
