//! Rollouts: N steps of one size under torques held over each step, and gradients through them.
//!
//! > x\[k+1\] = Φ(x\[k\], τ\[k\], π), x = (θ, θ̇);  L(x\[0\], …, x\[N\])
//!
//! A [`Rollout`] takes the steps of [`simulate`](crate::simulate) and propagates cotangents x̄ backward through them,
//!
//! > x̄\[k\] = ∂L/∂x\[k\] + (∂Φ/∂x)ᵀx̄\[k+1\],  τ̄\[k\] = (∂Φ/∂τ)ᵀx̄\[k+1\],  π̄ = Σ (∂Φ/∂π)ᵀx̄\[k+1\]
//!
//! It is the adjoint of the discrete step itself, and so exact to rounding for any step size: each stage takes one
//! [vector-Jacobian product of forward dynamics](mozzi::dynamics::forward_dynamics_vjp()), O(n), and no matrix is
//! formed. The derivations are in `adjoint.rs` and, for ⊕ on SO(3) and SE(3), in `retraction.rs`. The implicit midpoint
//! rule takes the implicit function theorem and dual numbers, O(n³) a step: `midpoint.rs`.
//!
//! A cotangent of θ has n numbers, along θ ⊕ δθ: for a floating base, a ball or a free joint along the body twist in
//! its own coordinates, not along the entries of the quaternion.

mod adjoint;
mod constrained;
#[cfg(test)]
mod constrained_tests;
mod dynamics;
mod explicit;
mod midpoint;
#[cfg(test)]
mod midpoint_tests;
mod parameters;
mod retraction;
mod stepper;
mod steps;
mod tables;
mod tape;
#[cfg(test)]
mod tests;

pub use dynamics::{Stage, StageDynamics};
pub use explicit::ExplicitSteps;
pub use parameters::ParameterGradient;
pub(crate) use retraction::series;
pub use stepper::{Cotangents, Stepper};
pub use steps::{StartGradient, Steps, Tables};

use crate::Error;
use crate::options::check;
use crate::{Equation, Friction, Method, Options};
use alloc::boxed::Box;
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use constrained::ConstrainedSteps;
use dynamics::{HeldTorque, OneRobot};
use midpoint::MidpointSteps;
use mozzi::linalg::Vec3;
use mozzi::model::Model;
use tables::{Gradient, Record};

/// The states of a rollout of N steps, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct RolloutStates {
    /// θ\[0\] … θ\[N\], (N + 1) × nq.
    pub theta: Vec<f64>,
    /// θ̇\[0\] … θ̇\[N\], (N + 1) × n.
    pub dtheta: Vec<f64>,
}

/// The gradient of a loss of a rollout's states.
#[derive(Clone, Debug, PartialEq)]
pub struct RolloutGradient {
    /// With respect to θ\[0\], n numbers along the velocities.
    pub theta: Vec<f64>,
    /// With respect to θ̇\[0\], n numbers.
    pub dtheta: Vec<f64>,
    /// With respect to τ\[0\] … τ\[N − 1\], N × n.
    pub tau: Vec<f64>,
    /// With respect to the [`parameters`](Model::parameters) π, p numbers; empty unless
    /// [wanted](Rollout::with_parameter_gradient).
    pub parameters: Vec<f64>,
}

/// N steps of h seconds of one robot, τ\[k\] held over step k, and gradients through them. {s} is at rest, no wrenches
/// are applied, joint limits are ignored. N is the number of rows of τ. A robot with constraints is brought back onto
/// them after each step.
///
/// ```
/// use mozzi_sim::{Method, Rollout};
/// # fn example(model: &mozzi::Model, goal: &[f64]) -> Result<(), mozzi_sim::Error> {
/// let (n, steps) = (model.n(), 200);
/// let (theta, dtheta, tau) = (vec![0.0; model.nq()], vec![0.0; n], vec![0.0; steps * n]);
/// let mut rollout = Rollout::new(model, 0.01, Method::RungeKutta4)?;
/// // the loss ½‖θ[N] − goal‖²: its gradient by θ[N]
/// let gradient = rollout.gradient(&theta, &dtheta, &tau, |k, theta, _dtheta, theta_bar, _dtheta_bar| {
///     if k == steps {
///         (0..n).for_each(|j| theta_bar[j] += theta[j] - goal[j]);
///     }
/// })?;
/// assert_eq!(gradient.tau.len(), steps * n);
/// # Ok(())
/// # }
/// ```
pub struct Rollout<'m> {
    model: &'m Model,
    h: f64,
    options: Options,
    segment: Option<usize>,
    wants_parameters: bool,
    steps: Kind<'m>,
}

