"""Several results of a quantity, as named tuples. Written by `cargo xtask docs` from the list of quantities."""

from typing import Any, NamedTuple

from numpy.typing import NDArray

Array = NDArray[Any]

__all__ = [
    "TaskSpaceDynamics",
    "ConstrainedForwardDynamics",
    "ConstraintImpulse",
    "InverseDynamicsDerivatives",
    "ForwardDynamicsDerivatives",
    "InverseDynamicsVjp",
    "ForwardDynamicsVjp",
    "InverseDynamicsParameterVjp",
    "ForwardDynamicsParameterVjp",
    "MassMatrixProductVjp",
    "EnergyGradients",
    "FrameTwistVjp",
    "FrameAccelerationVjp",
    "MomentumVjp",
    "MomentumRateVjp",
    "EnergyRegressors",
]


class TaskSpaceDynamics(NamedTuple):
    """Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as the rows of a frame's twist show them.

    See ``Model.task_space_dynamics``.
    """

    Lambda: Array
    """Shape (..., k, k): kg m², kg m, kg."""
    eta: Array
    """Shape (..., k): N m, N."""


class ConstrainedForwardDynamics(NamedTuple):
    """θ̈ and λ of τ = Mθ̈ + c + g + JᵀF + f + Aᵀλ with Aθ̈ + Ȧθ̇ = 0.

    See ``Model.constrained_forward_dynamics``.
    """

    ddtheta: Array
    """Shape (..., n): rad/s² or m/s²."""
    multipliers: Array
    """Shape (..., m): N m or N."""


class ConstraintImpulse(NamedTuple):
    """θ̇⁺ and Λ of M(θ̇⁺ − θ̇) = −AᵀΛ with Aθ̇⁺ = 0: the velocities after the constraints have begun to act.

    See ``Model.constraint_impulse``.
    """

    dtheta_after: Array
    """Shape (..., n): rad/s or m/s."""
    impulse: Array
    """Shape (..., m): N m s or N s."""


class InverseDynamicsDerivatives(NamedTuple):
    """∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, row i of τ_i; by θ along the velocities.

    See ``Model.inverse_dynamics_derivatives``.
    """

    d_theta: Array
    """Shape (..., n, n): N m or N, each per unit of its column."""
    d_dtheta: Array
    """Shape (..., n, n): N m or N, each per unit of its column."""
    d_ddtheta: Array
    """Shape (..., n, n): N m or N, each per unit of its column."""


class ForwardDynamicsDerivatives(NamedTuple):
    """θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, row i of θ̈_i; by θ along the velocities.

    See ``Model.forward_dynamics_derivatives``.
    """

    ddtheta: Array
    """Shape (..., n): rad/s² or m/s²."""
    d_theta: Array
    """Shape (..., n, n): rad/s² or m/s², each per unit of its column."""
    d_dtheta: Array
    """Shape (..., n, n): rad/s² or m/s², each per unit of its column."""
    d_tau: Array
    """Shape (..., n, n): rad/s² or m/s², each per unit of its column."""


class InverseDynamicsVjp(NamedTuple):
    """xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ = Mx, the gradient of xᵀτ; by θ along the velocities.

    See ``Model.inverse_dynamics_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_dtheta: Array
    """Shape (..., n): any."""
    d_ddtheta: Array
    """Shape (..., n): any."""


class ForwardDynamicsVjp(NamedTuple):
    """xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ = M⁻¹x, the gradient of xᵀθ̈; by θ along the velocities.

    See ``Model.forward_dynamics_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_dtheta: Array
    """Shape (..., n): any."""
    d_tau: Array
    """Shape (..., n): any."""


class InverseDynamicsParameterVjp(NamedTuple):
    """xᵀ∂τ/∂π = xᵀY, and xᵀ∂τ by the joints' placements and axes and by gravity: the gradient of xᵀτ by the robot.

    See ``Model.inverse_dynamics_parameter_vjp``.
    """

    d_parameters: Array
    """Shape (..., p): any."""
    d_placements: Array
    """Shape (..., b, 6): any."""
    d_axes: Array
    """Shape (..., b, 6): any."""
    d_gravity: Array
    """Shape (..., 3): any."""


class ForwardDynamicsParameterVjp(NamedTuple):
    """xᵀ∂θ̈/∂π, and xᵀ∂θ̈ by the joints' placements and axes and by gravity: the gradient of xᵀθ̈ by the robot.

    See ``Model.forward_dynamics_parameter_vjp``.
    """

    d_parameters: Array
    """Shape (..., p): any."""
    d_placements: Array
    """Shape (..., b, 6): any."""
    d_axes: Array
    """Shape (..., b, 6): any."""
    d_gravity: Array
    """Shape (..., 3): any."""


class MassMatrixProductVjp(NamedTuple):
    """xᵀ∂(M(θ)θ̈)/∂θ along the velocities, and Mx: the gradient of xᵀMθ̈.

    See ``Model.mass_matrix_product_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_ddtheta: Array
    """Shape (..., n): any."""


class EnergyGradients(NamedTuple):
    """∂𝒦/∂θ, ∂𝒦/∂θ̇ and ∂𝒫/∂θ of the kinetic and potential energy; by θ along the velocities.

    See ``Model.energy_gradients``.
    """

    kinetic_d_theta: Array
    """Shape (..., n): N m or N."""
    kinetic_d_dtheta: Array
    """Shape (..., n): N m s or N s."""
    potential_d_theta: Array
    """Shape (..., n): N m or N."""


class FrameTwistVjp(NamedTuple):
    """wᵀ∂𝒱_b/∂θ along the velocities, and J_bᵀw: the gradient of wᵀ𝒱_b, the twist of a frame in its own coordinates.

    See ``Model.frame_twist_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_dtheta: Array
    """Shape (..., n): any."""


class FrameAccelerationVjp(NamedTuple):
    """wᵀ∂a_b/∂θ along the velocities, wᵀ∂a_b/∂θ̇ and J_bᵀw: the gradient of wᵀa_b, a_b the acceleration of a frame.

    See ``Model.frame_acceleration_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_dtheta: Array
    """Shape (..., n): any."""
    d_ddtheta: Array
    """Shape (..., n): any."""


class MomentumVjp(NamedTuple):
    """wᵀ∂h/∂θ along the velocities, and wᵀ∂h/∂θ̇: the gradient of wᵀh, h the momentum about a point of {s}.

    See ``Model.momentum_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_dtheta: Array
    """Shape (..., n): any."""


class MomentumRateVjp(NamedTuple):
    """wᵀ∂ḣ/∂θ along the velocities, wᵀ∂ḣ/∂θ̇ and wᵀ∂ḣ/∂θ̈: the gradient of wᵀḣ, ḣ the rate of the momentum.

    See ``Model.momentum_rate_vjp``.
    """

    d_theta: Array
    """Shape (..., n): any."""
    d_dtheta: Array
    """Shape (..., n): any."""
    d_ddtheta: Array
    """Shape (..., n): any."""


class EnergyRegressors(NamedTuple):
    """the rows that give the kinetic and the potential energy of the parameters π.

    See ``Model.energy_regressors``.
    """

    kinetic: Array
    """Shape (..., p): J, each per unit of its parameter."""
    potential: Array
    """Shape (..., p): J, each per unit of its parameter."""
