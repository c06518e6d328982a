"""Dynamics of a robot in PyTorch, differentiable with respect to states and inertial parameters.

>>> import mozzi, mozzi.torch, torch                                    # doctest: +SKIP
>>> robot = mozzi.torch.Model(mozzi.models.ur5())                       # doctest: +SKIP
>>> theta = torch.zeros(6, dtype=torch.float64, requires_grad=True)     # doctest: +SKIP
>>> robot.mass_matrix(theta).trace().backward()                         # doctest: +SKIP

Tensors are float64 or float32, all of one dtype, on the CPU or on one NVIDIA GPU; memory is shared with them, not
copied. Leading axes are states and are broadcast. All of `torch.autograd` and `torch.func` works, to second order;
`torch.compile` and `torch.export` call the same functions as custom operators, to first order in reverse. On a GPU
these operators are the kernels of `mozzi.Model.to_gpu`: gradients of inverse and forward dynamics and of rollouts, of
first order, in reverse.

θ has nq numbers. A gradient with respect to a quaternion is that of a function of q/‖q‖: tangent to the sphere.
"""

# mypy: ignore-errors
# pyright: reportMissingImports=false, reportFunctionMemberAccess=false, reportCallIssue=false
# pyright: reportIncompatibleMethodOverride=false, reportReturnType=false, reportAssignmentType=false

import hashlib
import math
import pickle

try:
    import torch
except ModuleNotFoundError as error:
    if error.name != "torch":
        raise
    raise ImportError("mozzi.torch needs PyTorch, which is not installed: pip install torch") from error
from torch import Tensor
from torch._C import _are_functorch_transforms_active as _is_transformed
from torch._C._functorch import is_legacy_batchedtensor
from torch.autograd import forward_ad

from . import _mozzi, _tangent, _torch_gpu
from ._names import listed as _listed
from ._torch_operators import known, packed_op, refuse_forward_mode, run, to_positions, value_op
from ._torch_rollout import check_rows, rollout, steps
from ._torch_tensors import DTYPES, MODELS, arrays, batched, check
from ._torch_tensors import tensors as as_tensors

__all__ = ["Model"]
__dir__ = _listed(globals())

_PLAIN = (Tensor, torch.nn.Parameter)


def _broadcast(x):
    """Broadcast the leading axes of all tensors by torch, so that gradients are summed over them."""
    leading = x[0].shape[:-1]
    for t in x:
        if t.ndim != 1 and t.shape[:-1] != leading or t.ndim == 1 and leading:
            break
    else:
        return x
    leading = torch.broadcast_shapes(*[t.shape[:-1] for t in x])
    return [t if t.shape[:-1] == leading else t.expand(*leading, t.shape[-1]) for t in x]


def _to_velocities(quantity, theta, rate):
    return _tangent.velocities(torch, quantity.quaternions, theta, rate) if quantity.quaternions else rate


def _value(quantity, x):
    return _torch_gpu.value(list(x), quantity.key) if x[0].is_cuda else torch.from_numpy(quantity.value(arrays(x)))


def _derived(quantity, method, count, of_parameters, tensors):
    """Compute a derivative of a quantity on tensors."""
    if tensors[0].is_cuda:
        if method != "vjp":
            raise NotImplementedError(
                f"derivatives of {quantity.name} on {tensors[0].device} are of first order, in reverse mode"
            )
        w, *x = tensors
        return _torch_gpu.pull_back(x, w, quantity.key, of_parameters)
    if any(map(is_legacy_batchedtensor, tensors)):
        # of torch.autograd.grad(is_grads_batched=True): torch calls an operator of one tensor for each of them
        leading = tensors[-1].shape[:-1]
        packed = torch.cat([t.reshape(*leading, -1) for t in tensors], dim=-1)
        found = packed_op(packed, quantity.key, method, count, of_parameters)
        shapes = [quantity.shape] if method == "jvp" else [(n,) for n in quantity.gradients(of_parameters)]
        parts = found.split([math.prod(shape) for shape in shapes], dim=-1)
        return [part.reshape(*leading, *shape) for part, shape in zip(parts, shapes)]
    return as_tensors(run(quantity, method, count, of_parameters, arrays(tensors)))


# torch.autograd.Function: value f(x), pullback g(x, w), derivative ∂f/∂x u, and ∂g/∂x u. See `_pullbacks`.


