//! What a model can be asked for: the arguments' names, the results' shapes, and who computes it at one state and at many.

use crate::robot::Memory;
use mozzi::{self as kernel, Environment, Error, FrameId, Model, Task, Twist, Vec3, fast};
use mozzi_batch::{Batch, BatchEnvironment};
use mozzi_codegen::Compiled;

/// A quantity of a state.
#[derive(Clone, Copy)]
pub enum Quantity<'a> {
    InverseDynamics,
    ForwardDynamics,
    MassMatrix,
    MassMatrixRate,
    CoriolisMatrix,
    VelocityProduct,
    GravityForces,
    BiasForces,
    TipForces,
    KineticEnergy,
    PotentialEnergy,
    ForwardKinematics(FrameId),
    SpaceJacobian(FrameId),
    BodyJacobian(FrameId),
    SpaceJacobianRate(FrameId),
    BodyJacobianRate(FrameId),
    TaskSpaceDynamics(Task<'a>),
    InverseDynamicsDerivatives,
    ForwardDynamicsDerivatives,
    // at many states, one after the other:
    JointFriction,
    SpaceJacobianDerivative(FrameId),
    BodyJacobianDerivative(FrameId),
    GravityForcesDerivative,
    TipForcesDerivative,
    MassMatrixProductDerivative,
    CenterOfMass,
    CenterOfMassVelocity,
    CenterOfMassAcceleration,
    CenterOfMassJacobian,
    Momentum(Vec3),
    MomentumRate(Vec3),
    CentroidalMomentumMatrix,
    CentroidalMomentumBias,
    Regressor,
    EnergyRegressors,
    FramePoses,
}
use Quantity::*;

