//! Inputs of a simulated robot.

mod table;

pub use table::{Outside, Table, TorqueTable, WrenchTable};

use crate::Error;
use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::Workspace;
use mozzi::dynamics::{add_spring_forces, gravity_forces};
use mozzi::linalg::Vec3;
use mozzi::model::{Environment, FrameId, Freedom, Model};
use mozzi::spatial::Wrench;

/// The motors' τ and the wrenches that the robot applies *to* the environment, at time t in the state (θ, θ̇).
///
/// Each input adds its part: τ starts at zero and `wrenches` empty, so a pair of inputs `(a, b)` is an input, their
/// sum. Inputs are called once at each stage of a step, in the order of time (Runge-Kutta: t, t + h/2 twice, t + h) and
/// once at the end; an input with internal state must expect that.
pub trait Input {
    /// Adds to τ, n entries: N m (revolute, helical) or N (prismatic).
    ///
    /// # Errors
    /// Any reason why τ is unknown, such as the end of a table.
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        let _ = (t, theta, dtheta, tau);
        Ok(())
    }

    /// Appends wrenches, each applied by a frame to the environment, in that frame's coordinates.
    ///
    /// # Errors
    /// As for [`torque`](Self::torque).
    fn applied(
        &mut self,
        t: f64,
        theta: &[f64],
        dtheta: &[f64],
        wrenches: &mut Vec<(FrameId, Wrench)>,
    ) -> Result<(), Error> {
        let _ = (t, theta, dtheta, wrenches);
        Ok(())
    }

    /// Adds −∂τ_j/∂θ_j and −∂τ_j/∂θ̇_j of each velocity, as far as they are known: the [Moreau-Jean
    /// step](crate::Method::MoreauJean) is implicit in them, so that stiff controllers do not need short steps. They do
    /// not change what it converges to.
    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        let _ = (stiffness, damping);
    }
}

macro_rules! forward_to {
    (|$s:ident| $($inner:expr),*) => {
        fn torque(&mut $s, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
            $($inner.torque(t, theta, dtheta, tau)?;)*
            Ok(())
        }
        fn applied(&mut $s, t: f64, theta: &[f64], dtheta: &[f64], wrenches: &mut Vec<(FrameId, Wrench)>) -> Result<(), Error> {
            $($inner.applied(t, theta, dtheta, wrenches)?;)*
            Ok(())
        }
        fn gains(&$s, stiffness: &mut [f64], damping: &mut [f64]) {
            $($inner.gains(stiffness, damping);)*
        }
    };
}
impl<I: Input + ?Sized> Input for &mut I {
    forward_to!(|self| (**self));
}
impl<I: Input + ?Sized> Input for Box<I> {
    forward_to!(|self| (**self));
}
/// Both.
impl<A: Input, B: Input> Input for (A, B) {
    forward_to!(|self| self.0, self.1);
}

/// No motors, no contact: the robot falls.
#[derive(Clone, Copy, Debug, Default)]
pub struct Zero;
impl Input for Zero {}

/// τ = g(θ) + k(θ − θ₀), which holds the robot against gravity and its springs and does not compensate friction: a
/// robot at rest stays, a moving one coasts. A floating base has no motors: it falls. If a robot with
/// constraints has named [`motors`](mozzi::Description::motors), these alone produce the torques that hold it.
#[derive(Clone, Debug)]
pub struct GravityCompensation<'m> {
    model: &'m Model,
    gravity: Vec3,
    workspace: Workspace,
    g: Vec<f64>,
}

impl<'m> GravityCompensation<'m> {
    /// Against the model's own gravity.
    pub fn new(model: &'m Model) -> Self {
        Self::against(model, model.gravity())
    }

    /// Against another gravity, in {s} coordinates, m/s²: that of [`Options`](crate::Options), or a wrong one.
    pub fn against(model: &'m Model, gravity: Vec3) -> Self {
        GravityCompensation { model, gravity, workspace: Workspace::new(model), g: vec![0.0; model.n()] }
    }
}

impl Input for GravityCompensation<'_> {
    fn torque(&mut self, _: f64, theta: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        if theta.len() != self.model.nq() || tau.len() != self.model.n() {
            // made for another robot
            return Err(Error::Model(mozzi::Error::WrongLength {
                what: "theta",
                found: theta.len(),
                expected: self.model.nq(),
            }));
        }
        if self.model.constraint_rows() > 0 && self.model.description().motors.is_some() {
            let (still, environment) = (vec![0.0; tau.len()], Environment::with_gravity(self.gravity));
            let held = self.model.constrained_inverse_dynamics(theta, &still, &still, &environment, None)?;
            tau.iter_mut().zip(held.tau.iter()).for_each(|(sum, tau)| *sum += tau);
            return Ok(());
        }
        gravity_forces(self.model, theta, self.gravity, &mut self.workspace, &mut self.g);
        add_spring_forces(self.model, theta, &mut self.g);
        // nothing drives a floating base or a free body
        for place in self.model.places().iter().filter(|place| place.freedom != Freedom::Free) {
            place.velocities().for_each(|j| tau[j] += self.g[j]);
        }
        Ok(())
    }
}

