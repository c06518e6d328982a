// Written by `cargo xtask docs` from the list of quantities.

export! {
    mozzi_inverse_dynamics InverseDynamics
    (theta dtheta ddtheta) (environment: EnvironmentPointer)
    (tau: Vector)
}
export! {
    mozzi_forward_dynamics ForwardDynamics
    (theta dtheta tau) (environment: EnvironmentPointer)
    (ddtheta: Vector)
}
export! {
    mozzi_forward_dynamics_by_mass_matrix ForwardDynamicsByMassMatrix
    (theta dtheta tau) (environment: EnvironmentPointer)
    (ddtheta: Vector)
}
export! {
    mozzi_forward_dynamics_by_inverse_dynamics ForwardDynamicsByInverseDynamics
    (theta dtheta tau) (environment: EnvironmentPointer)
    (ddtheta: Vector)
}
export! {
    mozzi_mass_matrix MassMatrix
    (theta) ()
    (M: Matrix)
}
export! {
    mozzi_mass_matrix_inverse MassMatrixInverse
    (theta) ()
    (inverse: Matrix)
}
export! {
    mozzi_mass_matrix_rate MassMatrixRate
    (theta dtheta) ()
    (dM: Matrix)
}
export! {
    mozzi_coriolis_matrix CoriolisMatrix
    (theta dtheta) ()
    (C: Matrix)
}
export! {
    mozzi_velocity_product VelocityProduct
    (theta dtheta) ()
    (c: Vector)
}
export! {
    mozzi_gravity_forces GravityForces
    (theta) (environment: EnvironmentPointer)
    (g: Vector)
}
export! {
    mozzi_bias_forces BiasForces
    (theta dtheta) (environment: EnvironmentPointer)
    (h: Vector)
}
export! {
    mozzi_tip_forces TipForces
    (theta) (environment: EnvironmentPointer)
    (tau: Vector)
}
export! {
    mozzi_joint_friction JointFriction
    (dtheta) ()
    (f: Vector)
}
export! {
    mozzi_spring_forces SpringForces
    (theta) ()
    (f: Vector)
}
export! {
    mozzi_kinetic_energy KineticEnergy
    (theta dtheta) (environment: EnvironmentPointer)
    (energy: Vector)
}
export! {
    mozzi_potential_energy PotentialEnergy
    (theta) (environment: EnvironmentPointer)
    (energy: Vector)
}
export! {
    mozzi_forward_kinematics ForwardKinematics
    (theta) (frame: Frame)
    (T: Matrix)
}
export! {
    mozzi_frame_poses FramePoses
    (theta) ()
    (T: Tensor)
}
export! {
    mozzi_space_jacobian SpaceJacobian
    (theta) (frame: Frame)
    (J: Matrix)
}
export! {
    mozzi_body_jacobian BodyJacobian
    (theta) (frame: Frame)
    (J: Matrix)
}
export! {
    mozzi_space_jacobian_rate SpaceJacobianRate
    (theta dtheta) (frame: Frame)
    (dJ: Matrix)
}
export! {
    mozzi_body_jacobian_rate BodyJacobianRate
    (theta dtheta) (frame: Frame)
    (dJ: Matrix)
}
export! {
    mozzi_space_jacobian_derivative SpaceJacobianDerivative
    (theta) (frame: Frame)
    (H: Tensor)
}
export! {
    mozzi_body_jacobian_derivative BodyJacobianDerivative
    (theta) (frame: Frame)
    (H: Tensor)
}
export! {
    mozzi_frame_acceleration FrameAcceleration
    (theta dtheta ddtheta) (frame: Frame)
    (a: Vector)
}
export! {
    mozzi_task_space_dynamics TaskSpaceDynamics
    (theta dtheta) (task: TaskPointer, environment: EnvironmentPointer)
    (Lambda: Matrix, eta: Vector)
}
export! {
    mozzi_constrained_forward_dynamics ConstrainedForwardDynamics
    (theta dtheta tau) (environment: EnvironmentPointer)
    (ddtheta: Vector, multipliers: Vector)
}
export! {
    mozzi_constraint_jacobian ConstraintJacobian
    (theta) ()
    (A: Matrix)
}
export! {
    mozzi_constraint_bias ConstraintBias
    (theta dtheta) ()
    (dA_dtheta: Vector)
}
export! {
    mozzi_constraint_residual ConstraintResidual
    (theta) ()
    (phi: Vector)
}
export! {
    mozzi_constraint_projection ConstraintProjection
    (theta) ()
    (P: Matrix)
}
export! {
    mozzi_constraint_impulse ConstraintImpulse
    (theta dtheta) ()
    (dtheta_after: Vector, impulse: Vector)
}
export! {
    mozzi_inverse_dynamics_derivatives InverseDynamicsDerivatives
    (theta dtheta ddtheta) (environment: EnvironmentPointer)
    (d_theta: Matrix, d_dtheta: Matrix, d_ddtheta: Matrix)
}
export! {
    mozzi_forward_dynamics_derivatives ForwardDynamicsDerivatives
    (theta dtheta tau) (environment: EnvironmentPointer)
    (ddtheta: Vector, d_theta: Matrix, d_dtheta: Matrix, d_tau: Matrix)
}
export! {
    mozzi_inverse_dynamics_vjp InverseDynamicsVjp
    (theta dtheta ddtheta x) (environment: EnvironmentPointer)
    (d_theta: Vector, d_dtheta: Vector, d_ddtheta: Vector)
}
export! {
    mozzi_forward_dynamics_vjp ForwardDynamicsVjp
    (theta dtheta tau x) (environment: EnvironmentPointer)
    (d_theta: Vector, d_dtheta: Vector, d_tau: Vector)
}
export! {
    mozzi_inverse_dynamics_parameter_vjp InverseDynamicsParameterVjp
    (theta dtheta ddtheta x) (environment: EnvironmentPointer)
    (d_parameters: Vector, d_placements: Matrix, d_axes: Matrix, d_gravity: Vector)
}
export! {
    mozzi_forward_dynamics_parameter_vjp ForwardDynamicsParameterVjp
    (theta dtheta tau x) (environment: EnvironmentPointer)
    (d_parameters: Vector, d_placements: Matrix, d_axes: Matrix, d_gravity: Vector)
}
export! {
    mozzi_mass_matrix_product_vjp MassMatrixProductVjp
    (theta ddtheta x) ()
    (d_theta: Vector, d_ddtheta: Vector)
}
export! {
    mozzi_energy_gradients EnergyGradients
    (theta dtheta) (environment: EnvironmentPointer)
    (kinetic_d_theta: Vector, kinetic_d_dtheta: Vector, potential_d_theta: Vector)
}
export! {
    mozzi_frame_twist_vjp FrameTwistVjp
    (theta dtheta w) (frame: Frame)
    (d_theta: Vector, d_dtheta: Vector)
}
export! {
    mozzi_frame_acceleration_vjp FrameAccelerationVjp
    (theta dtheta ddtheta w) (frame: Frame)
    (d_theta: Vector, d_dtheta: Vector, d_ddtheta: Vector)
}
export! {
    mozzi_momentum_vjp MomentumVjp
    (theta dtheta w) (about: Point)
    (d_theta: Vector, d_dtheta: Vector)
}
export! {
    mozzi_momentum_rate_vjp MomentumRateVjp
    (theta dtheta ddtheta w) (about: Point)
    (d_theta: Vector, d_dtheta: Vector, d_ddtheta: Vector)
}
export! {
    mozzi_gravity_forces_derivative GravityForcesDerivative
    (theta) (environment: EnvironmentPointer)
    (dg: Matrix)
}
export! {
    mozzi_tip_forces_derivative TipForcesDerivative
    (theta) (environment: EnvironmentPointer)
    (dtau: Matrix)
}
export! {
    mozzi_mass_matrix_product_derivative MassMatrixProductDerivative
    (theta x) ()
    (dMx: Matrix)
}
export! {
    mozzi_center_of_mass CenterOfMass
    (theta) ()
    (c: Vector)
}
export! {
    mozzi_center_of_mass_velocity CenterOfMassVelocity
    (theta dtheta) ()
    (dc: Vector)
}
export! {
    mozzi_center_of_mass_acceleration CenterOfMassAcceleration
    (theta dtheta ddtheta) ()
    (ddc: Vector)
}
export! {
    mozzi_center_of_mass_jacobian CenterOfMassJacobian
    (theta) ()
    (J: Matrix)
}
export! {
    mozzi_momentum Momentum
    (theta dtheta) (about: Point)
    (h: Vector)
}
export! {
    mozzi_momentum_rate MomentumRate
    (theta dtheta ddtheta) (about: Point)
    (dh: Vector)
}
export! {
    mozzi_centroidal_momentum_matrix CentroidalMomentumMatrix
    (theta) ()
    (A: Matrix)
}
export! {
    mozzi_centroidal_momentum_bias CentroidalMomentumBias
    (theta dtheta) ()
    (b: Vector)
}
export! {
    mozzi_regressor Regressor
    (theta dtheta ddtheta) (environment: EnvironmentPointer)
    (Y: Matrix)
}
export! {
    mozzi_energy_regressors EnergyRegressors
    (theta dtheta) (environment: EnvironmentPointer)
    (kinetic: Vector, potential: Vector)
}
