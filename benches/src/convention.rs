//! Converts to and from a peer's convention with `mozzi::conventions`.

use crate::quantity::has_matrices;
use crate::states::State;
use mozzi::conventions::{MuJoCo, Pinocchio};
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::quantities::{BiasForces, ForwardDynamics, Query};
use mozzi::{Error, Model};

/// A peer's order and frames for a floating base.
pub enum Convention {
    Mozzi,
    Pinocchio(Pinocchio),
    MuJoCo(MuJoCo),
}

impl Convention {
    /// The convention of this name, as the peer reports it.
    pub fn named(name: &str, model: &Model) -> Result<Self, String> {
        let joints: Vec<&str> = model.joint_names().collect();
        match name {
            "mozzi" => Ok(Convention::Mozzi),
            "pinocchio" => Pinocchio::with_joints(model, &joints, &vec![1; joints.len()])
                .map(Convention::Pinocchio)
                .map_err(|error| error.to_string()),
            "mujoco" => Ok(Convention::MuJoCo(MuJoCo::new(model))),
            _ => Err(format!("convention `{name}`, expected mozzi, pinocchio or mujoco")),
        }
    }

    /// θ, θ̇, θ̈, τ as the peer has them.
    pub fn state(&self, [theta, dtheta, ddtheta, tau]: State) -> Result<[Vec<f64>; 4], Error> {
        let vectors = match self {
            Convention::Mozzi => return Ok([theta, dtheta, ddtheta, tau].map(<[f64]>::to_vec)),
            Convention::Pinocchio(p) => {
                [p.configuration(theta)?, p.velocity(dtheta)?, p.acceleration(ddtheta)?, p.force(tau)?]
            }
            Convention::MuJoCo(m) => [
                m.configuration(theta)?,
                m.velocity(theta, dtheta)?,
                m.acceleration(theta, dtheta, ddtheta)?,
                m.force(theta, tau)?,
            ],
        };
        Ok(vectors.map(|x| x.as_slice().to_vec()))
    }

    /// The peer's result in mozzi's convention, matrices by rows as they came.
    pub fn result(&self, model: &Model, query: Query, state: State, result: &[f64]) -> Result<Vec<f64>, Error> {
        let n = model.n();
        let vector = |x: DVector<f64>| x.as_slice().to_vec();
        let by_rows = |M: DMatrix<f64>| M.transpose().as_slice().to_vec();
        if has_matrices(query) {
            let mut numbers = Vec::new();
            for block in result.chunks_exact(n * n) {
                let M = DMatrix::from_row_slice(n, n, block);
                numbers.extend(match self {
                    Convention::Mozzi => block.to_vec(),
                    Convention::Pinocchio(p) => by_rows(p.from_mass_matrix(&M)?),
                    Convention::MuJoCo(m) => by_rows(m.from_mass_matrix(m.configuration(state[0])?.as_slice(), &M)?),
                });
            }
            return Ok(numbers);
        }
        match self {
            Convention::Mozzi => Ok(result.to_vec()),
            Convention::Pinocchio(p) => p.from_force(result).map(vector), // accelerations are ordered alike
            Convention::MuJoCo(m) => {
                let [theta, dtheta, ..] = state;
                let (qpos, qvel) = (m.configuration(theta)?, m.velocity(theta, dtheta)?);
                let (qpos, qvel) = (qpos.as_slice(), qvel.as_slice());
                match query {
                    query if query == ForwardDynamics.into() => m.from_acceleration(qpos, qvel, result),
                    query if query == BiasForces.into() => {
                        m.from_bias_forces(qpos, qvel, &model.mass_matrix(theta)?, result)
                    }
                    _ => m.from_force(qpos, result),
                }
                .map(vector)
            }
        }
    }
}