impl Quantity<'_> {
    /// The shapes of its results at one state.
    pub fn shapes(self, model: &Model) -> Vec<Vec<usize>> {
        let n = model.n();
        match self {
            InverseDynamics | ForwardDynamics | VelocityProduct | GravityForces | BiasForces | TipForces
            | JointFriction => {
                vec![vec![n]]
            }
            MassMatrix
            | MassMatrixRate
            | CoriolisMatrix
            | GravityForcesDerivative
            | TipForcesDerivative
            | MassMatrixProductDerivative => vec![vec![n, n]],
            KineticEnergy | PotentialEnergy => vec![vec![]],
            ForwardKinematics(_) => vec![vec![4, 4]],
            SpaceJacobian(_) | BodyJacobian(_) | SpaceJacobianRate(_) | BodyJacobianRate(_) => vec![vec![6, n]],
            SpaceJacobianDerivative(_) | BodyJacobianDerivative(_) => vec![vec![n, 6, n]],
            TaskSpaceDynamics(task) => vec![vec![task.rows.len(); 2], vec![task.rows.len()]],
            InverseDynamicsDerivatives => vec![vec![n, n]; 3],
            ForwardDynamicsDerivatives => vec![vec![n], vec![n, n], vec![n, n], vec![n, n]],
            CenterOfMass | CenterOfMassVelocity | CenterOfMassAcceleration => vec![vec![3]],
            CenterOfMassJacobian => vec![vec![3, n]],
            Momentum(_) | MomentumRate(_) | CentroidalMomentumBias => vec![vec![6]],
            CentroidalMomentumMatrix => vec![vec![6, n]],
            Regressor => vec![vec![n, model.parameter_count()]],
            EnergyRegressors => vec![vec![model.parameter_count()]; 2],
            FramePoses => vec![vec![model.frames().len(), 4, 4]],
        }
    }

    /// At one state, whose lengths were checked.
    ///
    /// # Errors
    /// A quaternion that is none; a singular mass matrix or task; no mass.
    #[inline]
    pub fn one(
        self,
        model: &Model,
        memory: &mut Memory,
        s: &[&[f64]],
        environment: &Environment,
        out: &mut [&mut [f64]],
    ) -> Result<(), Error> {
        if model.is_floating() && !matches!(self, JointFriction) {
            model.check_configuration(s[0])?;
        }
        let w = &mut memory.fast;
        match self {
            InverseDynamics => fast::inverse_dynamics(model, s[0], s[1], s[2], environment, w, out[0]),
            BiasForces => fast::bias_forces(model, s[0], s[1], environment, w, out[0]),
            VelocityProduct => fast::velocity_product(model, s[0], s[1], w, out[0]),
            MassMatrix => fast::mass_matrix(model, s[0], w, out[0]),
            CoriolisMatrix => fast::coriolis_matrix(model, s[0], s[1], w, out[0]),
            ForwardDynamics => {
                fast::forward_dynamics(model, s[0], s[1], s[2], environment, w, out[0]);
                if !w.is_regular() {
                    out[0].copy_from_slice(model.forward_dynamics(s[0], s[1], s[2], environment)?.as_slice());
                }
            }
            InverseDynamicsDerivatives => {
                let [a, b, c] = out else { return Ok(()) };
                fast::inverse_dynamics_derivatives(model, s[0], s[1], s[2], environment, w, [a, b, c]);
            }
            ForwardDynamicsDerivatives => {
                let [x, a, b, c] = out else { return Ok(()) };
                fast::forward_dynamics_derivatives(model, s[0], s[1], s[2], environment, w, x, [a, b, c]);
                if !w.is_regular() {
                    model.forward_dynamics_derivatives(s[0], s[1], s[2], environment)?;
                }
            }
            _ => return self.one_by_plain_kernel(model, memory, s, environment, out),
        }
        Ok(())
    }

    fn one_by_plain_kernel(
        self,
        model: &Model,
        memory: &mut Memory,
        s: &[&[f64]],
        environment: &Environment,
        out: &mut [&mut [f64]],
    ) -> Result<(), Error> {
        let w = &mut memory.plain;
        match self {
            GravityForces => kernel::gravity_forces(model, s[0], environment.gravity, w, out[0]),
            TipForces => kernel::tip_forces(model, s[0], environment.applied, w, out[0]),
            MassMatrixRate => kernel::mass_matrix_rate(model, s[0], s[1], w, out[0]),
            KineticEnergy => out[0][0] = kernel::kinetic_energy(model, s[0], s[1], environment.base_twist, w),
            PotentialEnergy => out[0][0] = kernel::potential_energy(model, s[0], environment.gravity, w),
            ForwardKinematics(frame) => {
                let T = kernel::forward_kinematics(model, s[0], frame).to_matrix();
                out[0].copy_from_slice(T.as_flattened());
            }
            SpaceJacobian(frame) => by_rows(model.n(), out[0], |J| kernel::space_jacobian(model, s[0], frame, J)),
            BodyJacobian(frame) => by_rows(model.n(), out[0], |J| kernel::body_jacobian(model, s[0], frame, J)),
            SpaceJacobianRate(frame) => {
                by_rows(model.n(), out[0], |dJ| kernel::space_jacobian_rate(model, s[0], s[1], frame, w, dJ));
            }
            BodyJacobianRate(frame) => {
                by_rows(model.n(), out[0], |dJ| kernel::body_jacobian_rate(model, s[0], s[1], frame, dJ));
            }
            TaskSpaceDynamics(task) => {
                let found = model.task_space_dynamics(s[0], s[1], task, environment)?;
                rows(&found.Lambda, out[0]);
                out[1].copy_from_slice(found.eta.as_slice());
            }
            JointFriction => out[0].copy_from_slice(model.joint_friction(s[0])?.as_slice()),
            SpaceJacobianDerivative(frame) => by_joint(&model.space_jacobian_derivative(s[0], frame)?, out[0]),
            BodyJacobianDerivative(frame) => by_joint(&model.body_jacobian_derivative(s[0], frame)?, out[0]),
            GravityForcesDerivative => {
                kernel::gravity_forces_derivative(model, s[0], environment.gravity, w, out[0]);
            }
            TipForcesDerivative => kernel::tip_forces_derivative(model, s[0], environment.applied, w, out[0]),
            MassMatrixProductDerivative => kernel::mass_matrix_product_derivative(model, s[0], s[1], w, out[0]),
            CenterOfMass => out[0].copy_from_slice(&model.center_of_mass(s[0])?.0),
            CenterOfMassVelocity => out[0].copy_from_slice(&model.center_of_mass_velocity(s[0], s[1])?.0),
            CenterOfMassAcceleration => {
                out[0].copy_from_slice(&model.center_of_mass_acceleration(s[0], s[1], s[2])?.0);
            }
            CenterOfMassJacobian => rows(&model.center_of_mass_jacobian(s[0])?, out[0]),
            Momentum(about) => out[0].copy_from_slice(&model.momentum(s[0], s[1], about)?.to_array()),
            MomentumRate(about) => out[0].copy_from_slice(&model.momentum_rate(s[0], s[1], s[2], about)?.to_array()),
            CentroidalMomentumMatrix => rows(&model.centroidal_momentum_matrix(s[0])?, out[0]),
            CentroidalMomentumBias => out[0].copy_from_slice(model.centroidal_momentum_bias(s[0], s[1])?.as_slice()),
            Regressor => rows(&model.regressor(s[0], s[1], s[2], environment)?, out[0]),
            EnergyRegressors => {
                let (kinetic, potential) = model.energy_regressors(s[0], s[1])?;
                out[0].copy_from_slice(kinetic.transpose().as_slice());
                out[1].copy_from_slice(potential.transpose().as_slice());
            }
            FramePoses => {
                let poses = model.frame_poses(s[0])?;
                let numbers = poses.into_iter().flat_map(|T| T.to_matrix().into_iter().flatten());
                out[0].iter_mut().zip(numbers).for_each(|(place, x)| *place = x);
            }
            _ => unreachable!("the quantities of `one`"),
        }
        Ok(())
    }
}

