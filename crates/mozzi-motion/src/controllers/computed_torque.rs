//! Computed torque control (Modern Robotics 11.37).

use super::{Gains, errors};
use crate::Error;
use crate::error::check_driven;
use crate::trajectories::Reference;
use mozzi::quantities::{InverseDynamics, Query};
use mozzi::{Model, fast};
use mozzi_sim::Input;

/// τ = M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇) + f(θ, θ̇), by one inverse dynamics; K_p in 1/s², K_d in 1/s. If the model
/// is exact, ë + K_d ė + K_p e = 0.
///
/// For a robot with constraints, θ̈ is the nearest that they allow, and only its motors contribute to τ: see
/// [`Model::constrained_inverse_dynamics`]. The reference should satisfy the constraints.
pub struct ComputedTorque<'m, R> {
    model: &'m Model,
    /// The reference to follow.
    pub reference: R,
    gains: Gains,
    workspace: fast::Workspace,
    tau: Vec<f64>,
}

impl<'m, R: Reference> ComputedTorque<'m, R> {
    /// With this model of the robot, which need not be exact.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`]; [`mozzi::Error::BadArgument`] for gains that are negative or not finite, or a
    /// floating base, which no motor moves.
    pub fn new(model: &'m Model, reference: R, gains: Gains) -> Result<Self, Error> {
        gains.check(model)?;
        check_driven(model, "a robot under computed torque")?;
        Ok(ComputedTorque {
            model,
            reference,
            gains,
            workspace: fast::Workspace::new(model),
            tau: vec![0.0; model.n()],
        })
    }
}

impl<R: Reference> Input for ComputedTorque<'_, R> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        let desired = self.reference.at(t);
        let [e, de] = errors(self.model, &desired, theta, dtheta)?;
        let mut ddtheta = desired.ddtheta;
        for j in 0..ddtheta.len() {
            ddtheta[j] += self.gains.d[j] * de[j] + self.gains.p[j] * e[j];
        }
        self.model.check_lengths(theta, [("the reference's ddtheta", &ddtheta)])?;
        let environment = self.model.environment();
        if self.model.constraint_rows() > 0 {
            let ddtheta = self.model.assemble_accelerations(theta, dtheta, &ddtheta, &[])?;
            let found = self.model.constrained_inverse_dynamics(theta, dtheta, &ddtheta, &environment, None)?;
            tau.iter_mut().zip(found.tau.iter()).for_each(|(sum, tau)| *sum += tau);
            return Ok(());
        }
        let (query, state) = (Query::from(InverseDynamics), [theta, dtheta, &ddtheta]);
        fast::evaluate(&query, self.model, &state, &environment, &mut self.workspace, &mut [&mut self.tau]);
        tau.iter_mut().zip(&self.tau).for_each(|(sum, tau)| *sum += tau);
        Ok(())
    }
}
