"""Rollouts in PyTorch: `Model.rollout` with its vector-Jacobian product, and the same steps in tensors.

The product is of first order and for the model's own parameters. The steps in tensors (`steps`) are slower, and
differentiable by parameters, in forward mode, and twice.
"""

# mypy: ignore-errors
# pyright: reportMissingImports=false

import math

import torch
from torch import Tensor

from . import _tangent
from ._torch_tensors import arrays, batched, check, check_lengths, model_of


def run(model, step, method, theta, dtheta, tau):
    """θ (..., N + 1, nq) and θ̇ (..., N + 1, n)."""
    found = model.rollout(*arrays((theta, dtheta, tau)), step, method)
    return tuple(torch.from_numpy(table).to(theta.dtype) for table in found)


def pull_back(model, step, method, theta, dtheta, tau, table, theta_bar, dtheta_bar):
    """Gradients by θ, θ̇ and τ. The first row of the table is θ itself; later rows depend on q/‖q‖."""
    quaternions, theta_bar = model._quaternions, torch.cat([torch.zeros_like(theta_bar[..., :1, :]), theta_bar[..., 1:, :]], -2)
    along = _tangent.to_velocities(torch, quaternions, table, theta_bar, is_gradient=True)
    found = model.rollout_vjp(*arrays((theta, dtheta, tau)), step, *arrays((along, dtheta_bar)), method)
    return [torch.from_numpy(gradient).to(theta.dtype) for gradient in found]


def to_theta(model, theta, along, theta_bar):
    return _tangent.to_positions(torch, model._quaternions, theta, along) + theta_bar[..., 0, :]


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
        raise NotImplementedError("forward mode through a rollout: mozzi.torch.Model.rollout(..., by_steps=True) has it")

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
        raise NotImplementedError("second derivatives of a rollout: mozzi.torch.Model.rollout(..., by_steps=True) has them")

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
    return torch.empty_like(dtheta).contiguous(), torch.empty_like(dtheta).contiguous(), torch.empty_like(tau).contiguous()


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
    if tau.ndim < 2:
        raise ValueError(f"tau has shape {tuple(tau.shape)}, expected (..., N, {model.n}): a row for each step")
    leading = torch.broadcast_shapes(theta.shape[:-1], dtheta.shape[:-1], tau.shape[:-2])
    theta, dtheta = (t.expand(*leading, t.shape[-1]) for t in (theta, dtheta))
    tau = tau.expand(*leading, *tau.shape[-2:])
    if torch.compiler.is_compiling():
        return rollout_op(theta, dtheta, tau, step, method, contents)
    return Rollout.apply(model, step, method, theta, dtheta, tau)


# the same steps in tensors


def _series(square):
    """cos φ, sin φ/φ, (1 − cos φ)/φ² and (φ − sin φ)/φ³ for φ², with derivatives at 0."""
    small = square < 0.25
    near, far = torch.where(small, square, 0.0), torch.where(small, 1.0, square)
    phi = far.sqrt()
    closed = [phi.cos(), phi.sin() / phi, (1 - phi.cos()) / far, (phi - phi.sin()) / (far * phi)]
    found = []
    for first, large in enumerate(closed):
        total = torch.zeros_like(square)
        for k in range(8, -1, -1):  # Σ (−φ²)ᵏ/(2k + first)!
            total = 1 / math.factorial(2 * k + first) - near * total
        found.append(torch.where(small, total, large))
    return found


def _cross(a, b):
    return _tangent.cross(torch, a, b)


def advance(quaternions, theta, u):
    """θ ⊕ u: q e^(ω/2) and p + R V(ω) v for quaternions and positions, else θ + u."""
    parts, last, at = [], 0, 0
    for q, j, is_free in quaternions:
        parts.append(theta[..., last:q] + u[..., at:j])
        w, r, omega = theta[..., q : q + 1], theta[..., q + 1 : q + 4], u[..., j : j + 3]
        c, s, _, _ = _series((omega * omega).sum(-1, keepdim=True) / 4)
        half = 0.5 * s * omega
        moved = torch.cat([w * c - (r * half).sum(-1, keepdim=True), w * half + c * r + _cross(r, half)], -1)
        parts.append(moved / moved.norm(dim=-1, keepdim=True))
        last, at = q + 4, j + 3
        if is_free:
            _, _, b, d = _series((omega * omega).sum(-1, keepdim=True))
            v = u[..., j + 3 : j + 6]
            turned = _cross(omega, v)
            _, r, two = _tangent._parts(theta, q)
            parts.append(theta[..., q + 4 : q + 7] + _tangent._rotated(torch, w, r, two, v + b * turned + d * _cross(omega, turned)))
            last, at = q + 7, j + 6
    return torch.cat([*parts, theta[..., last:] + u[..., at:]], -1)


def rate(quaternions, u, V):
    """u̇ for θ ⊕ u moving with V: V + ½[ad_u]V + ¹⁄₁₂[ad_u]²V for twists (Munthe-Kaas 1999)."""

    def ad(w, v, a, b):
        return _cross(w, a), _cross(v, a) + _cross(w, b)

    parts, at = [], 0
    for _, j, is_free in quaternions:
        end = j + (6 if is_free else 3)
        twist, along = V[..., j:end], u[..., j:end]
        if is_free:
            once = torch.cat(ad(along[..., :3], along[..., 3:], twist[..., :3], twist[..., 3:]), -1)
            twice = torch.cat(ad(along[..., :3], along[..., 3:], once[..., :3], once[..., 3:]), -1)
        else:
            once = _cross(along, twist)
            twice = _cross(along, once)
        parts += [V[..., at:j], twist + 0.5 * once + twice / 12]
        at = end
    return torch.cat([*parts, V[..., at:]], -1)


def steps(quaternions, dynamics, step, method, theta, dtheta, tau):
    """The table of a rollout by torch's operations, with θ̈ = dynamics(θ, θ̇, τ)."""
    states = [(theta, dtheta)]
    for k in range(tau.shape[-2]):
        theta, dtheta, force = *states[-1], tau[..., k, :]
        if method == "rk4":
            w, a, sums = dtheta, dynamics(theta, dtheta, force), None
            for c, weight in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (None, 1.0)]:
                sums = (weight * w, weight * a) if sums is None else (sums[0] + weight * w, sums[1] + weight * a)
                if c is not None:
                    u, V = c * step * w, dtheta + c * step * a
                    w, a = rate(quaternions, u, V), dynamics(advance(quaternions, theta, u), V, force)
            end = advance(quaternions, theta, step / 6 * sums[0]), dtheta + step / 6 * sums[1]
        elif method in ("euler", "semi-implicit-euler"):
            faster = dtheta + step * dynamics(theta, dtheta, force)
            end = advance(quaternions, theta, step * (dtheta if method == "euler" else faster)), faster
        else:
            raise ValueError(f"method is {method!r}, expected 'rk4', 'semi-implicit-euler' or 'euler'")
        states.append(end)
    return tuple(torch.stack(rows, -2) for rows in zip(*states))
