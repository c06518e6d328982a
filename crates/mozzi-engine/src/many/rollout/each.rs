//! Robots one by one, on all cores: those with constraints, which are closed after each step, and implicit steps.

use super::{BatchGradient, BatchRollout, part};
use crate::{Batch, Error};
use mozzi::Model;
use mozzi_sim::Rollout;
use std::convert::identity;

impl BatchRollout {
    /// A rollout of one robot with the same steps, gravity and checkpoints.
    ///
    /// # Errors
    /// As [`Rollout::new`].
    pub fn of_one<'m>(&self, model: &'m Model) -> Result<Rollout<'m>, mozzi_sim::Error> {
        let mut rollout = Rollout::new(model, self.step, self.method)?;
        if let Some(gravity) = self.gravity {
            rollout = rollout.with_gravity(gravity)?;
        }
        match self.checkpoints_every {
            Some(steps) => rollout.with_checkpoints_every(steps),
            None => Ok(rollout),
        }
    }
}

impl BatchGradient<'_> {
    /// Fills the tables of one robot from the cotangents θ̄ and θ̇̄ of its states.
    ///
    /// # Errors
    /// As [`Rollout::vjp`].
    pub fn of_one(
        self,
        rollout: &mut Rollout<'_>,
        [theta, dtheta, tau]: [&[f64]; 3],
        [theta_bar, dtheta_bar]: [&[f64]; 2],
    ) -> Result<(), mozzi_sim::Error> {
        let found = rollout.vjp(theta, dtheta, tau, theta_bar, dtheta_bar)?;
        self.theta.copy_from_slice(&found.theta);
        self.dtheta.copy_from_slice(&found.dtheta);
        self.tau.copy_from_slice(&found.tau);
        self.parameters.copy_from_slice(&found.parameters);
        Ok(())
    }
}

impl Batch<f64> {
    /// Applies f to each robot: to its rollout, its start and torques, its index, and its tables.
    pub(super) fn each_rollout<I: Send>(
        &self,
        options: &BatchRollout,
        wants_parameters: bool,
        [theta, dtheta, tau]: [&[f64]; 3],
        tables: Vec<I>,
        f: impl Fn(&mut Rollout<'_>, [&[f64]; 3], usize, I) -> Result<(), mozzi_sim::Error> + Sync,
    ) -> Result<(), Error> {
        let (model, N) = (self.model(), options.steps);
        let (nq, n) = (model.nq(), model.n());
        let results = self.workers().map(
            tables.into_iter().enumerate().collect(),
            || None::<Rollout<'_>>,
            |memory, (robot, tables)| {
                let of = |table, width| part(table, robot, 1, width);
                let start = [of(theta, nq), of(dtheta, n), of(tau, N * n)];
                let alone = |source| Error::State { index: robot, source };
                let rollout = match memory {
                    Some(rollout) => rollout,
                    None => memory.insert(match options.of_one(model).map_err(alone)? {
                        rollout if wants_parameters => rollout.with_parameter_gradient(),
                        rollout => rollout,
                    }),
                };
                f(rollout, start, robot, tables).map_err(alone)
            },
        );
        results.into_iter().try_for_each(identity)
    }
}
