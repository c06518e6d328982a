"""A robot's quantities of arrays on an NVIDIA GPU. No mathematics: addresses and shapes are checked and handed on.

An array is any object with ``__cuda_array_interface__`` (CuPy, Numba, PyTorch's CUDA tensors) or ``__dlpack__``.
"""

import ctypes
import importlib.util
import math
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from . import _mozzi

__all__ = ["Gpu"]

DTYPES = {"<f4": "float32", "<f8": "float64"}


class View(NamedTuple):
    """Where an array is."""

    address: int
    shape: tuple[int, ...]
    dtype: str
    stream: int | None


class Gpu:
    """A robot on a GPU, made by ``Model.to_gpu``. Its methods are the model's quantities, of arrays on the GPU.

    Kernels are compiled at the first use, for float32 or float64 as the arrays are. Results are arrays of the first
    argument's framework (PyTorch, CuPy, Numba), or those given as ``out``. Nothing waits for the GPU: the kernel runs on
    ``stream`` (an address), by default the framework's current stream. A state whose mass matrix is singular, or with
    an angle beyond 8192 rad in float32 or 10⁶ in float64, gives NaN.
    """

    def __init__(self, model: "_mozzi.Model", layout: str = "rows", device: int = 0) -> None:
        self.model = model
        self.layout = layout
        self.device = device
        self._kernels: dict[tuple[Any, ...], Any] = {}

    def __repr__(self) -> str:
        return f"<mozzi.Gpu of {self.model!r}, layout {self.layout!r}, device {self.device}>"

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name.startswith("_") or not hasattr(_mozzi.Model, name):
            raise AttributeError(f"{name!r} is no quantity of mozzi.Model")
        return partial(self.compute, name)

    def compute(
        self,
        quantity: str,
        *inputs: Any,
        frame: str | None = None,
        packed: bool = False,
        out: Any = None,
        stream: int | None = None,
    ) -> Any:
        """The quantity's results: one array, or a tuple of arrays."""
        if not inputs:
            raise TypeError(f"{quantity} takes one array or more, found none")
        if _wants_gradient(inputs):
            if out is not None or packed:
                raise TypeError(f"{quantity} with gradients takes neither out nor packed")
            return _differentiable(self, quantity, inputs, frame, stream)
        views = [view(x, f"argument {k}") for k, x in enumerate(inputs, 1)]
        dtype = views[0].dtype
        kernel = self._kernel(quantity, frame, dtype, packed)
        names = kernel.inputs
        if len(views) != len(names):
            expected = ", ".join(name for name, _ in names)
            raise TypeError(f"{quantity} takes {len(names)} arrays ({expected}), found {len(views)}")
        leading = self._leading(views[0].shape, *names[0])
        for x, (name, length) in zip(views, names):
            self._check(x, name, self._shape(leading, (length,)), dtype)
        shapes = [self._shape(leading, tuple(shape)) for _, shape in kernel.outputs]
        if out is None:
            results = tuple(_empty(inputs[0], shape, dtype) for shape in shapes)
        else:
            results = tuple(out) if isinstance(out, (tuple, list)) else (out,)
            if len(results) != len(shapes):
                raise TypeError(f"out has {len(results)} arrays, expected {len(shapes)}")
        places = [view(x, "out") for x in results]
        for x, (name, _), shape in zip(places, kernel.outputs, shapes):
            self._check(x, f"out ({name})", shape, dtype)
        chosen = _stream(inputs[0], views) if stream is None else stream
        kernel.launch([x.address for x in views], [x.address for x in places], math.prod(leading), chosen)
        return results[0] if len(results) == 1 else results

    def _kernel(self, quantity: str, frame: str | None, dtype: str, packed: bool) -> Any:
        key = quantity, frame, dtype, packed
        if key not in self._kernels:
            options = (dtype, self.layout, packed, self.device, _packages())
            self._kernels[key] = _mozzi.GpuKernel(self.model, quantity, frame, *options)
        return self._kernels[key]

    def _leading(self, shape: tuple[int, ...], name: str, length: int) -> tuple[int, ...]:
        at = -1 if self.layout == "rows" else 0
        if not shape or shape[at] != length or (self.layout == "columns" and len(shape) != 2):
            expected = f"(..., {length})" if self.layout == "rows" else f"({length}, N)"
            raise ValueError(f"{name} has shape {shape}, expected {expected}")
        return shape[:-1] if self.layout == "rows" else shape[1:]

    def _shape(self, leading: tuple[int, ...], of_state: tuple[int, ...]) -> tuple[int, ...]:
        return (*leading, *of_state) if self.layout == "rows" else (*of_state, *leading)

    def _check(self, x: View, name: str, shape: tuple[int, ...], dtype: str) -> None:
        if x.dtype != dtype:
            raise TypeError(f"{name} is {x.dtype}, the first array is {dtype}: expected one dtype")
        if x.shape != shape:
            raise ValueError(f"{name} has shape {x.shape}, expected {shape}")


def _packages() -> list[str]:
    """The folders in which NVIDIA's packages are, such as site-packages."""
    found = importlib.util.find_spec("nvidia")
    return [] if found is None else [str(Path(place).parent) for place in found.submodule_search_locations or ()]


