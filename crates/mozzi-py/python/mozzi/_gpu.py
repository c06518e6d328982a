"""A robot's quantities of arrays on an NVIDIA GPU. No mathematics: addresses and shapes are checked and handed on."""

import importlib.util
import math
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from . import _mozzi, _tangent
from ._gpu_arrays import View, empty, framework_of, stream_of, view

__all__ = ["Gpu"]


class Gpu:
    """A robot on a GPU, made by ``Model.to_gpu``; its methods are the model's quantities, on arrays of the GPU.

    Kernels are compiled at the first use, for the arrays' float32 or float64. Results are arrays of the first
    argument's framework (PyTorch, CuPy, Numba), or those given as ``out``. Calls are asynchronous: the kernel runs on
    ``stream`` (an address), by default the framework's current stream. The results of a state with a singular mass
    matrix, or with an angle beyond 8192 rad in float32 or 10⁶ rad in float64, are NaN.

    Parameters
    ----------
    model : Model
        The robot.
    layout : {'rows', 'columns'}
        Layout of the arrays: (..., n), or (n, N).
    device : int
        Number of the device.
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
        """Compute a quantity at many states.

        Parameters
        ----------
        quantity : str
            Name of a method of ``Model``.
        *inputs
            Its arrays, shapes (..., n) by rows or (n, N) by columns.
        frame : str, optional
            Frame of a quantity that refers to one. Default: the end effector.
        packed : bool
            True to get the lower triangle of a symmetric matrix, by rows.
        out : array or sequence of arrays, optional
            Arrays in which the results are written.
        stream : int, optional
            Address of a CUDA stream. Default: the framework's current stream.

        Returns
        -------
        array, or tuple of arrays
            In the first input's framework.
        """
        if not inputs:
            raise TypeError(f"{quantity} takes one array or more, found none")
        if _wants_gradient(inputs):
            if out is not None or packed:
                raise TypeError(f"{quantity} with gradients takes neither out nor packed")
            return _differentiable(self, quantity, inputs, frame, stream)
        views = [_read(x, f"argument {k}") for k, x in enumerate(inputs, 1)]
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
        results, places = self._results(inputs[0], out, [name for name, _ in kernel.outputs], shapes, dtype)
        chosen = stream_of(inputs[0], views) if stream is None else stream
        kernel.launch([x.address for x in views], places, math.prod(leading), chosen)
        return results[0] if len(results) == 1 else results

    def rollout(
        self,
        theta: Any,
        dtheta: Any,
        tau: Any = None,
        *,
        step: float,
        steps: int | None = None,
        every: int = 1,
        gains: Any = None,
        target: Any = None,
        out: Any = None,
        stream: int | None = None,
    ) -> tuple[Any, Any]:
        """Compute the states of many robots by Runge-Kutta steps in one kernel, a thread for each robot.

        Torques are constant over each step: those of ``tau``, plus G(θ_d ⊖ θ, θ̇_d − θ̇) with ``gains`` G and
        ``target`` (θ_d, θ̇_d), at the state at the beginning of the step. Quaternions move on their group, as in
        `Model.rollout`; θ_d ⊖ θ is `Model.difference`. Joint limits are ignored.

        Parameters
        ----------
        theta, dtheta : arrays, shapes (..., nq) and (..., n), by columns (nq, N) and (n, N)
            The start.
        tau : array, shape (..., K, n), by columns (K, n, N), optional
            The torques of K steps. Default: zeros.
        step : float
            The length of a step, s.
        steps : int, optional
            K, if ``tau`` is not given.
        every : int
            Number of steps between two rows of the result, a divisor of K.
        gains, target : arrays, shapes (n, 2n) and (..., nq + n), by columns (nq + n, N), optional
            Feedback; the gains are shared by all robots.
        out : two arrays, optional
            Arrays in which the results are written.
        stream : int, optional
            Address of a CUDA stream. Default: the framework's current stream.

        Returns
        -------
        theta, dtheta : arrays, shapes (..., K/every, nq) and (..., K/every, n), by columns (K/every, nq, N) and
            (K/every, n, N)

        Raises
        ------
        ValueError
            If the robot has constraints, or shapes do not match.
        """
        if (gains is None) != (target is None):
            raise TypeError("gains and target belong together: one is missing")
        if _wants_gradient((theta, dtheta, tau, gains, target)):
            raise TypeError("a rollout in one kernel has no gradient: see mozzi.torch.Model.rollout, or detach")
        n, nq = self.model.n, self.model.nq
        views = [_read(theta, "theta"), _read(dtheta, "dtheta")]
        dtype, leading = views[0].dtype, self._leading(views[0].shape, "theta", nq)
        self._check(views[1], "dtheta", self._shape(leading, (n,)), dtype)
        torques, steps = self._torques(tau, steps, leading, dtype)
        feedback = None
        if gains is not None:
            pair = [_read(gains, "gains"), _read(target, "target")]
            self._check(pair[0], "gains", (n, 2 * n), dtype)
            self._check(pair[1], "target", self._shape(leading, (nq + n,)), dtype)
            feedback = [x.address for x in pair]
        if steps < 1 or every < 1 or steps % every:
            raise ValueError(f"every is {every}, expected a divisor of the number of steps, {steps}")
        shapes = [self._shape(leading, (steps // every, length)) for length in (nq, n)]
        results, tables = self._results(theta, out, ["theta", "dtheta"], shapes, dtype)
        if ("rollout", dtype) not in self._kernels:
            made = _mozzi.GpuRollout(self.model, dtype, self.layout, self.device, packages())
            self._kernels["rollout", dtype] = made
        self._kernels["rollout", dtype].launch(
            [x.address for x in views],
            None if torques is None else torques.address,
            feedback,
            tables,
            step,
            steps,
            every,
            math.prod(leading),
            stream_of(theta, views) if stream is None else stream,
        )
        return results[0], results[1]

    def _results(
        self, like: Any, out: Any, names: list[str], shapes: list[tuple[int, ...]], dtype: str
    ) -> tuple[tuple[Any, ...], list[int]]:
        """The arrays for the results, those of ``out`` or new ones, and their addresses."""
        if out is None:
            results = tuple(empty(like, shape, dtype) for shape in shapes)
        else:
            results = tuple(out) if isinstance(out, (tuple, list)) else (out,)
            if len(results) != len(shapes):
                raise TypeError(f"out has {len(results)} arrays, expected {len(shapes)}")
        places = [view(x, "out") for x in results]
        for x, name, shape in zip(places, names, shapes):
            self._check(x, f"out ({name})", shape, dtype)
        return results, [x.address for x in places]

    def _torques(
        self, tau: Any, steps: int | None, leading: tuple[int, ...], dtype: str
    ) -> tuple[View | None, int]:
        if tau is None:
            if steps is None:
                raise TypeError("rollout takes tau or steps, found neither")
            return None, steps
        torques = _read(tau, "tau")
        if len(torques.shape) != len(leading) + 2:
            expected = f"(..., K, {self.model.n})" if self.layout == "rows" else f"(K, {self.model.n}, N)"
            raise ValueError(f"tau has shape {torques.shape}, expected {expected}")
        found = torques.shape[-2 if self.layout == "rows" else 0]
        if steps not in (None, found):
            raise ValueError(f"steps is {steps}, but tau has shape {torques.shape}, the torques of {found} steps")
        self._check(torques, "tau", self._shape(leading, (found, self.model.n)), dtype)
        return torques, found

    def _kernel(self, quantity: str, frame: str | None, dtype: str, packed: bool) -> Any:
        key = quantity, frame, dtype, packed
        if key not in self._kernels:
            options = (dtype, self.layout, packed, self.device, packages())
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


def packages() -> list[str]:
    """The folders in which NVIDIA's packages are, such as site-packages."""
    found = importlib.util.find_spec("nvidia")
    return [] if found is None else [str(Path(place).parent) for place in found.submodule_search_locations or ()]


