//! The differential equation of a driven robot: θ̈ = FD(θ, θ̇, τ, F), and the powers beside it.

use super::options::check;
use super::trajectory::Energy;
use super::{Friction, Input, Options};
use crate::dynamics::{forward_dynamics, kinetic_energy, potential_energy};
use crate::kinematics::link_twists;
use crate::linalg::Vec3;
use crate::model::{Environment, Error, FrameId, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

/// Powers in watts: of the motors, of friction, and what the environment takes.
pub(super) type Powers = [f64; 3];

/// Model, input and memory.
pub(super) struct Equation<'m, I> {
    model: &'m Model,
    input: I,
    gravity: Vec3,
    friction: Friction,
    /// δt and the step that is being taken, for errors.
    step_size: f64,
    pub step: usize,
    /// The motors' τ of the last evaluation.
    pub tau: Vec<f64>,
    /// τ as forward dynamics gets it.
    force: Vec<f64>,
    wrenches: Vec<(FrameId, Wrench)>,
    workspace: Workspace,
}

impl<'m, I: Input> Equation<'m, I> {
    pub fn new(model: &'m Model, input: I, options: &Options) -> Self {
        Equation {
            model,
            input,
            gravity: options.gravity.unwrap_or(model.gravity()),
            friction: options.friction,
            step_size: options.step(),
            step: 0,
            tau: vec![0.0; model.n()],
            force: vec![0.0; model.n()],
            wrenches: Vec::new(),
            workspace: Workspace::new(model),
        }
    }

    /// Writes θ̈ and returns the powers.
    pub fn evaluate(&mut self, t: f64, theta: &[f64], dtheta: &[f64], ddtheta: &mut [f64]) -> Result<Powers, Error> {
        self.bounded("theta", t, theta)?;
        self.bounded("dtheta", t, dtheta)?;
        self.ask_input(t, theta, dtheta)?;
        let friction_power = self.friction(dtheta);
        let environment = Environment { applied: &self.wrenches, ..Environment::with_gravity(self.gravity) };
        let workspace = &mut self.workspace;
        forward_dynamics(self.model, theta, dtheta, &self.force, &environment, workspace, ddtheta);
        let applied_power = self.applied_power(theta, dtheta); // of the configurations in the workspace, before others use it
        self.model.check_pivots(theta, &mut self.workspace)?;
        self.bounded("ddtheta", t, ddtheta)?;
        let motor_power = self.tau.iter().zip(dtheta).map(|(tau, rate)| tau * rate).sum();
        Ok([motor_power, friction_power, applied_power])
    }

    /// The energies of a state, with works.
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

    fn ask_input(&mut self, t: f64, theta: &[f64], dtheta: &[f64]) -> Result<(), Error> {
        self.tau.fill(0.0);
        self.wrenches.clear();
        self.input.torque(t, theta, dtheta, &mut self.tau)?;
        self.input.applied(t, theta, dtheta, &mut self.wrenches)?;
        if let Some(j) = self.tau.iter().position(|x| !x.is_finite()) {
            let found = format!("{} at joint `{}`, t = {t} s", self.tau[j], self.joint(j));
            return check(false, "the input's torque", found, "a finite number");
        }
        for &(frame, F) in &self.wrenches {
            let known = self.model.frames().len();
            check(frame.0 < known, "the frame of an input's wrench", frame.0, "a frame of this model")?;
            if !F.to_array().iter().all(|x| x.is_finite()) {
                let found = format!("{:?} at frame `{}`, t = {t} s", F.to_array(), self.model.frame_name(frame));
                return check(false, "the input's wrench", found, "finite numbers");
            }
        }
        Ok(())
    }

    /// Writes the force for forward dynamics, which subtracts d θ̇ + μ sgn θ̇ itself: τ, and for smooth friction τ with the
    /// difference of the two laws. Returns θ̇ᵀf(θ̇).
    fn friction(&mut self, dtheta: &[f64]) -> f64 {
        let mut power = 0.0;
        for (j, &rate) in dtheta.iter().enumerate() {
            let (damping, mu) = (self.model.damping[j], self.model.friction[j]);
            let coulomb = mu * rate.sgn();
            let law = match self.friction {
                Friction::Coulomb => coulomb,
                Friction::Smooth { slip_speed } => mu * Scalar::tanh(rate / slip_speed),
            };
            self.force[j] = self.tau[j] + (coulomb - law);
            power += rate * (damping * rate + law);
        }
        power
    }

    /// Σ 𝒱_bᵀF_b, with the configurations T_{i,i−1} that forward dynamics left behind.
    fn applied_power(&mut self, theta: &[f64], dtheta: &[f64]) -> f64 {
        link_twists(self.model, theta, dtheta, Twist::zero(), &mut self.workspace);
        let power = |&(frame, F): &(FrameId, Wrench)| {
            let frame = self.model.frame_at::<f64>(frame);
            (frame.T.inverse().Ad() * self.workspace.V[frame.slot]).dot(F)
        };
        self.wrenches.iter().map(power).sum()
    }

    /// Beyond 10¹⁵⁰ squares, and so energies, leave the numbers: that is called a blow-up too.
    fn bounded(&self, quantity: &'static str, time: f64, values: &[f64]) -> Result<(), Error> {
        let Some(j) = values.iter().position(|x| !(x.abs() < 1e150)) else { return Ok(()) };
        let (joint, value) = (self.joint(j), values[j]);
        Err(Error::Diverged { quantity, joint, value, step: self.step, time, step_size: self.step_size })
    }

    fn joint(&self, j: usize) -> String {
        self.model.velocity_names().nth(j).unwrap_or_default().to_string()
    }
}
