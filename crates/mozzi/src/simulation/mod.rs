//! Simulation: forward dynamics, integrated (Modern Robotics, section 8.5).
//!
//! > q̇₁ = q₂,  q̇₂ = FD(q₁, q₂, τ, F),  with q₁ = θ and q₂ = θ̇
//!
//! [`Model::simulate`] takes a start, an [`Input`] (τ and the wrenches on the environment, by functions or tables) and
//! [`Options`], and returns a [`Trajectory`] with its energies. {s} is at rest. Dry friction
//! sticks, see [`Friction`]; planes stop [`Contacts`].
//!
//! | [`Method`] | order | step | for |
//! |---|---|---|---|
//! | `Euler`, `SemiImplicitEuler`, `RungeKutta4` | 1, 1, 4 | fixed | the book's loop; real time |
//! | `DormandPrince` | 5 | adaptive | smooth motions, to a tolerance |
//! | `Midpoint` | 2 | fixed | long motions: the energy's error is bounded |
//! | `MoreauJean` | 2 | fixed | dry friction, stops, contacts: `Automatic` is it for them, else `RungeKutta4` |
//!
//! A robot with [constraints](crate::constraints) moves by its constrained forward dynamics, and is brought back onto
//! the constraints after each step: [`Ending::closing`] reports by how much.
//!
//! Dry friction, stops and contacts are solved for as impulses of a step ([`one_sided`](crate::one_sided)), by
//! `MoreauJean` alone; other methods are for smooth motions, and refuse them. A step ends where a joint with dry
//! friction comes to rest. [`Ending::one_sided`] reports the residuals.
//!
//! Gradients of a loss through N steps, by start, torques and parameters: [`Rollout`].
//!
//! All methods integrate on SE(3) if the base floats, and all run in one loop, [`Simulation`]. It locates [`Event`]s,
//! zeros of functions of (t, θ, θ̇), on the polynomial between two steps, treats the joints' limits by a [`Policy`],
//! and passes each row to a [`Recorder`], so that a long motion need not be kept in memory.

mod closing;
mod condition;
mod contact;
mod course;
mod dense;
mod dormand_prince;
mod driven;
mod equation;
mod events;
mod factored_mass;
mod friction;
mod impulse_steps;
mod impulses;
mod input;
mod method;
mod midpoint;
mod moreau;
mod motion;
mod options;
mod policy;
mod recorder;
mod rollout;
mod run;
mod sensitivity;
mod stall;
mod state;
mod stops;
mod table;
mod trajectory;

#[cfg(test)]
mod against_stops;
#[cfg(test)]
mod balls;
#[cfg(test)]
mod free_base;
#[cfg(test)]
mod robots;

pub use closing::{Closer, Closing};
pub use contact::{ContactChange, ContactEvent, ContactPoint, Contacts, Plane, PlaneMotion, Support};
pub use dormand_prince::dormand_prince_by_equal_steps;
pub use equation::{Equation, ForwardDynamics, Powers, forward_dynamics_of};
pub use events::{Direction, Event, EventFunction, Occurrence};
pub use impulses::OneSidedAccount;
pub use input::{GravityCompensation, Input, Zero, applied, torque};
pub use method::{Explicit, Method};
pub use motion::Motion;
pub use options::{Friction, LARGEST, Options};
pub use policy::Policy;
pub use recorder::{Account, Recorder, Thinned, stride};
pub use rollout::{
    Cotangents, ExplicitSteps, ParameterGradient, Rollout, RolloutGradient, RolloutStates, Stage, StageDynamics,
    StartGradient, Stepper, Steps, Tables,
};
pub use run::{Ending, Run, Simulation};
pub use sensitivity::{EndSensitivity, StepSensitivity};
pub use stops::Stopped;
pub use table::{Outside, Table, TorqueTable, WrenchTable};
pub use trajectory::{Energy, Sample, Trajectory};

use crate::model::{Error, Model};