class _Value(torch.autograd.Function):
    @staticmethod
    def forward(quantity, *x):
        return _value(quantity, x)

    @staticmethod
    def setup_context(ctx, inputs, output):
        ctx.quantity, *x = inputs
        ctx.save_for_backward(*x)
        ctx.save_for_forward(*x)

    @staticmethod
    def backward(ctx, w):
        x, k = ctx.saved_tensors, len(ctx.quantity.inputs)
        of_parameters = len(x) > k and ctx.needs_input_grad[-1]
        if torch.is_grad_enabled() or _is_transformed():
            first, *others = _Vjp.apply(ctx.quantity, of_parameters, w, *x)
        else:
            first, *others = _derived(ctx.quantity, "vjp", len(x), of_parameters, (w, *x))
        others += [None] * (len(x) - 1 - len(others))
        return (None, to_positions(ctx.quantity, x[0], first), *others)

    @staticmethod
    def jvp(ctx, _, *rates):
        return _Jvp.apply(ctx.quantity, len(rates), *ctx.saved_tensors, *_directions(ctx, rates))

    @staticmethod
    def vmap(info, in_dims, quantity, *x):
        return _Value.apply(quantity, *batched(info, in_dims[1:], x)), 0


class _Eager(torch.autograd.Function):
    """`_Value` without forward mode and transforms: torch calls it in half the time."""

    @staticmethod
    def forward(ctx, quantity, *x):
        ctx.quantity = quantity
        ctx.save_for_backward(*x)
        return torch.from_numpy(quantity.value(arrays(x)))

    backward = _Value.backward


def _directions(ctx, rates):
    """The tangents of x along the velocities; missing ones are zero, and that of π is left out."""
    x, quantity = ctx.saved_tensors[-len(rates) :], ctx.quantity
    rates = [torch.zeros_like(t) if rate is None else rate for t, rate in zip(x, rates)]
    return [_to_velocities(quantity, x[0], rates[0]), *rates[1:]]


class _Vjp(torch.autograd.Function):
    @staticmethod
    def forward(quantity, of_parameters, w, *x):
        return tuple(_derived(quantity, "vjp", len(x), of_parameters, (w, *x)))

    @staticmethod
    def setup_context(ctx, inputs, output):
        ctx.quantity, ctx.of_parameters, *tensors = inputs
        ctx.save_for_backward(*tensors)
        ctx.save_for_forward(*tensors)

    @staticmethod
    def backward(ctx, *u):
        (w, *x), quantity = ctx.saved_tensors, ctx.quantity
        of_parameters = len(x) > len(quantity.inputs) and ctx.needs_input_grad[-1]
        first, *others = _Second.apply(quantity, True, of_parameters, len(x), w, *x, *u)
        others += [None] * (len(x) - 1 - len(others))
        return (None, None, _Jvp.apply(quantity, len(x), *x, *u), to_positions(quantity, x[0], first), *others)

    @staticmethod
    def jvp(ctx, _, __, rate_of_w, *rates):
        (w, *x), quantity = ctx.saved_tensors, ctx.quantity
        found = _Second.apply(quantity, False, ctx.of_parameters, len(x), w, *x, *_directions(ctx, rates))
        if rate_of_w is not None:
            found = tuple(map(torch.add, found, _Vjp.apply(quantity, ctx.of_parameters, rate_of_w, *x)))
        return found

    @staticmethod
    def vmap(info, in_dims, quantity, of_parameters, *tensors):
        found = _Vjp.apply(quantity, of_parameters, *batched(info, in_dims[2:], tensors))
        return found, (0,) * len(found)


