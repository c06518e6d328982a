//! The list of all quantities.
//!
//! A [`Kernel`] is code, compiled for every kind of number. A [`Quantity`] is a declaration at the foot of its kernel's
//! file: name, inputs, outputs. [`quantities!`](crate::quantities!) lists them, once; from that list come the fast
//! functions on `f64` ([`fast`](crate::fast)), batches, recorded programs, machine code, emitted text, `mozzi compute`,
//! Python's methods and `docs/quantities.md`.
//!
//! ```
//! use mozzi::quantities::{BodyJacobian, Query};
//! # fn example(model: &mozzi::Model, theta: &[f64]) -> Result<(), mozzi::Error> {
//! let tip = model.end_effector()?;
//! // 6 × n, by rows
//! let J = model.compute(Query::from(BodyJacobian).of(tip), &[theta], &model.environment())?.remove(0);
//! let by_name = model.compute(Query::named("body-jacobian")?.of(tip), &[theta], &model.environment())?.remove(0);
//! assert_eq!(J, by_name);
//! # Ok(()) }
//! ```

mod compute;
mod declaration;
mod kernel;
mod memory;
mod query;
mod subject;

pub(crate) use compute::{are_clear, vectors};
pub(crate) use declaration::*;
pub use declaration::{Declaration, Dim, INPUTS, Input, Of, Output, Uses};
#[doc(hidden)]
pub use kernel::{Call, Kernel};
pub(crate) use kernel::{Entry, Inputs, Outputs, evaluate};
pub use kernel::{MOST_INPUTS, MOST_OUTPUTS, Quantity};
pub use memory::Memory;
pub(crate) use memory::{by_rows, six, sized};
pub use query::{ALIASES, Query};
pub use subject::Subject;

use crate::model::{Environment, Model};
use crate::scalar::Scalar;

/// All quantities, in the order of documentation: `quantities!(callback)` becomes `callback! { InverseDynamics … }`.
#[macro_export]
macro_rules! quantities {
    ($callback:ident) => {
        $callback! {
            InverseDynamics ForwardDynamics ForwardDynamicsByMassMatrix ForwardDynamicsByInverseDynamics
            MassMatrix MassMatrixInverse MassMatrixRate CoriolisMatrix VelocityProduct GravityForces BiasForces TipForces JointFriction SpringForces
            KineticEnergy PotentialEnergy
            ForwardKinematics FramePoses SpaceJacobian BodyJacobian SpaceJacobianRate BodyJacobianRate
            SpaceJacobianDerivative BodyJacobianDerivative FrameAcceleration TaskSpaceDynamics
            ConstrainedForwardDynamics ConstraintJacobian ConstraintBias ConstraintResidual ConstraintProjection
            ConstraintImpulse
            InverseDynamicsDerivatives ForwardDynamicsDerivatives InverseDynamicsVjp ForwardDynamicsVjp
            InverseDynamicsParameterVjp ForwardDynamicsParameterVjp MassMatrixProductVjp EnergyGradients
            FrameTwistVjp FrameAccelerationVjp MomentumVjp MomentumRateVjp
            GravityForcesDerivative TipForcesDerivative MassMatrixProductDerivative
            CenterOfMass CenterOfMassVelocity CenterOfMassAcceleration CenterOfMassJacobian
            Momentum MomentumRate CentroidalMomentumMatrix CentroidalMomentumBias
            Regressor EnergyRegressors
        }
    };
}