/// Motors by a function: `torque(|t, theta, dtheta, tau| tau[0] += t)`.
pub fn torque(f: impl FnMut(f64, &[f64], &[f64], &mut [f64])) -> impl Input {
    struct Torque<F>(F);
    impl<F: FnMut(f64, &[f64], &[f64], &mut [f64])> Input for Torque<F> {
        fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
            self.0(t, theta, dtheta, tau);
            Ok(())
        }
    }
    Torque(f)
}

/// Contact by a function: the wrench that `frame` applies to the environment, in the frame's coordinates.
pub fn applied(frame: FrameId, f: impl FnMut(f64, &[f64], &[f64]) -> Wrench) -> impl Input {
    struct Applied<F>(FrameId, F);
    impl<F: FnMut(f64, &[f64], &[f64]) -> Wrench> Input for Applied<F> {
        fn applied(
            &mut self,
            t: f64,
            theta: &[f64],
            dtheta: &[f64],
            wrenches: &mut Vec<(FrameId, Wrench)>,
        ) -> Result<(), Error> {
            wrenches.push((self.0, self.1(t, theta, dtheta)));
            Ok(())
        }
    }
    Applied(frame, f)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate;
    use crate::tests::robots::{difference, double_pendulum, smooth_tree};
    use crate::{Friction, Method, Options};
    use mozzi::dynamics::tip_forces;
    use mozzi::testing;

    #[test]
    fn gravity_compensation_holds_the_robot() {
        for (seed, mimics) in [(1, 0), (2, 2)] {
            let model = testing::tree(seed, 7, mimics);
            let [theta, _, _] = testing::state(&model, 7);
            let rest = vec![0.0; model.n()];
            for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4] {
                let friction = Friction::Smooth { slip_speed: 0.1 };
                let options = Options { method, friction, ..Options::new(0.5, 100) };
                let motion =
                    simulate(&model, &theta, &rest, GravityCompensation::new(&model), &options).expect("holds");
                assert!(difference(motion.last().theta, &theta) < 1e-9, "{:?}", motion.last());
                // and the motors' torques equal those of the model's method, and do no work
                let g = model.gravity_forces(&theta).expect("lengths") + model.spring_forces(&theta).expect("lengths");
                assert!(difference(motion.sample(0).tau, g.as_slice()) == 0.0);
                assert!(motion.last().energy.motor_work.abs() < 1e-8);
            }
        }
    }

    #[test]
    fn gravity_can_be_another() {
        let robot = double_pendulum();
        let moon = Vec3([0.0, 0.0, -1.62]);
        let options = Options { gravity: Some(moon), ..Options::new(1.0, 100) };
        let held = simulate(&robot, &[1.0, 0.5], &[0.0; 2], GravityCompensation::against(&robot, moon), &options);
        assert!(difference(held.expect("holds").last().theta, &[1.0, 0.5]) < 1e-12);
        // the same by a description with that gravity
        let mut description = robot.description().clone();
        description.gravity = moon.0;
        let there = description.build().expect("sound");
        let a = simulate(&robot, &[1.0, 0.5], &[0.0; 2], Zero, &options).expect("a motion");
        let b = simulate(&there, &[1.0, 0.5], &[0.0; 2], Zero, &Options::new(1.0, 100)).expect("a motion");
        assert_eq!(a, b);
    }

    #[test]
    fn a_wrench_on_the_environment_is_a_torque_less() {
        let model = smooth_tree(5, 6, 1);
        let tip = model.end_effector().expect("named");
        let [theta, dtheta, _] = testing::state(&model, 8);
        let push = |t: f64| testing::wrench(3) * (1.0 + t);
        let options = Options::new(0.2, 200);
        let pushing = simulate(&model, &theta, &dtheta, applied(tip, |t, _, _| push(t)), &options).expect("a motion");
        // −JᵀF by the motors
        let mut workspace = Workspace::new(&model);
        let braking = torque(|t, theta, _, tau| {
            tip_forces(&model, theta, &[(tip, push(t))], &mut workspace, tau);
            tau.iter_mut().for_each(|x| *x = -*x);
        });
        let braked = simulate(&model, &theta, &dtheta, braking, &options).expect("a motion");
        assert!(difference(&pushing.theta, &braked.theta) < 1e-10);
        let (given, done) = (pushing.last().energy.applied_work, braked.last().energy.motor_work);
        assert!(given.abs() > 0.01 && (given + done).abs() < 1e-10 * given.abs().max(1.0), "{given} {done}");
    }

    #[test]
    fn inputs_add_up_and_can_be_kept() {
        let robot = double_pendulum();
        let options = Options::new(0.5, 50);
        let mut calls = 0;
        let mut counting = torque(|_, _, _, tau| {
            calls += 1;
            tau[0] += 1.0;
        });
        let boxed: Box<dyn Input> = Box::new(torque(|_, _, _, tau| tau[0] += 2.0));
        let sum = simulate(&robot, &[0.0; 2], &[0.0; 2], (&mut counting, boxed), &options).expect("a motion");
        drop(counting);
        assert_eq!(calls, 1 + 4 * 50);
        let whole = simulate(&robot, &[0.0; 2], &[0.0; 2], torque(|_, _, _, tau| tau[0] = 3.0), &options);
        assert_eq!(sum, whole.expect("a motion"));
    }
}