class _Jvp(torch.autograd.Function):
    @staticmethod
    def forward(quantity, count, *tensors):
        return _derived(quantity, "jvp", count, False, tensors)[0]

    @staticmethod
    def setup_context(ctx, inputs, output):
        ctx.quantity, ctx.count, *tensors = inputs
        ctx.save_for_backward(*tensors)

    @staticmethod
    def backward(ctx, w):
        tensors, quantity, k = ctx.saved_tensors, ctx.quantity, ctx.count
        x, u = tensors[:k], tensors[k:]
        of_parameters = k > len(quantity.inputs) and ctx.needs_input_grad[k + 1]
        first, *others = _Second.apply(quantity, True, of_parameters, k, w, *x, *u)
        others += [None] * (k - 1 - len(others))
        of_u = _Vjp.apply(quantity, len(u) > len(quantity.inputs), w, *x)
        return (None, None, to_positions(quantity, x[0], first), *others, *of_u)

    @staticmethod
    def jvp(ctx, *rates):
        raise NotImplementedError(
            f"forward over forward mode of {ctx.quantity.name}: use reverse mode inside, as torch.func.hessian does"
        )

    @staticmethod
    def vmap(info, in_dims, quantity, count, *tensors):
        return _Jvp.apply(quantity, count, *batched(info, in_dims[2:], tensors)), 0


class _Second(torch.autograd.Function):
    @staticmethod
    def forward(quantity, transposed, of_parameters, count, *tensors):
        return tuple(_derived(quantity, "transposed" if transposed else "second", count, of_parameters, tensors))

    @staticmethod
    def setup_context(ctx, inputs, output):
        ctx.quantity = inputs[0]

    @staticmethod
    def backward(ctx, *gradients):
        raise NotImplementedError(f"third derivatives of {ctx.quantity.name}")

    @staticmethod
    def jvp(ctx, *rates):
        raise NotImplementedError(f"third derivatives of {ctx.quantity.name}")

    @staticmethod
    def vmap(info, in_dims, quantity, transposed, of_parameters, count, *tensors):
        found = _Second.apply(quantity, transposed, of_parameters, count, *batched(info, in_dims[4:], tensors))
        return found, (0,) * len(found)


# the robot


def _call(robot, name, x, frame=None):
    key = f"{robot._contents}:{name}:{frame or ''}"
    if torch.compiler.is_compiling():
        return value_op(list(_broadcast(x)), key)
    quantity = known(key)
    dtype, is_plain, has_gradient = getattr(x[0], "dtype", None), True, False
    for t in x:
        if type(t) not in _PLAIN or t.dtype is not dtype or not t.is_cpu:
            is_plain = False
            break
        has_gradient = has_gradient or t.requires_grad
    if not is_plain or dtype not in DTYPES:
        check((*quantity.inputs, "parameters"), x)
        if x[0].is_cuda:
            refuse_forward_mode(x)
            # torch's custom operators have no rule for transforms
            return _Value.apply(quantity, *_broadcast(x)) if _is_transformed() else value_op(list(_broadcast(x)), key)
    if _is_transformed() or forward_ad._current_level >= 0:
        return _Value.apply(quantity, *_broadcast(x))
    if not is_plain:
        return value_op(list(_broadcast(x)), key)  # fake tensors
    if has_gradient and torch.is_grad_enabled():
        return _Eager.apply(quantity, *_broadcast(x))
    return torch.from_numpy(quantity.value(arrays(x)))


def _and_parameters(x, parameters):
    return x if parameters is None else (*x, parameters)


