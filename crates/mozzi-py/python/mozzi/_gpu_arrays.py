"""Arrays on an NVIDIA GPU: where they are, new ones of the same framework, and its stream.

An array is any object with ``__cuda_array_interface__`` (CuPy, Numba, PyTorch's CUDA tensors) or ``__dlpack__``.
"""

import ctypes
from importlib import import_module
from typing import Any, NamedTuple

DTYPES = {"<f4": "float32", "<f8": "float64"}


class View(NamedTuple):
    """Address, shape and dtype of an array."""

    address: int
    shape: tuple[int, ...]
    dtype: str
    stream: int | None


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


def framework_of(x: Any) -> str:
    return type(x).__module__.split(".")[0]


def empty(x: Any, shape: tuple[int, ...], dtype: str) -> Any:
    """An array of x's framework."""
    framework = framework_of(x)
    if framework == "torch":
        return x.new_empty(shape)
    if framework == "cupy":
        return import_module("cupy").empty(shape, dtype)
    if framework == "numba":
        return import_module("numba.cuda").device_array(shape, dtype)
    raise TypeError(f"results of a {type(x).__name__} need out=: arrays are made for PyTorch, CuPy and Numba")


def stream_of(x: Any, views: list[View]) -> int:
    """The framework's current stream; else that of the arrays' interface; else the legacy default stream."""
    framework = framework_of(x)
    if framework == "torch":
        return int(import_module("torch").cuda.current_stream(x.device).cuda_stream)
    if framework == "cupy":
        return int(import_module("cupy").cuda.get_current_stream().ptr)
    return next((int(v.stream) for v in views if v.stream is not None), 0)
