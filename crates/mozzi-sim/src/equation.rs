//! The differential equation of a driven robot: θ̈ = FD(θ, θ̇, τ, F), and the powers.
//!
//! Forward dynamics uses the machine's fused multiply-add, if `std` is there to detect it, or [another
//! implementation](ForwardDynamics).

use crate::Error;
use crate::options::{LARGEST, check};
use crate::trajectory::Energy;
use crate::{Friction, Input, Options};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::Workspace;
use mozzi::dynamics::{add_spring_forces, kinetic_energy, newton_euler, potential_energy};
use mozzi::fast;
use mozzi::kinematics::{body_jacobian, twist_of};
use mozzi::linalg::Vec3;
use mozzi::model::{Environment, FrameId, Model};
use mozzi::quantities::{self, Query};
use mozzi::scalar::Scalar;
use mozzi::spatial::{Twist, Wrench};

/// Powers in watts: of the motors, of friction, and given to the environment.
pub type Powers = [f64; 3];

/// An implementation of θ̈ that replaces the kernels: a program for one robot, with its own gravity and no applied
/// wrenches, such as `mozzi_engine::Compiled`. In all other cases the kernels are used.
pub trait ForwardDynamics {
    /// The robot.
    fn model(&self) -> &Model;

    /// Writes θ̈. True if all pivots of M are well above rounding error: see [`Pivots`](mozzi::Pivots).
    ///
    /// # Panics
    /// On slices of a wrong length.
    fn write(&self, theta: &[f64], dtheta: &[f64], tau: &[f64], ddtheta: &mut [f64]) -> bool;
}

/// A robot, its input, and memory: the equation that a [`Method`](crate::Method), or your own, integrates.
pub struct Equation<'m, I> {
    model: &'m Model,
    pub(crate) options: Options,
    pub(crate) input: I,
    pub(crate) gravity: Vec3,
    /// Neither damping nor Coulomb friction at any joint.
    is_frictionless: bool,
    /// δt and the step that is being taken, for errors.
    step_size: f64,
    step: usize,
    /// In place of the kernels.
    other: Option<&'m dyn ForwardDynamics>,
    /// The motors' τ of the last evaluation.
    pub(crate) tau: Vec<f64>,
    /// τ as passed to forward dynamics.
    pub(crate) force: Vec<f64>,
    /// λ of the last evaluation.
    lambda: Vec<f64>,
    /// True if dry friction is applied as impulses instead of in θ̈.
    pub(crate) has_impulses: bool,
    /// Further constant forces of a step, −Jᵀp/Δt, whose work is not part of the powers.
    wrenches: Vec<(FrameId, Wrench)>,
    columns: Vec<Twist>,
    fast: fast::Workspace,
    workspace: Workspace,
}

impl<'m, I: Input> Equation<'m, I> {
    /// The equation at step 0. Only the options' gravity and friction are used; the other options are for
    /// [`Simulation`](crate::Simulation).
    pub fn new(model: &'m Model, input: I, options: &Options) -> Self {
        Equation {
            model,
            options: *options,
            input,
            gravity: options.gravity.unwrap_or(model.gravity()),
            is_frictionless: model.damping().iter().chain(model.friction()).all(|&x| x == 0.0),
            step_size: options.step(),
            step: 0,
            other: None,
            tau: vec![0.0; model.n()],
            force: vec![0.0; model.n()],
            lambda: vec![0.0; model.constraint_rows()],
            has_impulses: false,
            wrenches: Vec::new(),
            columns: vec![Twist::zero(); model.n()],
            fast: fast::Workspace::new(model),
            workspace: Workspace::new(model),
        }
    }

    /// θ̈ by another implementation, if there is one, no wrench is applied and gravity is the robot's own.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] if it is for another robot.
    pub fn with_forward_dynamics(mut self, other: Option<&'m dyn ForwardDynamics>) -> Result<Self, Error> {
        let Some(other) = other else { return Ok(self) };
        let (mine, its) = (self.model.description(), other.model().description());
        check(mine == its, "the forward dynamics", format!("that of another robot, `{}`", its.name), "this robot's")?;
        let has_same_parameters = self.model.parameters() == other.model().parameters();
        check(has_same_parameters, "the forward dynamics", "that of a robot with other parameters", "this robot's")?;
        if self.gravity == self.model.gravity() && self.lambda.is_empty() {
            self.other = Some(other);
        }
        Ok(self)
    }

    /// The robot.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// Sets which step is being taken, from 1, and its length in seconds: for errors.
    pub fn at_step(&mut self, step: usize, step_size: f64) {
        (self.step, self.step_size) = (step, step_size);
    }

    /// The motors' τ of the last evaluation.
    pub fn tau(&self) -> &[f64] {
        &self.tau
    }