impl Model<f64> {
    /// The motion from (θ(0), θ̇(0)) under an input, by N steps of δt = t_f / N.
    ///
    /// The input is called at the time and in the state of each stage of each step. A step costs one
    /// forward dynamics (O(n)) for the Euler methods and four for Runge-Kutta 4, and allocates nothing; six for
    /// Dormand-Prince.
    ///
    /// ```
    /// use mozzi::model::description::{Joint, JointKind};
    /// use mozzi::simulation::{self, Options};
    /// use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};
    /// // a pendulum of 1 kg at 1 m, hanging along −z at θ = 0, turning about y
    /// let axis = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3])?);
    /// let pendulum = Description::new("pendulum")
    ///     .link("base", SpatialInertia::zero())
    ///     .link("bob", SpatialInertia::point_mass(1.0, Vec3([0.0, 0.0, -1.0])))
    ///     .joint(Joint::new("pivot", "base", "bob", SE3::identity(), axis))
    ///     .build()?;
    ///
    /// let fall = pendulum.simulate(&[1.0], &[0.0], simulation::Zero, &Options::new(2.0, 2000))?;
    /// assert_eq!(fall.len(), 2001);
    /// assert!(fall.largest_drift() < 1e-10);
    ///
    /// let brake = simulation::torque(|_t, _theta, dtheta, tau| tau[0] -= 5.0 * dtheta[0]);
    /// let end = pendulum.simulate(&[1.0], &[0.0], brake, &Options::with_step(20.0, 0.01)?)?;
    /// assert!(end.last().theta[0].abs() < 1e-10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// [`Simulation::run`] [reports](Policy::Report) limits that were exceeded; this method does not.
    ///
    /// # Errors
    /// [`Error::WrongLength`] or [`Error::BadArgument`] for an invalid start, invalid options, or an input that is not
    /// finite; [`Error::SingularMassMatrix`]; [`Error::Diverged`] if the state becomes infinite or NaN;
    /// [`Error::Stalled`], [`Error::NoConvergence`]; the input's own errors.
    pub fn simulate(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        input: impl Input,
        options: &Options,
    ) -> Result<Trajectory, Error> {
        let unseen = options.joint_limits == Policy::Report;
        let joint_limits = if unseen { Policy::Ignore } else { options.joint_limits };
        let simulation = Simulation::new(Options { joint_limits, ..*options });
        simulation.run(self, theta, dtheta, input).map(|run| run.motion)
    }
}

#[cfg(test)]
mod tests {
    use super::robots::{INERTIA, difference, double_pendulum, pendulum};
    use super::*;
    use crate::model::description::Joint;
    use crate::{Description, SpatialInertia, Wrench, testing};
    use alloc::vec::Vec;
    use core::f64::consts::PI;
    use core::ops::ControlFlow;