def _read(x: Any, name: str) -> View:
    """Address and shape of an argument; PyTorch refuses the address of a tensor that requires a gradient."""
    return view(x.detach() if framework_of(x) == "torch" else x, name)


def _wants_gradient(inputs: tuple[Any, ...]) -> bool:
    if framework_of(inputs[0]) != "torch":
        return False
    is_enabled = bool(import_module("torch").is_grad_enabled())
    return is_enabled and any(getattr(x, "requires_grad", False) for x in inputs)


def gradient_of(quantity: str) -> str:
    """The name of its vector-Jacobian product."""
    product = f"{quantity}_vjp"
    if not hasattr(_mozzi.Model, product):
        raise TypeError(f"{quantity} has no gradient on a GPU: there is no {product}; detach its arguments")
    return product


def _differentiable(gpu: Gpu, quantity: str, inputs: tuple[Any, ...], frame: str | None, stream: int | None) -> Any:
    """Compute a quantity under PyTorch's autograd, with the kernel of its vector-Jacobian product as gradient."""
    autograd = import_module("torch").autograd
    base: Any = autograd.Function
    product, quaternions = gradient_of(quantity), gpu.model._quaternions

    class Function(base):  # type: ignore[misc]
        @staticmethod
        def forward(ctx: Any, *x: Any) -> Any:
            ctx.save_for_backward(*x)
            return gpu.compute(quantity, *x, frame=frame, stream=stream)

        @staticmethod
        @autograd.function.once_differentiable  # type: ignore[untyped-decorator]
        def backward(ctx: Any, w: Any) -> Any:
            saved = ctx.saved_tensors
            found = gpu.compute(product, *saved, w.contiguous(), frame=frame, stream=stream)
            if not quaternions:
                return found
            torch = import_module("torch")
            first, *others = found if isinstance(found, tuple) else (found,)
            theta, first = (t if gpu.layout == "rows" else t.T for t in (saved[0], first))
            first = _tangent.position_gradient(torch, quaternions, theta, first)
            return (first if gpu.layout == "rows" else first.T, *others)

    return Function.apply(*inputs)