/// The steps of each kind of integrator.
enum Kind<'m> {
    Explicit(Box<Steps<ExplicitSteps<OneRobot<'m>>>>),
    Midpoint(Box<Steps<MidpointSteps<'m>>>),
    Constrained(Box<Steps<ConstrainedSteps<'m>>>),
}

/// Evaluates an expression with the steps of whichever kind the rollout has.
macro_rules! with_steps {
    ($rollout:ident, |$steps:ident| $value:expr) => {
        match &mut $rollout.steps {
            Kind::Explicit($steps) => $value,
            Kind::Midpoint($steps) => $value,
            Kind::Constrained($steps) => $value,
        }
    };
}

impl<'m> Rollout<'m> {
    /// Steps of h seconds by a method; gravity and Coulomb friction are the robot's. Allocates all memory.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for a step that is not positive and finite, an [adaptive](Method::is_adaptive)
    /// method, or the midpoint rule for a robot with constraints.
    pub fn new(model: &'m Model, h: f64, method: Method) -> Result<Self, Error> {
        check_step(h)?;
        let options = Options { method, ..Options::new(h, 1) };
        let (n, p) = (model.n(), model.parameter_count());
        let steps = if model.constraint_rows() > 0 {
            method.explicit()?;
            Kind::Constrained(Box::new(Steps::new(ConstrainedSteps::new(model, options), n, p)))
        } else if method == Method::Midpoint {
            Kind::Midpoint(Box::new(Steps::new(MidpointSteps::new(model, &options), n, p)))
        } else {
            let steps = ExplicitSteps::new(model, 1, method.explicit()?, h, OneRobot::new(model, &options));
            Kind::Explicit(Box::new(Steps::new(steps, n, p)))
        };
        Ok(Rollout { model, h, options, segment: None, wants_parameters: false, steps })
    }

    /// Gravity in {s} coordinates, m/s², in place of the robot's.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] unless it is finite.
    pub fn with_gravity(self, gravity: Vec3) -> Result<Self, Error> {
        let options = Options { gravity: Some(gravity), ..self.options };
        self.with_options(options)
    }

    /// Another model of Coulomb friction. Where it is smooth, so is the loss.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for a slip speed that is not positive and finite.
    pub fn with_friction(self, friction: Friction) -> Result<Self, Error> {
        let options = Options { friction, ..self.options };
        self.with_options(options)
    }

    fn with_options(mut self, options: Options) -> Result<Self, Error> {
        options.check()?;
        self.options = options;
        let gravity = options.gravity.unwrap_or(self.model.gravity());
        if let Some(equation) = self.equation() {
            (equation.gravity, equation.options) = (gravity, options);
        } else if let Kind::Constrained(steps) = &mut self.steps {
            steps.stepper.options = options;
        }
        Ok(self)
    }

    /// The equation of motion of the steps that keep one.
    fn equation(&mut self) -> Option<&mut Equation<'m, HeldTorque>> {
        match &mut self.steps {
            Kind::Explicit(steps) => Some(&mut steps.stepper.dynamics.equation),
            Kind::Midpoint(steps) => Some(&mut steps.stepper.driven.equation),
            Kind::Constrained(_) => None,
        }
    }

    /// The number of steps between checkpoints, at least 1: memory is that of N / `steps` states and of the stages of
    /// `steps` steps. By default √N, or more if the stages fit into 1 MB. With N or more, no step is computed twice.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for 0.
    pub fn with_checkpoints_every(mut self, steps: usize) -> Result<Self, Error> {
        check(steps > 0, "the number of steps between checkpoints", steps, "at least 1")?;
        self.segment = Some(steps);
        Ok(self)
    }

    /// Also computes the gradient with respect to the parameters.
    pub fn with_parameter_gradient(mut self) -> Self {
        self.wants_parameters = true;
        self
    }

    /// The states from (θ\[0\], θ̇\[0\]) under τ, N × n. Each step costs as many forward dynamics as the method has
    /// stages.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`], [`mozzi::Error::BadArgument`] for numbers that are not finite,
    /// [`mozzi::Error::SingularMassMatrix`], [`Error::Diverged`].
    pub fn states(&mut self, theta: &[f64], dtheta: &[f64], tau: &[f64]) -> Result<RolloutStates, Error> {
        let N = self.check(theta, dtheta, tau)?;
        let (nq, n) = (self.model.nq(), self.model.n());
        let mut found = RolloutStates { theta: vec![0.0; (N + 1) * nq], dtheta: vec![0.0; (N + 1) * n] };
        self.write_states(theta, dtheta, tau, &mut found.theta, &mut found.dtheta)?;
        Ok(found)
    }

    /// [`states`](Self::states) into slices of (N + 1) nq and (N + 1) n numbers, without allocation.
    ///
    /// # Errors
    /// As [`states`](Self::states).
    pub fn write_states(
        &mut self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        theta_table: &mut [f64],
        dtheta_table: &mut [f64],
    ) -> Result<(), Error> {
        let (N, n, nq) = (self.check(theta, dtheta, tau)?, self.model.n(), self.model.nq());
        length("theta_table", theta_table.len(), (N + 1) * nq)?;
        length("dtheta_table", dtheta_table.len(), (N + 1) * n)?;
        let mut tables = Record { n, tau, theta_table: &mut *theta_table, dtheta_table: &mut *dtheta_table };
        with_steps!(self, |steps| steps.run([theta, dtheta], N, &mut tables).map(|_| ()))?;
        let (h, end) = (self.h, N as f64 * self.h);
        let Some(equation) = self.equation() else { return Ok(()) }; // with constraints, each step is checked
        equation.at_step(N, h);
        equation.bounded("theta", end, &theta_table[N * nq..])?;
        equation.bounded("dtheta", end, &dtheta_table[N * n..])
    }

    /// The gradient of a loss, given by its own gradient at each state: `loss(k, θ, θ̇, θ̄, θ̇̄)` *adds* ∂L/∂θ\[k\], n
    /// numbers along the velocities, and ∂L/∂θ̇\[k\]. It is called once for each state, from k = N to 0.
    ///
    /// A step costs, for each stage, one forward dynamics (two with checkpoints) and one vector-Jacobian product.
    ///
    /// # Errors
    /// As [`states`](Self::states).
    pub fn gradient(
        &mut self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        loss: impl FnMut(usize, &[f64], &[f64], &mut [f64], &mut [f64]),
    ) -> Result<RolloutGradient, Error> {
        let N = self.check(theta, dtheta, tau)?;
        self.gradient_by([theta, dtheta], N, tau, None, loss)
    }

    /// The vector-Jacobian product of [`states`](Self::states): the gradient of Σ θ̄\[k\]ᵀδθ\[k\] +
    /// θ̇̄\[k\]ᵀδθ̇\[k\] for cotangents θ̄ and θ̇̄, both (N + 1) × n. θ̄ is along the velocities.
    ///
    /// # Errors
    /// As [`states`](Self::states).
    pub fn vjp(
        &mut self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        theta_bar: &[f64],
        dtheta_bar: &[f64],
    ) -> Result<RolloutGradient, Error> {
        let n = self.model.n();
        let N = self.check(theta, dtheta, tau)?;
        length("theta_bar", theta_bar.len(), (N + 1) * n)?;
        length("dtheta_bar", dtheta_bar.len(), (N + 1) * n)?;
        self.gradient_by([theta, dtheta], N, tau, None, |k, _, _, to_theta, to_dtheta| {
            add(to_theta, &theta_bar[k * n..]);
            add(to_dtheta, &dtheta_bar[k * n..]);
        })
    }

    /// [`gradient`](Self::gradient) where all states are there already: nothing is computed twice but the inner stages
    /// of each step, and no memory but one step's is needed.
    ///
    /// # Errors
    /// As [`states`](Self::states).
    pub fn gradient_of_states(
        &mut self,
        states: &RolloutStates,
        tau: &[f64],
        loss: impl FnMut(usize, &[f64], &[f64], &mut [f64], &mut [f64]),
    ) -> Result<RolloutGradient, Error> {
        let (nq, n) = (self.model.nq(), self.model.n());
        let start = [&states.theta[..nq.min(states.theta.len())], &states.dtheta[..n.min(states.dtheta.len())]];
        let N = self.check(start[0], start[1], tau)?;
        length("theta_table", states.theta.len(), (N + 1) * nq)?;
        length("dtheta_table", states.dtheta.len(), (N + 1) * n)?;
        self.gradient_by(start, N, tau, Some(states), loss)
    }

    fn gradient_by(
        &mut self,
        start: [&[f64]; 2],
        N: usize,
        tau: &[f64],
        states: Option<&RolloutStates>,
        loss: impl FnMut(usize, &[f64], &[f64], &mut [f64], &mut [f64]),
    ) -> Result<RolloutGradient, Error> {
        let mut tau_bar = vec![0.0; tau.len()];
        let mut tables = Gradient { n: self.model.n(), tau, tau_bar: &mut tau_bar, states, loss };
        let (segment, wanted) = (self.segment, self.wants_parameters);
        let found = with_steps!(self, |steps| steps.gradient(start, N, segment, wanted, &mut tables))?;
        let StartGradient { theta, dtheta, parameters } = found;
        Ok(RolloutGradient {
            theta: theta.to_vec(),
            dtheta: dtheta.to_vec(),
            parameters: parameters.to_vec(),
            tau: tau_bar,
        })
    }

    /// Checks the start and the torques; N.
    fn check(&self, theta: &[f64], dtheta: &[f64], tau: &[f64]) -> Result<usize, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta)])?;
        for (what, values) in [("theta", theta), ("dtheta", dtheta)] {
            check(values.iter().all(|x| x.is_finite()), what, format!("{values:?}"), "finite numbers")?;
        }
        let n = self.model.n().max(1);
        check(tau.len().is_multiple_of(n), "tau", format!("{} numbers", tau.len()), "N × n, a row for each step")?;
        Ok(tau.len() / n)
    }

    /// h, s.
    pub fn step(&self) -> f64 {
        self.h
    }
}

fn check_step(h: f64) -> Result<(), Error> {
    check(h.is_finite() && h > 0.0, "the step", format!("{h} s"), "a positive, finite number of seconds")
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected { Ok(()) } else { Err(Error::Model(mozzi::Error::WrongLength { what, found, expected })) }
}

fn add(x: &mut [f64], y: &[f64]) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += y);
}
