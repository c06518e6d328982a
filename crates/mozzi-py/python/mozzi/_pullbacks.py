"""First and second derivatives of quantities in the form that automatic differentiation needs, on NumPy's arrays.

A quantity f(x) has inputs x: θ, others of length n, and for some the inertial parameters π as last. Its pullback is
g(x, w) = wᵀ∂f/∂x; derivatives by θ are along the n velocities (see ``_tangent``). For each quantity:

- ``value(x)`` is f;
- ``vjp(x, w, of_parameters)`` is g; the gradient by π is computed only if ``of_parameters``;
- ``jvp(x, u)`` is ∂f/∂x u; u without an entry for π leaves it constant;
- ``second(x, w, u, of_parameters)`` is ∂g/∂x u, by dual numbers. ``transposed`` turns it into the gradient of gᵀu.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _tangent
from ._mozzi import Model
from ._quantities import Array

Arrays = Sequence[Array]

OF_PARAMETERS = "inverse_dynamics_parameter_vjp"


def _directional(
    model: Model, quantity: str, inputs: Arrays, tangents: Sequence[Array | None], **environment: Any
) -> tuple[Any, Any]:
    """A quantity and its derivative along a direction."""
    return model.jvp(quantity, inputs, tangents, **environment)


def _row(w: Array, matrix: Array) -> Array:
    """wᵀ matrix."""
    found: Array = np.matmul(w[..., None, :], matrix)[..., 0, :]
    return found


class Differentiable:
    """A quantity of a model, of one of its frames if it has one."""

    inputs: tuple[str, ...] = ("theta",)
    name = ""
    has_parameters = False

    def __init__(self, model: Model, frame: str | None = None) -> None:
        self.model, self.frame = model, frame
        self.quaternions = model._quaternions
        self.n, self.nq, self.p = model.n, model.nq, len(model.parameters)
        self.shape: tuple[int, ...] = (self.n,)
        self.key = ""

    def lengths(self) -> tuple[int, ...]:
        """The length of each input, with that of π."""
        return (self.nq, *[self.n] * (len(self.inputs) - 1), self.p)

    def gradients(self, of_parameters: bool) -> list[int]:
        """The length of each gradient."""
        return [*[self.n] * len(self.inputs), *[self.p] * of_parameters]

    def split(self, x: Arrays) -> tuple[Arrays, dict[str, Any]]:
        """The inputs without π, and π as keyword."""
        k = len(self.inputs)
        return x[:k], ({"parameters": x[k]} if len(x) > k else {})

    def along(self, x: Arrays, u: Arrays) -> tuple[Arrays, Arrays, dict[str, Any]]:
        """The inputs, their tangents, and both of π as keywords."""
        (x, keywords), k = self.split(x), len(self.inputs)
        return x, u[:k], keywords | ({"parameters_tangent": u[k]} if len(u) > k else {})

    def value(self, x: Arrays) -> Array:
        raise NotImplementedError

    def vjp(self, x: Arrays, w: Array, of_parameters: bool) -> list[Array]:
        raise NotImplementedError

    def second(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        raise NotImplementedError

    def jvp(self, x: Arrays, u: Arrays) -> Array:
        x, u, keywords = self.along(x, u)
        if self.frame is not None:
            keywords["frame"] = self.frame
        rate: Array = _directional(self.model, self.name, x, u, **keywords)[1]
        return rate

    def transposed(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        """The gradient of gᵀu by x, with u constant."""
        found = self.second(x, w, u, of_parameters)
        if self.quaternions:
            found[0] = found[0] + _tangent.bracket(np, self.quaternions, u[0], self.vjp(x, w, False)[0])
        return found


class InverseDynamics(Differentiable):
    """τ, linear in π: wᵀ∂τ/∂π depends on the motion alone."""

    inputs = ("theta", "dtheta", "ddtheta")
    name = "inverse_dynamics"
    has_parameters = True

    def value(self, x: Arrays) -> Array:
        x, keywords = self.split(x)
        return self.model.inverse_dynamics(*x, **keywords) if keywords else self.model.inverse_dynamics(*x)

    def vjp(self, x: Arrays, w: Array, of_parameters: bool) -> list[Array]:
        (theta, dtheta, ddtheta), keywords = self.split(x)
        found = list(self.model.inverse_dynamics_vjp(theta, dtheta, ddtheta, w, **keywords))
        if of_parameters:
            found.append(self.model.inverse_dynamics_parameter_vjp(theta, dtheta, ddtheta, w).d_parameters)
        return found

    def second(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        x, u, keywords = self.along(x, u)
        found = list(_directional(self.model, "inverse_dynamics_vjp", [*x, w], [*u, None], **keywords)[1])
        if of_parameters:
            found.append(_directional(self.model, OF_PARAMETERS, [*x, w], [*u, None])[1].d_parameters)
        return found


class ForwardDynamics(Differentiable):
    """θ̈ = M⁻¹(τ − h): wᵀ∂θ̈/∂π = −(M⁻¹w)ᵀ∂τ/∂π at this θ̈."""

    inputs = ("theta", "dtheta", "tau")
    name = "forward_dynamics"
    has_parameters = True

    def value(self, x: Arrays) -> Array:
        x, keywords = self.split(x)
        return self.model.forward_dynamics(*x, **keywords) if keywords else self.model.forward_dynamics(*x)

    def vjp(self, x: Arrays, w: Array, of_parameters: bool) -> list[Array]:
        (theta, dtheta, tau), keywords = self.split(x)
        found = list(self.model.forward_dynamics_vjp(theta, dtheta, tau, w, **keywords))
        if of_parameters:
            ddtheta = self.model.forward_dynamics(theta, dtheta, tau, **keywords)
            motion = (theta, dtheta, ddtheta, -found[2])
            found.append(self.model.inverse_dynamics_parameter_vjp(*motion).d_parameters)
        return found

    def second(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        x, u, keywords = self.along(x, u)
        values, rates = _directional(self.model, "forward_dynamics_vjp", [*x, w], [*u, None], **keywords)
        found = list(rates)
        if of_parameters:
            (theta, dtheta, _), (dq, ddq, _) = x, u
            ddtheta, rate = _directional(self.model, "forward_dynamics", x, u, **keywords)
            motion, rates_of = [theta, dtheta, ddtheta, -values.d_tau], [dq, ddq, rate, -rates.d_tau]
            found.append(_directional(self.model, OF_PARAMETERS, motion, rates_of)[1].d_parameters)
        return found


class MassMatrix(Differentiable):
    """M, whose k-th column is τ at rest without gravity for θ̈ = e_k, less the springs' forces.

    So Σ W_ik ∂M_ik is a sum of n pullbacks of τ: no derivative of a matrix is formed.
    """

    name = "mass_matrix"
    has_parameters = True

    def __init__(self, model: Model, frame: str | None = None) -> None:
        super().__init__(model, frame)
        self.shape = (self.n, self.n)

    def value(self, x: Arrays) -> Array:
        x, keywords = self.split(x)
        return self.model.mass_matrix(*x, **keywords)

    def _columns(self, x: Arrays, w: Array) -> tuple[list[Array], Array, dict[str, Any]]:
        """Inputs of inverse dynamics and its cotangents, for n columns and for the springs alone."""
        (theta,), keywords = self.split(x)
        ddtheta = np.concatenate([np.eye(self.n), np.zeros((1, self.n))]).astype(theta.dtype)
        w = np.swapaxes(w, -1, -2)
        w = np.concatenate([w, -w.sum(-2, keepdims=True)], axis=-2)
        still = np.zeros(self.n, theta.dtype)
        keywords = {name: array[..., None, :] for name, array in keywords.items()}
        return [theta[..., None, :], still, ddtheta], w, keywords

    def vjp(self, x: Arrays, w: Array, of_parameters: bool) -> list[Array]:
        (theta, dtheta, ddtheta), w, keywords = self._columns(x, w)
        still = [0.0] * 3
        found = [self.model.inverse_dynamics_vjp(theta, dtheta, ddtheta, w, gravity=still, **keywords).d_theta.sum(-2)]
        if of_parameters:
            products = self.model.inverse_dynamics_parameter_vjp(theta, dtheta, ddtheta, w, gravity=still)
            found.append(products.d_parameters.sum(-2))
        return found

    def second(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        x, w, keywords = self._columns(x, w)
        along = [u[0][..., None, :], None, None]
        rate = {"parameters_tangent": u[1][..., None, :]} if len(u) > 1 else {}
        at = [*x, w]
        rates = _directional(
            self.model, "inverse_dynamics_vjp", at, [*along, None], gravity=[0.0] * 3, **keywords, **rate
        )[1]
        found = [rates.d_theta.sum(-2)]
        if of_parameters:
            rates = _directional(self.model, OF_PARAMETERS, at, [*along, None], gravity=[0.0] * 3)[1]
            found.append(rates.d_parameters.sum(-2))
        return found


class ForwardKinematics(Differentiable):
    """T, with Ṫ = T[J_b θ̇]: wᵀ∂T/∂θ = cᵀJ_b, c the wrench of w on the frame's turn and displacement."""

    name = "forward_kinematics"

    def __init__(self, model: Model, frame: str | None = None) -> None:
        super().__init__(model, frame)
        self.shape = (4, 4)

    def value(self, x: Arrays) -> Array:
        return self.model.forward_kinematics(x[0], self.frame)

    @staticmethod
    def _wrench(T: Array, w: Array) -> Array:
        """c, linear in T."""
        Rt = np.swapaxes(T[..., :3, :3], -1, -2)
        G, f = np.matmul(Rt, w[..., :3, :3]), np.matmul(Rt, w[..., :3, 3:])[..., 0]
        turn = [G[..., 2, 1] - G[..., 1, 2], G[..., 0, 2] - G[..., 2, 0], G[..., 1, 0] - G[..., 0, 1]]
        return np.concatenate([np.stack(turn, -1), f], -1)

    def vjp(self, x: Arrays, w: Array, of_parameters: bool) -> list[Array]:
        return [_row(self._wrench(self.value(x), w), self.model.body_jacobian(x[0], self.frame))]

    def second(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        T, dT = _directional(self.model, self.name, x, u, frame=self.frame)
        J, dJ = _directional(self.model, "body_jacobian", x, u, frame=self.frame)
        return [_row(self._wrench(dT, w), J) + _row(self._wrench(T, w), dJ)]


class BodyJacobian(Differentiable):
    """J(θ), by its derivatives ∂J/∂θ_j."""

    name = "body_jacobian"

    def __init__(self, model: Model, frame: str | None = None) -> None:
        super().__init__(model, frame)
        self.shape = (6, self.n)

    def value(self, x: Arrays) -> Array:
        J: Array = getattr(self.model, self.name)(x[0], self.frame)
        return J

    def vjp(self, x: Arrays, w: Array, of_parameters: bool) -> list[Array]:
        dJ: Array = getattr(self.model, self.name + "_derivative")(x[0], self.frame)
        return [(dJ * w[..., None, :, :]).sum((-2, -1))]

    def second(self, x: Arrays, w: Array, u: Arrays, of_parameters: bool) -> list[Array]:
        d2J = _directional(self.model, self.name + "_derivative", x, u, frame=self.frame)[1]
        return [(d2J * w[..., None, :, :]).sum((-2, -1))]


class SpaceJacobian(BodyJacobian):
    name = "space_jacobian"


QUANTITIES: dict[str, type[Differentiable]] = {
    kind.name: kind
    for kind in (InverseDynamics, ForwardDynamics, MassMatrix, ForwardKinematics, BodyJacobian, SpaceJacobian)
}