def view(x: Any, name: str) -> View:
    """The address, shape and dtype of an array on a GPU, which must be contiguous by rows."""
    interface = getattr(x, "__cuda_array_interface__", None)
    if interface is None:
        if hasattr(x, "__dlpack__") and hasattr(x, "__dlpack_device__"):
            return _of_dlpack(x, name)
        found = f"a {type(x).__name__}"
        raise TypeError(f"{name} is {found}, expected an array on a GPU (__cuda_array_interface__ or __dlpack__)")
    shape, strides = tuple(interface["shape"]), interface.get("strides")
    dtype = _dtype(interface["typestr"], name)
    size = 4 if dtype == "float32" else 8
    _check_strides(shape, None if strides is None else [s // size for s in strides], name)
    return View(interface["data"][0], shape, dtype, interface.get("stream"))


def _dtype(typestr: str, name: str) -> str:
    if typestr not in DTYPES:
        raise TypeError(f"{name} has numbers of type {typestr!r}, expected float32 or float64")
    return DTYPES[typestr]


def _check_strides(shape: tuple[int, ...], strides: Any, name: str) -> None:
    """Strides in numbers, for axes longer than one."""
    expected = 1
    for length, stride in zip(reversed(shape), reversed(strides or ())):
        if length > 1 and stride != expected:
            raise ValueError(f"{name} is not contiguous: strides {tuple(strides)}, shape {shape}; make a copy")
        expected *= length


class _Tensor(ctypes.Structure):
    """DLPack's DLTensor, as it is in a DLManagedTensor."""

    _fields_ = [
        ("data", ctypes.c_void_p),
        ("device_type", ctypes.c_int32),
        ("device_id", ctypes.c_int32),
        ("ndim", ctypes.c_int32),
        ("code", ctypes.c_uint8),
        ("bits", ctypes.c_uint8),
        ("lanes", ctypes.c_uint16),
        ("shape", ctypes.POINTER(ctypes.c_int64)),
        ("strides", ctypes.POINTER(ctypes.c_int64)),
        ("byte_offset", ctypes.c_uint64),
    ]


def _of_dlpack(x: Any, name: str) -> View:
    """Reads a capsule without taking it: the array stays the owner, and the capsule frees its own part."""
    if int(x.__dlpack_device__()[0]) != 2:
        raise ValueError(f"{name} is on DLPack's device {tuple(x.__dlpack_device__())}, expected a CUDA device (2, …)")
    capsule = x.__dlpack__()
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    tensor = _Tensor.from_address(pointer(capsule, b"dltensor"))
    shape = tuple(tensor.shape[k] for k in range(tensor.ndim))
    strides = [tensor.strides[k] for k in range(tensor.ndim)] if tensor.strides else None
    kind = {2: "f"}.get(tensor.code, "?") if tensor.lanes == 1 else "?"
    dtype = _dtype(f"<{kind}{tensor.bits // 8}", name)
    _check_strides(shape, strides, name)
    return View((tensor.data or 0) + tensor.byte_offset, shape, dtype, None)


def _framework(x: Any) -> str:
    return type(x).__module__.split(".")[0]


def _empty(x: Any, shape: tuple[int, ...], dtype: str) -> Any:
    """An array of x's framework."""
    framework = _framework(x)
    if framework == "torch":
        return x.new_empty(shape)
    if framework == "cupy":
        return import_module("cupy").empty(shape, dtype)
    if framework == "numba":
        return import_module("numba.cuda").device_array(shape, dtype)
    raise TypeError(f"results of a {type(x).__name__} need out=: arrays are made for PyTorch, CuPy and Numba")


def _stream(x: Any, views: list[View]) -> int:
    """The framework's current stream; else that of the arrays' interface; else the legacy default stream."""
    framework = _framework(x)
    if framework == "torch":
        return int(import_module("torch").cuda.current_stream(x.device).cuda_stream)
    if framework == "cupy":
        return int(import_module("cupy").cuda.get_current_stream().ptr)
    return next((int(v.stream) for v in views if v.stream is not None), 0)


def _wants_gradient(inputs: tuple[Any, ...]) -> bool:
    if _framework(inputs[0]) != "torch":
        return False
    is_enabled = bool(import_module("torch").is_grad_enabled())
    return is_enabled and any(getattr(x, "requires_grad", False) for x in inputs)


def _differentiable(gpu: Gpu, quantity: str, inputs: tuple[Any, ...], frame: str | None, stream: int | None) -> Any:
    """By PyTorch's autograd: the gradient is the quantity's vector-Jacobian product, a kernel, too."""
    autograd = import_module("torch").autograd
    base: Any = autograd.Function
    product = f"{quantity}_vjp"
    if not hasattr(_mozzi.Model, product):
        raise TypeError(f"{quantity} has no gradient on a GPU: there is no {product}; detach its arguments")
    if gpu.model.nq != gpu.model.n:
        raise TypeError("gradients on a GPU are for robots without quaternions; detach the arguments")

    class Function(base):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, *x: Any) -> Any:
            ctx.save_for_backward(*x)
            return gpu.compute(quantity, *(t.detach() for t in x), frame=frame, stream=stream)

        @staticmethod
        @autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, w: Any) -> Any:
            saved = (t.detach() for t in ctx.saved_tensors)
            return gpu.compute(product, *saved, w.contiguous().detach(), frame=frame, stream=stream)

    return Function.apply(*inputs)