    /// T = 2π √(l/g) / agm(1, cos(θ₀/2)), exactly.
    fn period(amplitude: f64) -> f64 {
        let (mut a, mut b) = (1.0, (0.5 * amplitude).cos());
        for _ in 0..8 {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        2.0 * PI * (0.7_f64 / 9.81).sqrt() / a
    }

    #[test]
    fn a_pendulum_keeps_its_exact_period() {
        for amplitude in [0.1, 1.0, 3.0] {
            let T = period(amplitude);
            let options = Options { record_every: 500, ..Options::new(T, 2000) };
            let swing = pendulum(0.0, 0.0).simulate(&[amplitude], &[0.0], Zero, &options).expect("a motion");
            let angles = [amplitude, 0.0, -amplitude, 0.0, amplitude];
            assert!(difference(&swing.theta, &angles) < 1e-9, "{:?}", swing.theta);
            // at the bottom all energy is kinetic: ½ I θ̇² = m g l (1 − cos θ₀)
            let bottom = (2.0 * 2.0 * 9.81 * 0.7 * (1.0 - amplitude.cos()) / INERTIA).sqrt();
            assert!(difference(&swing.dtheta, &[0.0, -bottom, 0.0, bottom, 0.0]) < 1e-9);
        }
    }

    #[test]
    fn what_is_recorded() {
        let robot = double_pendulum();
        let start = ([0.4, -0.2], [0.1, 0.3]);
        let every = robot.simulate(&start.0, &start.1, Zero, &Options::new(1.0, 10)).expect("a motion");
        assert!(every.complete && every.steps == 10 && every.len() == 11);
        let options = Options { record_every: 4, ..Options::new(1.0, 10) };
        let some = robot.simulate(&start.0, &start.1, Zero, &options).expect("a motion");
        assert_eq!(some.t, [0.0, 0.4, 0.8, 1.0]);
        for (sample, k) in some.samples().zip([0, 4, 8, 10]) {
            assert_eq!(sample, every.sample(k));
        }
        // energies against the methods of the model
        for sample in every.samples() {
            let K = robot.kinetic_energy(sample.theta, sample.dtheta).expect("lengths");
            let P = robot.potential_energy(sample.theta).expect("lengths");
            assert_eq!((sample.energy.kinetic, sample.energy.potential), (K, P));
        }
        let still = robot.simulate(&start.0, &start.1, Zero, &Options::new(0.0, 1)).expect("no motion");
        assert_eq!(still.len(), 1);
        assert_eq!(still.last().theta, start.0);
    }

    #[test]
    fn progress_is_called_after_each_step_and_can_stop() {
        let (robot, simulation) = (pendulum(0.0, 0.0), Simulation::new(Options::new(1.0, 1000)));
        let run = |most: usize| {
            let mut times = Vec::new();
            let run = simulation.run_with_progress(&robot, &[1.0], &[0.0], Zero, |t| {
                times.push(t);
                if times.len() == most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            (run.expect("a motion").motion, times)
        };
        let (whole, times) = run(usize::MAX);
        assert!(whole.complete && times == whole.t[1..]);
        let (stopped, _) = run(300);
        assert!(!stopped.complete && stopped.steps == 300 && stopped.last().t == 0.3);
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let robot = double_pendulum();
        let fine = Options::new(1.0, 10);
        let run = |theta: &[f64], dtheta: &[f64], options: &Options| robot.simulate(theta, dtheta, Zero, options);
        assert!(matches!(run(&[0.0], &[0.0; 2], &fine), Err(Error::WrongLength { what: "theta", found: 1, .. })));
        assert!(matches!(run(&[0.0; 2], &[0.0; 3], &fine), Err(Error::WrongLength { what: "dtheta", found: 3, .. })));
        let bad = |theta: &[f64], options: Options| match run(theta, &[0.0; 2], &options) {
            Err(Error::BadArgument { what, .. }) => what,
            other => panic!("{other:?}"),
        };
        assert_eq!(bad(&[0.0, f64::NAN], fine), "theta");
        assert_eq!(bad(&[0.0; 2], Options { steps: 0, ..fine }), "steps");
        assert_eq!(bad(&[0.0; 2], Options { record_every: 0, ..fine }), "record_every");
        assert_eq!(bad(&[0.0; 2], Options { gravity: Some(crate::Vec3([0.0, f64::NAN, 0.0])), ..fine }), "gravity");
        for duration in [-1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(bad(&[0.0; 2], Options { duration, ..fine }), "duration");
        }
        for slip_speed in [0.0, -1.0, f64::NAN] {
            assert_eq!(bad(&[0.0; 2], Options { friction: Friction::Smooth { slip_speed }, ..fine }), "slip_speed");
        }
        let nan = robot.simulate(&[0.0; 2], &[0.0; 2], torque(|_, _, _, tau| tau[1] = f64::NAN), &fine);
        let message = nan.expect_err("NaN").to_string();
        assert!(message.contains("the input's torque") && message.contains("joint2"), "{message}");
        let tip = robot.frame("rod2").expect("there");
        let nan = robot.simulate(&[0.0; 2], &[0.0; 2], applied(tip, |_, _, _| Wrench::zero() * f64::NAN), &fine);
        assert!(nan.expect_err("NaN").to_string().contains("frame `rod2`"));
        let other = testing::tree(1, 9, 0).end_effector().expect("named");
        assert!(robot.simulate(&[0.0; 2], &[0.0; 2], applied(other, |_, _, _| Wrench::zero()), &fine).is_err());
    }

    #[test]
    fn a_blow_up_is_named() {
        // a spring too stiff for the step: explicit Euler multiplies its amplitude by 300 a step
        let spring = |_: f64, theta: &[f64], _: &[f64], tau: &mut [f64]| tau[0] = -1e9 * theta[0];
        let options = Options { method: Method::Euler, ..Options::new(10.0, 1000) };
        let error = pendulum(0.0, 0.0).simulate(&[1.0], &[0.0], torque(spring), &options).expect_err("too stiff");
        let Error::Diverged { joint, step, time, step_size, value, .. } = &error else { panic!("{error:?}") };
        assert!(joint == "pivot" && value.abs() > 1e150 && *step_size == 0.01);
        assert!(*step > 50 && *step < 75 && (time - *step as f64 * 0.01).abs() < 1e-9, "{error}");
        assert!(error.to_string().contains("a smaller step may help"));
    }

    #[test]
    fn a_singular_mass_matrix_is_named() {
        let kind = pendulum(0.0, 0.0).joints().next().expect("one").kind;
        let robot = Description::new("massless")
            .link("base", SpatialInertia::zero())
            .link("ghost", SpatialInertia::zero())
            .joint(Joint::new("hinge", "base", "ghost", crate::SE3::identity(), kind));
        let error = robot.build().expect("sound").simulate(&[0.0], &[0.0], Zero, &Options::new(1.0, 10));
        assert!(matches!(error, Err(Error::SingularMassMatrix { joint, .. }) if joint == "hinge"));
    }
}