    /// Calls the input, writes θ̈ and returns the powers. O(n), no allocation but the input's.
    ///
    /// # Errors
    /// [`Error::Diverged`], [`mozzi::Error::SingularMassMatrix`], [`mozzi::Error::BadArgument`] for an input that is
    /// not finite, and the input's own errors.
    ///
    /// # Panics
    /// On slices of a wrong length.
    pub fn evaluate(&mut self, t: f64, theta: &[f64], dtheta: &[f64], ddtheta: &mut [f64]) -> Result<Powers, Error> {
        self.call_input(t, theta, dtheta)?;
        let friction_power = self.friction(dtheta);
        let environment = Environment { applied: &self.wrenches, ..Environment::with_gravity(self.gravity) };
        let state = [theta, dtheta, &self.force];
        let is_clear = match &mut self.other {
            Some(other) if self.wrenches.is_empty() => other.write(theta, dtheta, &self.force, ddtheta),
            _ => {
                let query = self.query();
                let outputs = &mut [&mut *ddtheta, &mut self.lambda][..query.declaration().outputs.len()];
                fast::evaluate(&query, self.model, &state, &environment, &mut self.fast, outputs);
                self.fast.are_pivots_clear(&query)
            }
        };
        // one loop for the motors' power and all tests; what fails is named afterwards
        let (mut motor_power, mut is_fine) = (0.0, are_below(theta, LARGEST));
        for ((&tau, &rate), ddtheta) in self.tau.iter().zip(dtheta).zip(&*ddtheta) {
            motor_power += tau * rate;
            is_fine &= (tau.abs() < f64::INFINITY) & (rate.abs() < LARGEST) & (ddtheta.abs() < LARGEST);
        }
        if !is_fine || !is_clear {
            self.bounded("theta", t, theta)?;
            self.bounded("dtheta", t, dtheta)?;
            self.check_torque(t)?;
        }
        if !is_clear {
            // a mass matrix of such a state is singular by rounding: the motion diverged before
            self.bounded_by(ABSURD, "theta", t, theta)?;
            self.bounded_by(ABSURD, "dtheta", t, dtheta)?;
            self.model.compute(self.query(), &state, &environment)?; // names what is singular, if anything is
        }
        let applied_power = self.applied_power(theta, dtheta);
        if !is_fine {
            self.bounded("ddtheta", t, ddtheta)?;
        }
        Ok([motor_power, friction_power, applied_power])
    }

