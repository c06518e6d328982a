"""Quantities as custom operators of PyTorch, for graphs of `torch.compile` and `torch.export`: value and pullback.

An operator has the key of a quantity, `model:quantity:frame`, and looks it up. Second derivatives are not in graphs.
"""

# mypy: ignore-errors
# pyright: reportMissingImports=false, reportFunctionMemberAccess=false, reportCallIssue=false

import functools
import math

import torch
from torch import Tensor
from torch.autograd import forward_ad

from . import _pullbacks, _tangent
from ._torch_tensors import arrays, check_lengths, model_of, tensors


@functools.cache
def known(key):
    """The quantity of this key: `model:quantity:frame`."""
    contents, name, frame = key.split(":", 2)
    quantity = _pullbacks.QUANTITIES[name](model_of(contents), frame or None)
    quantity.key = key
    return quantity


def to_positions(quantity, theta, gradient):
    return (
        _tangent.position_gradient(torch, quantity.quaternions, theta, gradient) if quantity.quaternions else gradient
    )


def run(quantity, method, count, of_parameters, arrays):
    """A derivative on NumPy's arrays, which are w, but for `jvp`, then `count` inputs x, then u."""
    if method == "jvp":
        return [quantity.jvp(arrays[:count], arrays[count:])]
    w, x, u = arrays[0], arrays[1 : count + 1], arrays[count + 1 :]
    if method == "vjp":
        return quantity.vjp(x, w, of_parameters)
    return getattr(quantity, method)(x, w, u, of_parameters)


def refuse_forward_mode(x):
    """A custom operator would drop tangents in silence."""
    if forward_ad._current_level >= 0:
        for t in x:
            if forward_ad.unpack_dual(t, level=0).tangent is not None:
                raise NotImplementedError(
                    f"forward mode on {t.device}: derivatives there are of first order, in reverse mode"
                    if t.is_cuda
                    else "forward mode in torch.compile: call torch.func.jvp outside, or without compile"
                )


@torch.library.custom_op("mozzi::value", mutates_args=(), device_types="cpu")
def value_op(x: list[Tensor], key: str) -> Tensor:
    refuse_forward_mode(x)
    return torch.from_numpy(known(key).value(arrays(x)))


@value_op.register_fake
def _(x, key):
    refuse_forward_mode(x)
    quantity = known(key)
    check_lengths((*quantity.inputs, "parameters"), x, quantity.lengths())
    return x[0].new_empty(*x[0].shape[:-1], *quantity.shape)


@torch.library.custom_op("mozzi::vjp", mutates_args=(), device_types="cpu")
def vjp_op(x: list[Tensor], w: Tensor, key: str, of_parameters: bool) -> list[Tensor]:
    return list(tensors(known(key).vjp(arrays(x), *arrays([w]), of_parameters)))


@vjp_op.register_fake
def _(x, w, key, of_parameters):
    quantity = known(key)
    return [x[0].new_empty(*x[0].shape[:-1], length) for length in quantity.gradients(of_parameters)]


def _save(ctx, inputs, output):
    x, ctx.key = inputs
    ctx.save_for_backward(*x)


def _pull_back(ctx, w):
    x, quantity = ctx.saved_tensors, known(ctx.key)
    first, *others = vjp_op(list(x), w, ctx.key, len(x) > len(quantity.inputs))
    return [to_positions(quantity, x[0], first), *others], None


value_op.register_autograd(_pull_back, setup_context=_save)


@torch.library.custom_op("mozzi::packed", mutates_args=(), device_types="cpu")
def packed_op(packed: Tensor, key: str, method: str, count: int, of_parameters: bool) -> Tensor:
    quantity, leading = known(key), packed.shape[:-1]
    shapes = [] if method == "jvp" else [quantity.shape]
    shapes += [(n,) for n in quantity.lengths()[:count]]
    left = packed.shape[-1] - sum(map(math.prod, shapes))
    shapes += [(n,) for n in quantity.gradients(left > quantity.n * len(quantity.inputs))] if left else []
    parts = packed.detach().split([math.prod(shape) for shape in shapes], dim=-1)
    arrays = [part.reshape(*leading, *shape).numpy() for part, shape in zip(parts, shapes)]
    found = tensors(run(quantity, method, count, of_parameters, arrays))
    return torch.cat([t.reshape(*leading, -1) for t in found], dim=-1)
