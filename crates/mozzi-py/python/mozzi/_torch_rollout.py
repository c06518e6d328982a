"""Rollouts in PyTorch: `Model.rollout` with its vector-Jacobian product, and the same steps in tensors.

The product is of first order and for the model's own parameters. The steps in tensors (`steps`) are slower, and
differentiable by parameters, in forward mode, and twice.
"""

# mypy: ignore-errors
# pyright: reportMissingImports=false, reportFunctionMemberAccess=false, reportCallIssue=false
# pyright: reportIncompatibleMethodOverride=false, reportReturnType=false, reportAssignmentType=false

import torch
from torch import Tensor

from . import _tangent
from ._torch_tensors import arrays, batched, check, check_lengths, model_of


def check_rows(model, tau):
    if tau.ndim < 2:
        raise ValueError(f"tau has shape {tuple(tau.shape)}, expected (..., N, {model.n}): a row for each step")


def run(model, step, method, theta, dtheta, tau):
    """θ (..., N + 1, nq) and θ̇ (..., N + 1, n)."""
    found = model.rollout(*arrays((theta, dtheta, tau)), step, method)
    return tuple(torch.from_numpy(table).to(theta.dtype) for table in found)


def pull_back(model, step, method, theta, dtheta, tau, table, theta_bar, dtheta_bar):
    """Gradients by θ, θ̇ and τ. The first row of the table is θ itself; later rows depend on q/‖q‖."""
    quaternions, theta_bar = model._quaternions, torch.cat(
        [torch.zeros_like(theta_bar[..., :1, :]), theta_bar[..., 1:, :]], -2
    )
    along = _tangent.velocity_gradient(torch, quaternions, table, theta_bar)
    found = model.rollout_vjp(*arrays((theta, dtheta, tau)), step, *arrays((along, dtheta_bar)), method)
    return [torch.from_numpy(gradient).to(theta.dtype) for gradient in found]


def to_theta(model, theta, along, theta_bar):
    return _tangent.position_gradient(torch, model._quaternions, theta, along) + theta_bar[..., 0, :]


class Rollout(torch.autograd.Function):
    @staticmethod
    def forward(model, step, method, theta, dtheta, tau):
        return run(model, step, method, theta, dtheta, tau)

    @staticmethod
    def setup_context(ctx, inputs, output):
        *ctx.options, theta, dtheta, tau = inputs
        ctx.save_for_backward(theta, dtheta, tau, output[0])

    @staticmethod
    def backward(ctx, theta_bar, dtheta_bar):
        theta, *_ = saved = ctx.saved_tensors
        along, *others = RolloutVjp.apply(*ctx.options, *saved, theta_bar, dtheta_bar)
        return (None, None, None, to_theta(ctx.options[0], theta, along, theta_bar), *others)

    @staticmethod
    def jvp(ctx, *rates):
        raise NotImplementedError(
            "forward mode through a rollout: mozzi.torch.Model.rollout(..., by_steps=True) has it"
        )

    @staticmethod
    def vmap(info, in_dims, model, step, method, *tensors):
        return Rollout.apply(model, step, method, *batched(info, in_dims[3:], tensors)), (0, 0)


class RolloutVjp(torch.autograd.Function):
    @staticmethod
    def forward(model, step, method, *tensors):
        return tuple(pull_back(model, step, method, *tensors))

    @staticmethod
    def setup_context(ctx, inputs, output):
        pass

    @staticmethod
    def backward(ctx, *gradients):
        raise NotImplementedError(
            "second derivatives of a rollout: mozzi.torch.Model.rollout(..., by_steps=True) has them"
        )

    @staticmethod
    def vmap(info, in_dims, model, step, method, *tensors):
        return RolloutVjp.apply(model, step, method, *batched(info, in_dims[3:], tensors)), (0, 0, 0)


# for graphs


@torch.library.custom_op("mozzi::rollout", mutates_args=(), device_types="cpu")
def rollout_op(
    theta: Tensor, dtheta: Tensor, tau: Tensor, step: float, method: str, contents: str
) -> tuple[Tensor, Tensor]:
    return run(model_of(contents), step, method, theta, dtheta, tau)


