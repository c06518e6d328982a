"""Shared functions of mozzi.torch: tensors as NumPy's arrays, checks, and the models that graphs name."""

# mypy: ignore-errors
# pyright: reportMissingImports=false

import torch
from torch import Tensor

MODELS = {}
"""The models by a hash of their contents: an operator in a graph has this hash, the same in every process."""
DTYPES = (torch.float64, torch.float32)


def model_of(contents):
    if contents not in MODELS:
        raise KeyError("the graph's robot is not known in this process: make its mozzi.torch.Model first")
    return MODELS[contents]


def arrays(tensors):
    return [t.numpy(force=True) for t in tensors]


def tensors(arrays):
    return tuple(map(torch.from_numpy, arrays))


def check(names, x):
    """One dtype, on the CPU or on one GPU; the package checks shapes."""
    dtype = getattr(x[0], "dtype", None)
    for name, t in zip(names, x):
        if not isinstance(t, Tensor) or t.dtype not in DTYPES:
            found = t.dtype if isinstance(t, Tensor) else f"a {type(t).__name__}"
            raise TypeError(f"{name} is {found}, expected a tensor of torch.float64 or torch.float32")
        if t.dtype is not dtype:
            raise TypeError(f"{name} is {t.dtype}, but {names[0]} is {dtype}: expected one dtype")
        if t.device != x[0].device:
            raise ValueError(f"{name} is on {t.device}, but {names[0]} is on {x[0].device}: expected one device")
        if not (t.is_cpu or t.is_cuda):
            raise ValueError(f"{name} is on {t.device}, expected cpu or cuda")


def check_lengths(names, x, lengths):
    """Check the lengths of fake tensors, which the package never sees."""
    for name, t, length in zip(names, x, lengths):
        if t.dim() == 0 or t.shape[-1] != length:
            raise ValueError(f"{name} has shape {tuple(t.shape)}, expected (..., {length})")


def batched(info, in_dims, tensors):
    """The batch axis first, for every tensor."""
    size = info.batch_size
    return [t.expand(size, *t.shape) if d is None else t.movedim(d, 0) for t, d in zip(tensors, in_dims)]