pub use crate::constraints::{
    forward_dynamics::ConstrainedForwardDynamics,
    impulse::ConstraintImpulse,
    jacobian::{ConstraintBias, ConstraintJacobian, ConstraintResidual},
    projection::ConstraintProjection,
};
pub use crate::dynamics::{
    bias_forces::{BiasForces, GravityForces, TipForces, VelocityProduct},
    center_of_mass::{CenterOfMass, CenterOfMassAcceleration, CenterOfMassJacobian, CenterOfMassVelocity},
    centroidal_momentum::{CentroidalMomentumBias, CentroidalMomentumMatrix},
    coriolis_matrix::{CoriolisMatrix, MassMatrixRate},
    energy::{KineticEnergy, PotentialEnergy},
    energy_gradients::EnergyGradients,
    force_derivatives::{GravityForcesDerivative, MassMatrixProductDerivative, TipForcesDerivative},
    forward_dynamics::ForwardDynamics,
    forward_dynamics_by_inverse_dynamics::ForwardDynamicsByInverseDynamics,
    forward_dynamics_derivatives::ForwardDynamicsDerivatives,
    forward_dynamics_vjp::ForwardDynamicsVjp,
    frame_vjp::{FrameAccelerationVjp, FrameTwistVjp},
    inverse_dynamics::InverseDynamics,
    inverse_dynamics_derivatives::InverseDynamicsDerivatives,
    inverse_dynamics_vjp::InverseDynamicsVjp,
    joint_friction::JointFriction,
    mass_matrix::MassMatrix,
    mass_matrix_inverse::MassMatrixInverse,
    mass_matrix_product_vjp::MassMatrixProductVjp,
    mass_matrix_solve::ForwardDynamicsByMassMatrix,
    momentum::{Momentum, MomentumRate},
    momentum_vjp::{MomentumRateVjp, MomentumVjp},
    parameter_vjp::{ForwardDynamicsParameterVjp, InverseDynamicsParameterVjp},
    regressor::{EnergyRegressors, Regressor},
    spring_forces::SpringForces,
    task_space_dynamics::TaskSpaceDynamics,
};
pub use crate::kinematics::{
    forward::{ForwardKinematics, FramePoses},
    frame_acceleration::FrameAcceleration,
    jacobian::{BodyJacobian, SpaceJacobian},
    jacobian_derivative::{BodyJacobianDerivative, SpaceJacobianDerivative},
    jacobian_rate::{BodyJacobianRate, SpaceJacobianRate},
};

/// The declarations, in the order of the list.
pub const LIST: &[Declaration] = {
    macro_rules! declarations {
        ($($Q:ident)*) => { &[$($Q::DECLARATION),*] };
    }
    quantities!(declarations)
};

pub(crate) const fn place_of(name: &str) -> usize {
    let mut place = 0;
    while place < LIST.len() {
        if are_equal(LIST[place].name.as_bytes(), name.as_bytes()) {
            return place;
        }
        place += 1;
    }
    panic!("a quantity that is not in the list")
}

const fn are_equal(a: &[u8], b: &[u8]) -> bool {
    let mut k = 0;
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}

/// The entries of all quantities on one kind of number.
pub(crate) struct Entries<S, C>(core::marker::PhantomData<(S, C)>);

impl<S: Scalar + From<C> + 'static, C: Scalar + 'static> Entries<S, C> {
    pub const LIST: &'static [Entry<S, C>] = {
        macro_rules! entries {
            ($($Q:ident)*) => { &[$(evaluate::<$Q, S, C>),*] };
        }
        quantities!(entries)
    };
}

impl Query<'_> {
    /// The quantity on any kind of number, by its kernel. Each kind of number compiles all kernels where this is
    /// called: on `f64` use [`fast`](crate::fast) or [`Model::compute`].
    ///
    /// # Panics
    /// On slices of a wrong number or length.
    pub fn evaluate<S: Scalar + From<C> + 'static, C: Scalar + 'static>(
        &self,
        model: &Model<C>,
        inputs: &[&[S]],
        environment: &Environment<S>,
        memory: &mut Memory<S>,
        outputs: &mut [&mut [S]],
    ) {
        let (inputs, mut outputs) = (self.inputs(inputs), self.outputs(outputs));
        Entries::<S, C>::LIST[self.index](&self.subject, model, &inputs, environment, memory, &mut outputs);
    }

    /// The given inputs at their positions, after a check of their number.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn inputs<'a, S>(&self, given: &[&'a [S]]) -> Inputs<'a, S> {
        assert!(given.len() == self.declaration().inputs.len(), "{} inputs of {}", given.len(), self.name());
        let input = |k: usize| if k < given.len() { given[k] } else { &[] };
        [input(0), input(1), input(2), input(3)]
    }

    /// The given outputs at their positions, after a check of their number.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn outputs<'a, S>(&self, given: &'a mut [&mut [S]]) -> Outputs<'a, S> {
        match given {
            _ if given.len() != self.declaration().outputs.len() => {
                panic!("{} outputs of {}", given.len(), self.name())
            }
            [a] => [a, &mut [], &mut [], &mut []],
            [a, b] => [a, b, &mut [], &mut []],
            [a, b, c] => [a, b, c, &mut []],
            [a, b, c, d] => [a, b, c, d],
            _ => Default::default(),
        }
    }
}