/// What the batch has of a type of numbers.
pub trait AtMany: Sized {
    /// The quantity at many states by the batch's own kernels; `None` where it has none.
    fn many(
        quantity: Quantity,
        batch: &Batch<Self>,
        state: &[&[Self]],
        around: &BatchEnvironment<Self>,
        out: &mut [&mut [Self]],
    ) -> Option<Result<(), mozzi_batch::Error>>
    where
        Self: mozzi_batch::Number;

    /// Likewise by machine code, of those numbers that there is some for.
    fn many_compiled(
        compiled: &Compiled,
        quantity: Quantity,
        state: &[&[Self]],
        out: &mut [&mut [Self]],
    ) -> Option<Result<(), mozzi_batch::Error>>;
}

macro_rules! at_many {
    ($($T:ty, $many_compiled:expr;)*) => { $(impl AtMany for $T {
        fn many_compiled(compiled: &Compiled, quantity: Quantity, state: &[&[$T]], out: &mut [&mut [$T]])
            -> Option<Result<(), mozzi_batch::Error>>
        {
            $many_compiled(compiled, quantity, state, out)
        }

        fn many(quantity: Quantity, batch: &Batch<$T>, s: &[&[$T]], around: &BatchEnvironment<$T>, out: &mut [&mut [$T]])
            -> Option<Result<(), mozzi_batch::Error>>
        {
            Some(match (quantity, out) {
                (InverseDynamics, [x]) => batch.inverse_dynamics(s[0], s[1], s[2], around, x),
                (ForwardDynamics, [x]) => batch.forward_dynamics(s[0], s[1], s[2], around, x),
                (MassMatrix, [x]) => batch.mass_matrix(s[0], x),
                (MassMatrixRate, [x]) => batch.mass_matrix_rate(s[0], s[1], x),
                (CoriolisMatrix, [x]) => batch.coriolis_matrix(s[0], s[1], x),
                (VelocityProduct, [x]) => batch.velocity_product(s[0], s[1], x),
                (GravityForces, [x]) => batch.gravity_forces(s[0], around, x),
                (BiasForces, [x]) => batch.bias_forces(s[0], s[1], around, x),
                (TipForces, [x]) => batch.tip_forces(s[0], around, x),
                (KineticEnergy, [x]) => batch.kinetic_energy(s[0], s[1], around, x),
                (PotentialEnergy, [x]) => batch.potential_energy(s[0], around, x),
                (ForwardKinematics(frame), [x]) => batch.forward_kinematics(frame, s[0], x),
                (SpaceJacobian(frame), [x]) => batch.space_jacobian(frame, s[0], x),
                (BodyJacobian(frame), [x]) => batch.body_jacobian(frame, s[0], x),
                (SpaceJacobianRate(frame), [x]) => batch.space_jacobian_rate(frame, s[0], s[1], x),
                (BodyJacobianRate(frame), [x]) => batch.body_jacobian_rate(frame, s[0], s[1], x),
                (TaskSpaceDynamics(task), [x, y]) => batch.task_space_dynamics(task, s[0], s[1], around, x, y),
                (InverseDynamicsDerivatives, [x, y, z]) => {
                    batch.inverse_dynamics_derivatives(s[0], s[1], s[2], around, x, y, z)
                }
                (ForwardDynamicsDerivatives, [x, y, z, w]) => {
                    batch.forward_dynamics_derivatives(s[0], s[1], s[2], around, x, y, z, w)
                }
                _ => return None,
            })
        }
    })* };
}
at_many! {
    f32, |_, _, _, _| None;
    f64, crate::compiled::many;
}

/// A matrix that is stored by columns, by rows.
pub fn rows(M: &mozzi::nalgebra::DMatrix<f64>, out: &mut [f64]) {
    let columns = M.ncols();
    out.iter_mut().enumerate().for_each(|(k, x)| *x = M[(k / columns, k % columns)]);
}

fn by_rows(n: usize, out: &mut [f64], fill: impl FnOnce(&mut [Twist])) {
    let mut columns = vec![Twist::zero(); n];
    fill(&mut columns);
    jacobian_rows(&columns, out);
}

/// A Jacobian's columns, as its rows.
pub fn jacobian_rows(columns: &[Twist], out: &mut [f64]) {
    for (j, column) in columns.iter().enumerate() {
        column.to_array().into_iter().enumerate().for_each(|(row, x)| out[row * columns.len() + j] = x);
    }
}

/// (n, 6, n): the Jacobian's derivative by each joint.
fn by_joint(derivatives: &[mozzi::Jacobian], out: &mut [f64]) {
    let n = derivatives.len();
    for (derivative, out) in derivatives.iter().zip(out.chunks_mut(6 * n)) {
        jacobian_rows(&derivative.0, out);
    }
}