class Model:
    """A robot whose quantities are differentiable functions of tensors.

    Parameters
    ----------
    model : mozzi.Model
        The robot, with its own gravity (`mozzi.Model.with_gravity`), its base at rest and no applied wrenches.
    """

    def __init__(self, model: _mozzi.Model) -> None:
        self.model = model
        self._contents = hashlib.blake2b(pickle.dumps(model), digest_size=12).hexdigest()
        MODELS[self._contents] = model

    def __reduce__(self):
        return Model, (self.model,)

    def __repr__(self) -> str:
        return f"mozzi.torch.Model({self.model!r})"

    def inverse_dynamics(
        self, theta: Tensor, dtheta: Tensor, ddtheta: Tensor, *, parameters: Tensor | None = None
    ) -> Tensor:
        """Compute τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + f(θ, θ̇).

        Parameters
        ----------
        theta : Tensor, shape (..., nq)
            Positions: rad or m.
        dtheta : Tensor, shape (..., n)
            Velocities: rad/s or m/s.
        ddtheta : Tensor, shape (..., n)
            Accelerations: rad/s² or m/s².
        parameters : Tensor, shape (..., p), optional
            Inertial parameters π. Default: the model's.

        Returns
        -------
        Tensor, shape (..., n)
            N m or N.
        """
        return _call(self, "inverse_dynamics", _and_parameters((theta, dtheta, ddtheta), parameters))

    def forward_dynamics(
        self, theta: Tensor, dtheta: Tensor, tau: Tensor, *, parameters: Tensor | None = None
    ) -> Tensor:
        """Compute θ̈ = M⁻¹(τ − c − g − f).

        Parameters
        ----------
        theta : Tensor, shape (..., nq)
            Positions: rad or m.
        dtheta : Tensor, shape (..., n)
            Velocities: rad/s or m/s.
        tau : Tensor, shape (..., n)
            Torques: N m or N.
        parameters : Tensor, shape (..., p), optional
            Inertial parameters π. Default: the model's.

        Returns
        -------
        Tensor, shape (..., n)
            rad/s² or m/s².
        """
        return _call(self, "forward_dynamics", _and_parameters((theta, dtheta, tau), parameters))

    def mass_matrix(self, theta: Tensor, *, parameters: Tensor | None = None) -> Tensor:
        """Compute the mass matrix M(θ).

        Parameters
        ----------
        theta : Tensor, shape (..., nq)
            Positions: rad or m.
        parameters : Tensor, shape (..., p), optional
            Inertial parameters π. Default: the model's.

        Returns
        -------
        Tensor, shape (..., n, n)
        """
        return _call(self, "mass_matrix", _and_parameters((theta,), parameters))

    def forward_kinematics(self, theta: Tensor, frame: str | None = None) -> Tensor:
        """Compute the pose T of a frame in {s}.

        Parameters
        ----------
        theta : Tensor, shape (..., nq)
            Positions: rad or m.
        frame : str, optional
            A link or frame. Default: the end effector.

        Returns
        -------
        Tensor, shape (..., 4, 4)
        """
        return _call(self, "forward_kinematics", (theta,), frame)

    def body_jacobian(self, theta: Tensor, frame: str | None = None) -> Tensor:
        """Compute the body Jacobian J_b of a frame, angular rows first.

        Parameters
        ----------
        theta : Tensor, shape (..., nq)
            Positions: rad or m.
        frame : str, optional
            A link or frame. Default: the end effector.

        Returns
        -------
        Tensor, shape (..., 6, n)
        """
        return _call(self, "body_jacobian", (theta,), frame)

    def space_jacobian(self, theta: Tensor, frame: str | None = None) -> Tensor:
        """Compute the space Jacobian J_s of a frame, angular rows first.

        Parameters
        ----------
        theta : Tensor, shape (..., nq)
            Positions: rad or m.
        frame : str, optional
            A link or frame. Default: the end effector.

        Returns
        -------
        Tensor, shape (..., 6, n)
        """
        return _call(self, "space_jacobian", (theta,), frame)

    def rollout(
        self,
        theta: Tensor,
        dtheta: Tensor,
        tau: Tensor,
        step: float,
        method: str = "rk4",
        *,
        parameters: Tensor | None = None,
        by_steps: bool = False,
    ) -> tuple[Tensor, Tensor]:
        """Compute the states of N steps under torques that are constant over each step.

        Parameters
        ----------
        theta, dtheta : Tensor, shapes (..., nq) and (..., n)
            The start.
        tau : Tensor, shape (..., N, n)
            The torques of each step: N m or N.
        step : float
            The length of a step, s.
        method : {'rk4', 'semi-implicit-euler', 'euler'}
            Integration method, as in `mozzi.Model.rollout`.
        parameters : Tensor, shape (..., p), optional
            Inertial parameters π; they imply `by_steps`. Default: the model's.
        by_steps : bool
            True to make each step an operation of torch: slower, but required for forward mode and second derivatives.

        Returns
        -------
        theta, dtheta : Tensor, shapes (..., N + 1, nq) and (..., N + 1, n)
            The start and the state after each step.
        """
        if parameters is None and not by_steps and not getattr(theta, "is_cuda", False):
            return rollout(self.model, self._contents, float(step), method, theta, dtheta, tau)

        def dynamics(theta: Tensor, dtheta: Tensor, tau: Tensor) -> Tensor:
            return self.forward_dynamics(theta, dtheta, tau, parameters=parameters)

        check_rows(self.model, tau)
        _tangent.require_tree(self.model.constraints)
        return steps(self.model._quaternions, dynamics, float(step), method, theta, dtheta, tau)