@rollout_op.register_fake
def _(theta, dtheta, tau, step, method, contents):
    model = model_of(contents)
    check_lengths(("theta", "dtheta", "tau"), (theta, dtheta, tau), (model.nq, model.n, model.n))
    rows = (*theta.shape[:-1], tau.shape[-2] + 1)
    return theta.new_empty(*rows, model.nq), theta.new_empty(*rows, model.n)


@torch.library.custom_op("mozzi::rollout_vjp", mutates_args=(), device_types="cpu")
def rollout_vjp_op(
    theta: Tensor,
    dtheta: Tensor,
    tau: Tensor,
    table: Tensor,
    theta_bar: Tensor,
    dtheta_bar: Tensor,
    step: float,
    method: str,
    contents: str,
) -> tuple[Tensor, Tensor, Tensor]:
    return tuple(pull_back(model_of(contents), step, method, theta, dtheta, tau, table, theta_bar, dtheta_bar))


@rollout_vjp_op.register_fake
def _(theta, dtheta, tau, table, theta_bar, dtheta_bar, step, method, contents):
    return (
        torch.empty_like(dtheta).contiguous(),
        torch.empty_like(dtheta).contiguous(),
        torch.empty_like(tau).contiguous(),
    )


def _save(ctx, inputs, output):
    theta, dtheta, tau, *ctx.options = inputs
    ctx.save_for_backward(theta, dtheta, tau, output[0])


def _pull_back(ctx, theta_bar, dtheta_bar):
    theta, *_ = saved = ctx.saved_tensors
    along, *others = rollout_vjp_op(*saved, theta_bar, dtheta_bar, *ctx.options)
    return (to_theta(model_of(ctx.options[-1]), theta, along, theta_bar), *others, None, None, None)


rollout_op.register_autograd(_pull_back, setup_context=_save)


def rollout(model, contents, step, method, theta, dtheta, tau):
    """By `Model.rollout`, with leading axes broadcast by torch."""
    if not torch.compiler.is_compiling():
        check(("theta", "dtheta", "tau"), (theta, dtheta, tau))
    check_rows(model, tau)
    leading = torch.broadcast_shapes(theta.shape[:-1], dtheta.shape[:-1], tau.shape[:-2])
    theta, dtheta = (t.expand(*leading, t.shape[-1]) for t in (theta, dtheta))
    tau = tau.expand(*leading, *tau.shape[-2:])
    if torch.compiler.is_compiling():
        return rollout_op(theta, dtheta, tau, step, method, contents)
    return Rollout.apply(model, step, method, theta, dtheta, tau)


# the same steps in tensors


def steps(quaternions, dynamics, step, method, theta, dtheta, tau):
    """The table of a rollout by torch's operations, with θ̈ = dynamics(θ, θ̇, τ)."""
    leading = torch.broadcast_shapes(theta.shape[:-1], dtheta.shape[:-1], tau.shape[:-2])
    states = [tuple(t.expand(*leading, t.shape[-1]) for t in (theta, dtheta))]
    for k in range(tau.shape[-2]):
        theta, dtheta, force = *states[-1], tau[..., k, :]
        if method == "rk4":
            w, a, sums = dtheta, dynamics(theta, dtheta, force), None
            for c, weight in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (None, 1.0)]:
                sums = (weight * w, weight * a) if sums is None else (sums[0] + weight * w, sums[1] + weight * a)
                if c is not None:
                    u, V = c * step * w, dtheta + c * step * a
                    w = _tangent.logarithm_rate(torch, quaternions, u, V)
                    a = dynamics(_tangent.advance(torch, quaternions, theta, u), V, force)
            end = _tangent.advance(torch, quaternions, theta, step / 6 * sums[0]), dtheta + step / 6 * sums[1]
        elif method in ("euler", "semi-implicit-euler"):
            faster = dtheta + step * dynamics(theta, dtheta, force)
            moved = step * (dtheta if method == "euler" else faster)
            end = _tangent.advance(torch, quaternions, theta, moved), faster
        else:
            raise ValueError(f"method is {method!r}, expected 'rk4', 'semi-implicit-euler' or 'euler'")
        states.append(end)
    return tuple(torch.stack(rows, -2) for rows in zip(*states))
