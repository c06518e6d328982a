"""`mozzi.torch` on CUDA tensors: the operators of `_torch_operators` by the kernels of `Model.to_gpu`.

A kernel has the robot's own inertial parameters, and gradients are of first order, in reverse.
"""

# mypy: ignore-errors
# pyright: reportMissingImports=false, reportFunctionMemberAccess=false

import functools

from ._gpu import Gpu, gradient_of
from ._torch_operators import known, value_op, vjp_op
from ._torch_tensors import batched, model_of


@functools.cache
def _gpu(contents, device):
    return Gpu(model_of(contents), device=device)


def _on(x, key):
    contents, name, frame = key.split(":", 2)
    if len(x) > len(known(key).inputs):
        raise ValueError(
            f"parameters are given for {name} on {x[0].device}: a GPU's kernels have the robot's own, "
            "other parameters are for tensors on the CPU"
        )
    return _gpu(contents, x[0].device.index), name, frame or None


@value_op.register_kernel("cuda")
def value(x, key):
    gpu, name, frame = _on(x, key)
    return gpu.compute(name, *(t.contiguous() for t in x), frame=frame)


@vjp_op.register_kernel("cuda")
def pull_back(x, w, key, of_parameters):
    gpu, name, frame = _on(x, key)
    found = gpu.compute(gradient_of(name), *(t.contiguous() for t in (*x, w)), frame=frame)
    return list(found) if isinstance(found, tuple) else [found]


@value_op.register_vmap
def _(info, in_dims, x, key):
    return value_op(batched(info, in_dims[0], x), key), 0


@vjp_op.register_vmap
def _(info, in_dims, x, w, key, of_parameters):
    *x, w = batched(info, [*in_dims[0], in_dims[1]], [*x, w])
    found = vjp_op(x, w, key, of_parameters)
    return found, [0] * len(found)