    fn query(&self) -> Query<'static> {
        forward_dynamics_of(self.model)
    }

    /// The energies of a state, with works: of the motors, lost in friction, given to the environment.
    ///
    /// # Panics
    /// On slices of a wrong length.
    pub fn energy(
        &mut self,
        theta: &[f64],
        dtheta: &[f64],
        [motor_work, friction_loss, applied_work]: Powers,
    ) -> Energy {
        let workspace = &mut self.workspace;
        Energy {
            kinetic: kinetic_energy(self.model, theta, dtheta, Twist::zero(), workspace),
            potential: potential_energy(self.model, theta, self.gravity, workspace),
            motor_work,
            friction_loss,
            applied_work,
        }
    }

    /// τ − h − Mθ̈ − k(θ − θ₀) − dθ̇: the forces that act on the joints, without dry friction and constraints. Returns
    /// the power given to the environment.
    pub(crate) fn smooth_force(
        &mut self,
        t: f64,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        force: &mut [f64],
    ) -> Result<f64, Error> {
        self.bounded("theta", t, theta)?;
        self.bounded("dtheta", t, dtheta)?;
        self.ask_input(t, theta, dtheta)?;
        let environment = Environment { applied: &self.wrenches, ..Environment::with_gravity(self.gravity) };
        for j in 0..force.len() {
            force[j] = self.model.armature()[j] * ddtheta[j];
        }
        newton_euler(self.model, theta, dtheta, ddtheta, &environment, &mut self.workspace, force);
        add_spring_forces(self.model, theta, force);
        for j in 0..force.len() {
            force[j] =
                self.tau[j] - force[j] - self.model.damping()[j] * dtheta[j] - self.smooth_friction(j, dtheta[j]);
        }
        Ok(self.applied_power(theta, dtheta))
    }

    /// Friction of a velocity, without damping, if it is smooth.
    fn smooth_friction(&self, j: usize, rate: f64) -> f64 {
        match self.options.friction {
            Friction::Coulomb => 0.0,
            Friction::Smooth { slip_speed } => self.model.friction()[j] * Scalar::tanh(rate / slip_speed),
        }
    }

    /// The power of smooth friction.
    pub(crate) fn smooth_friction_power(&self, dtheta: &[f64]) -> f64 {
        dtheta.iter().enumerate().map(|(j, &rate)| rate * self.smooth_friction(j, rate)).sum()
    }

    /// Calls the input for the motors' τ of a row.
    pub(crate) fn find_tau(&mut self, t: f64, theta: &[f64], dtheta: &[f64]) -> Result<(), Error> {
        self.ask_input(t, theta, dtheta)
    }

    /// Checks that velocities are below [`LARGEST`].
    pub(crate) fn check_velocities(&self, t: f64, dtheta: &[f64]) -> Result<(), Error> {
        self.bounded("dtheta", t, dtheta)
    }

    /// Calls the input, and checks its numbers.
    fn ask_input(&mut self, t: f64, theta: &[f64], dtheta: &[f64]) -> Result<(), Error> {
        self.call_input(t, theta, dtheta)?;
        self.check_torque(t)
    }

    fn check_torque(&self, t: f64) -> Result<(), Error> {
        if are_below(&self.tau, f64::INFINITY) {
            return Ok(());
        }
        let j = self.tau.iter().position(|x| !x.is_finite()).unwrap_or_default();
        let found = format!("{} at joint `{}`, t = {t} s", self.tau[j], self.joint(j));
        check(false, "the input's torque", found, "a finite number")
    }

    /// Calls the input, and checks its wrenches.
    fn call_input(&mut self, t: f64, theta: &[f64], dtheta: &[f64]) -> Result<(), Error> {
        self.tau.fill(0.0);
        self.wrenches.clear();
        self.input.torque(t, theta, dtheta, &mut self.tau)?;
        self.input.applied(t, theta, dtheta, &mut self.wrenches)?;
        for &(frame, F) in &self.wrenches {
            let known = self.model.frames().len();
            check(frame.index() < known, "the frame of an input's wrench", frame.index(), "a frame of this model")?;
            if !F.to_array().iter().all(|x| x.is_finite()) {
                let found = format!("{:?} at frame `{}`, t = {t} s", F.to_array(), self.model.frame_name(frame));
                return check(false, "the input's wrench", found, "finite numbers");
            }
        }
        Ok(())
    }

    /// Writes the force for forward dynamics, which subtracts d θ̇ + μ sgn θ̇ itself: τ, and for smooth friction τ plus
    /// the difference of the two laws. Returns the power of friction.
    pub(crate) fn friction(&mut self, dtheta: &[f64]) -> f64 {
        if self.is_frictionless && !self.has_impulses {
            self.force.copy_from_slice(&self.tau);
            return 0.0;
        }
        let mut power = 0.0;
        for (j, &rate) in dtheta.iter().enumerate() {
            let (damping, mu) = (self.model.damping()[j], self.model.friction()[j]);
            let coulomb = mu * rate.sgn();
            let law = match self.options.friction {
                Friction::Coulomb if self.has_impulses => 0.0,
                Friction::Coulomb => coulomb,
                Friction::Smooth { .. } => self.smooth_friction(j, rate),
            };
            self.force[j] = self.tau[j] + (coulomb - law);
            power += rate * (damping * rate + law);
        }
        power
    }

    /// Σ 𝒱_bᵀF_b with 𝒱_b = J_b θ̇.
    fn applied_power(&mut self, theta: &[f64], dtheta: &[f64]) -> f64 {
        let power = |&(frame, F): &(FrameId, Wrench)| {
            body_jacobian(self.model, theta, frame, &mut self.columns);
            twist_of(&self.columns, dtheta).dot(F)
        };
        self.wrenches.iter().map(power).sum()
    }

    pub(crate) fn bounded(&self, quantity: &'static str, time: f64, values: &[f64]) -> Result<(), Error> {
        self.bounded_by(LARGEST, quantity, time, values)
    }

    fn bounded_by(&self, most: f64, quantity: &'static str, time: f64, values: &[f64]) -> Result<(), Error> {
        if are_below(values, most) {
            return Ok(());
        }
        let j = values.iter().position(|x| !(x.abs() < most)).unwrap_or_default();
        let joint = match quantity {
            "theta" => self.model.position_names().nth(j).unwrap_or_default().to_string(),
            _ => self.joint(j),
        };
        let value = values[j];
        Err(Error::Diverged { quantity, joint, value, step: self.step, time, step_size: self.step_size })
    }

    fn joint(&self, j: usize) -> String {
        self.model.velocity_names().nth(j).unwrap_or_default().to_string()
    }
}

/// No robot is there, rad, m, rad/s or m/s: a motion that is has diverged.
const ABSURD: f64 = 1e6;

/// True if all absolute values are below the bound; false for NaN. Branch-free.
fn are_below(values: &[f64], bound: f64) -> bool {
    values.iter().fold(true, |fine, x| fine & (x.abs() < bound))
}

/// The forward dynamics of a robot, with constraints if it has some. Its outputs are θ̈ and, with constraints, λ.
pub fn forward_dynamics_of(model: &Model) -> Query<'static> {
    match model.constraint_rows() {
        0 => quantities::ForwardDynamics.into(),
        _ => quantities::ConstrainedForwardDynamics.into(),
    }
}
