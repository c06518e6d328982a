//! The functions that the steps of a rollout evaluate: θ̈ and its vector-Jacobian products.

use super::ParameterGradient;
use crate::Error;
use crate::{Equation, Friction, Input, Options};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::fast;
use mozzi::model::{Environment, Model};
use mozzi::quantities::{ForwardDynamicsVjp, Query};
use mozzi::scalar::Scalar;

/// A stage of a step, of one robot, or of many robots of one model: one after the other in each slice.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The step, from 0.
    pub step: usize,
    /// s.
    pub t: f64,
    /// θ.
    pub theta: &'a [f64],
    /// θ̇.
    pub dtheta: &'a [f64],
    /// τ, held over the step.
    pub tau: &'a [f64],
}

/// Forward dynamics and its gradients at the stages of a [rollout](super::Steps): of one robot, or of many at once.
pub trait StageDynamics {
    /// The reason why a state fails.
    type Error;

    /// θ̈.
    ///
    /// # Errors
    /// A state that is infinite or NaN, or has a singular mass matrix.
    fn accelerations(&mut self, stage: Stage<'_>, ddtheta: &mut [f64]) -> Result<(), Self::Error>;

    /// xᵀ∂θ̈/∂θ (along the velocities), xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ = M⁻¹x.
    ///
    /// # Errors
    /// As for [`accelerations`](Self::accelerations).
    fn vjp(&mut self, stage: Stage<'_>, x: &[f64], outputs: [&mut [f64]; 3]) -> Result<(), Self::Error>;

    /// Adds xᵀ∂θ̈/∂π to the parameters' gradient, where y = M⁻¹x.
    ///
    /// # Errors
    /// As for [`accelerations`](Self::accelerations).
    fn add_parameter_vjp(
        &mut self,
        stage: Stage<'_>,
        ddtheta: &[f64],
        y: &[f64],
        gradient: &mut [f64],
    ) -> Result<(), Self::Error>;
}

/// Torques held over a step.
#[derive(Clone, Debug)]
pub struct HeldTorque(pub Vec<f64>);

impl Input for HeldTorque {
    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        tau.copy_from_slice(&self.0);
        Ok(())
    }
}

/// The equation of motion of one robot, as a simulation evaluates it.
pub struct OneRobot<'m> {
    pub equation: Equation<'m, HeldTorque>,
    step_size: f64,
    workspace: fast::Workspace,
    parameters: ParameterGradient,
}

impl<'m> OneRobot<'m> {
    pub fn new(model: &'m Model, options: &Options) -> Self {
        OneRobot {
            equation: Equation::new(model, HeldTorque(vec![0.0; model.n()]), options),
            step_size: options.step(),
            workspace: fast::Workspace::new(model),
            parameters: ParameterGradient::new(model),
        }
    }
}

impl StageDynamics for OneRobot<'_> {
    type Error = Error;

    fn accelerations(&mut self, stage: Stage<'_>, ddtheta: &mut [f64]) -> Result<(), Error> {
        self.equation.input.0.copy_from_slice(stage.tau);
        self.equation.at_step(stage.step + 1, self.step_size);
        self.equation.evaluate(stage.t, stage.theta, stage.dtheta, ddtheta)?;
        Ok(())
    }

    fn vjp(&mut self, stage: Stage<'_>, x: &[f64], [d_theta, d_dtheta, d_tau]: [&mut [f64]; 3]) -> Result<(), Error> {
        let Stage { theta, dtheta, tau, .. } = stage;
        let (equation, workspace) = (&mut self.equation, &mut self.workspace);
        equation.tau.copy_from_slice(tau);
        equation.friction(dtheta);
        let environment = Environment::with_gravity(equation.gravity);
        let (query, model) = (Query::from(ForwardDynamicsVjp), equation.model());
        let inputs = [theta, dtheta, &equation.force, x];
        fast::evaluate(&query, model, &inputs, &environment, workspace, &mut [d_theta, d_dtheta, d_tau]);
        if let Friction::Smooth { slip_speed } = equation.options.friction {
            // the force has −μ tanh(θ̇/v_s)
            for (j, &mu) in model.friction().iter().enumerate().filter(|(_, mu)| **mu != 0.0) {
                let law = Scalar::tanh(dtheta[j] / slip_speed);
                d_dtheta[j] -= d_tau[j] * (mu * (1.0 - law * law) / slip_speed);
            }
        }
        Ok(())
    }

    fn add_parameter_vjp(
        &mut self,
        stage: Stage<'_>,
        ddtheta: &[f64],
        y: &[f64],
        gradient: &mut [f64],
    ) -> Result<(), Error> {
        let Stage { theta, dtheta, .. } = stage;
        let (model, environment) = (self.equation.model(), Environment::with_gravity(self.equation.gravity));
        self.parameters.add(model, [theta, dtheta, ddtheta], y, &environment, gradient);
        if let Friction::Smooth { slip_speed } = self.equation.options.friction {
            // M θ̈ has μ tanh(θ̇/v_s) in place of μ sgn θ̇
            for (k, place) in model.places().iter().enumerate() {
                let law = |j: usize| Scalar::tanh(dtheta[j] / slip_speed) - dtheta[j].sgn();
                gradient[model.parameters_of_joint(k).start + 2] -=
                    place.velocities().map(|j| y[j] * law(j)).sum::<f64>();
            }
        }
        Ok(())
    }
}
