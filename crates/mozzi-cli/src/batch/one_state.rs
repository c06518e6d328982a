//! Every quantity at one state, by the kernels: the measure of a batch.

use super::quantity::Quantity;
use mozzi::{Environment, FrameId, Model, Twist, Workspace, fast};

/// The machine's instruction set where [`fast`] has the quantity, else plain `f64`.
pub struct OneState<'m> {
    model: &'m Model,
    frame: Option<FrameId>,
    fast: fast::Workspace,
    plain: Workspace,
    columns: Vec<Twist>,
}

impl<'m> OneState<'m> {
    pub fn new(model: &'m Model) -> Self {
        OneState {
            model,
            frame: model.end_effector().ok(),
            fast: fast::Workspace::new(model),
            plain: Workspace::new(model),
            columns: vec![Twist::zero(); model.n()],
        }
    }

    /// (θ, θ̇, θ̈ or τ) to the quantity's outputs, one after the other.
    pub fn evaluate(&mut self, quantity: Quantity, state: [&[f64]; 3], environment: &Environment, out: &mut [f64]) {
        let OneState { model, fast, plain, columns, .. } = self;
        let [theta, dtheta, x] = state;
        let frame = self.frame;
        match quantity {
            Quantity::InverseDynamics => fast::inverse_dynamics(model, theta, dtheta, x, environment, fast, out),
            Quantity::ForwardDynamics => fast::forward_dynamics(model, theta, dtheta, x, environment, fast, out),
            Quantity::MassMatrix => fast::mass_matrix(model, theta, fast, out),
            Quantity::MassMatrixRate => mozzi::mass_matrix_rate(model, theta, dtheta, plain, out),
            Quantity::CoriolisMatrix => fast::coriolis_matrix(model, theta, dtheta, fast, out),
            Quantity::VelocityProduct => fast::velocity_product(model, theta, dtheta, fast, out),
            Quantity::GravityForces => mozzi::gravity_forces(model, theta, environment.gravity, plain, out),
            Quantity::BiasForces => fast::bias_forces(model, theta, dtheta, environment, fast, out),
            Quantity::TipForces => mozzi::tip_forces(model, theta, environment.applied, plain, out),
            Quantity::KineticEnergy => {
                out[0] = mozzi::kinetic_energy(model, theta, dtheta, environment.base_twist, plain)
            }
            Quantity::PotentialEnergy => out[0] = mozzi::potential_energy(model, theta, environment.gravity, plain),
            Quantity::InverseDynamicsDerivatives => {
                fast::inverse_dynamics_derivatives(model, theta, dtheta, x, environment, fast, thirds(out));
            }
            Quantity::ForwardDynamicsDerivatives => {
                let (ddtheta, by) = out.split_at_mut(model.n());
                fast::forward_dynamics_derivatives(model, theta, dtheta, x, environment, fast, ddtheta, thirds(by));
            }
            Quantity::ForwardKinematics => {
                if let Some(frame) = frame {
                    out.copy_from_slice(mozzi::forward_kinematics(model, theta, frame).to_matrix().as_flattened());
                }
            }
            Quantity::SpaceJacobian
            | Quantity::BodyJacobian
            | Quantity::SpaceJacobianRate
            | Quantity::BodyJacobianRate => {
                if let Some(frame) = frame {
                    match quantity {
                        Quantity::SpaceJacobian => mozzi::space_jacobian(model, theta, frame, columns),
                        Quantity::BodyJacobian => mozzi::body_jacobian(model, theta, frame, columns),
                        Quantity::SpaceJacobianRate => {
                            mozzi::space_jacobian_rate(model, theta, dtheta, frame, plain, columns);
                        }
                        _ => mozzi::body_jacobian_rate(model, theta, dtheta, frame, columns),
                    }
                    for (j, column) in columns.iter().enumerate() {
                        for (row, entry) in column.to_array().into_iter().enumerate() {
                            out[row * columns.len() + j] = entry;
                        }
                    }
                }
            }
        }
    }
}

fn thirds(list: &mut [f64]) -> [&mut [f64]; 3] {
    let third = list.len() / 3;
    let (a, rest) = list.split_at_mut(third);
    let (b, c) = rest.split_at_mut(third);
    [a, b, c]
}
