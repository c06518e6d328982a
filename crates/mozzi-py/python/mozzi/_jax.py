"""The primitive of `mozzi.jax`: a quantity at many states, or a derivative of it.

XLA calls one handler of the package's library, whose attributes choose what is computed of a quantity y = f(x), x its
inputs and, if given, the inertial parameters:

    along    wanted
    ()       0         f(x)
    (U,)     0         ∂f u              linear in u, its transpose is the next
    ()       X         wᵀ∂f              linear in w, its transpose is the one above
    (U, V)   0         ∂²f(u, v)         linear in u and in v
    (U,)     X         wᵀ∂²f u           linear in w and in u

U, V and X are bits, one for each entry of x: those that a direction changes, and those whose gradient is wanted. The
derivative of a row by x has one direction more, and the transpose of a row is another row, because second derivatives
are symmetric. So one rule for derivatives and one for transposes serve forward and reverse mode, in any order up to
two, and no matrix is formed.

All operands have equal leading axes. Directions and gradients are those of the arrays' numbers: all four of a
quaternion, whose length has no effect.
"""

import functools
import importlib
from typing import Any, NamedTuple

try:
    import jax
except ModuleNotFoundError as error:
    if error.name != "jax":
        raise
    raise ImportError("mozzi.jax needs JAX, which is not installed: pip install jax") from error

import jax.extend.core
import jax.interpreters.ad
import jax.interpreters.batching
import jax.interpreters.mlir
import jax.numpy as jnp
import numpy as np

from . import _mozzi, _tangent
from ._gpu import gradient_of, packages

# these parts of JAX have no types
ad: Any = jax.interpreters.ad
mlir: Any = jax.interpreters.mlir
Primitive: Any = jax.extend.core.Primitive
try:
    ffi: Any = importlib.import_module("jax.ffi")
except ImportError:  # jax 0.4
    ffi = importlib.import_module("jax.extend.ffi")

TARGET = "mozzi_quantity"
GPU_TARGET = "mozzi_quantity_gpu"
MOST_DIRECTIONS = 2


MODELS: dict[int, _mozzi.Model] = {}
"""The robots by their numbers."""


class Quantity(NamedTuple):
    """A quantity of a robot; a constant of a compiled program."""

    model: int
    """The robot's number: a hash of its content, the same in every process."""
    name: str
    frame: str
    """Empty if the quantity has none."""
    inputs: tuple[tuple[str, int], ...]
    outputs: tuple[tuple[int, ...], ...]
    parameters: bool
    """True if the inertial parameters are the last input."""
    threads: int
    """0 for all cores."""


@functools.cache
def register() -> None:
    """Registers the handler in XLA, after JAX's backends: a handler that the runtime refuses would take them along."""
    jax.devices()
    ffi.register_ffi_target(TARGET, _mozzi._jax_handler(), platform="cpu")
    ffi.register_ffi_target(GPU_TARGET, _mozzi._jax_gpu_handler(packages()), platform="CUDA")


def quantity(model: _mozzi.Model, name: str, frame: str | None, parameters: bool, threads: int | None) -> Quantity:
    """The quantity of this name, of the robot, which is made known to the handler."""
    register()
    frame, inputs, outputs = model._jax_shapes(name, frame)
    widths = [(argument, shape[0]) for argument, shape in inputs]
    if parameters:
        widths.append(("parameters", len(model.parameters)))
    shapes = tuple(tuple(shape) for _, shape in outputs)
    handle = model._jax_handle()
    MODELS[handle] = model
    return Quantity(handle, name, frame, tuple(widths), shapes, parameters, threads or 0)


def bits(mask: int) -> list[int]:
    return [k for k in range(mask.bit_length()) if mask >> k & 1]


def mask_of(places: Any) -> int:
    return sum(1 << k for k in places)


class Operands(NamedTuple):
    """The operands of the primitive, or their tangents, by their parts."""

    x: list[Any]
    along: list[list[Any]]
    w: list[Any]

    @classmethod
    def split(cls, operands: Any, of: Quantity, along: tuple[int, ...]) -> "Operands":
        rest = list(operands)
        cut = [len(of.inputs), *(len(bits(mask)) for mask in along)]
        parts = []
        for length in cut:
            parts.append(rest[:length])
            rest = rest[length:]
        return cls(parts[0], parts[1:], rest)

    def flat(self) -> list[Any]:
        return [*self.x, *(u for direction in self.along for u in direction), *self.w]


quantity_p = Primitive("mozzi_quantity")
quantity_p.multiple_results = True


def bind(operands: Operands, of: Quantity, along: tuple[int, ...], wanted: int) -> list[Any]:
    if len(along) + (wanted != 0) > MOST_DIRECTIONS:
        raise NotImplementedError(f"mozzi.jax has no third derivatives of {of.name}")
    found: list[Any] = quantity_p.bind(*operands.flat(), of=of, along=along, wanted=wanted)
    return found


@functools.partial(jax.jit, static_argnames=("of", "along", "wanted"))
def evaluate(*operands: Any, of: Quantity, along: tuple[int, ...], wanted: int) -> list[Any]:
    """The primitive outside of `jit`: compiled once for each set of constants and shapes."""
    found: list[Any] = quantity_p.bind(*operands, of=of, along=along, wanted=wanted)
    return found


def abstract(*operands: Any, of: Quantity, along: tuple[int, ...], wanted: int) -> list[Any]:
    leading, dtype = operands[0].shape[:-1], operands[0].dtype
    shapes: Any = [(of.inputs[k][1],) for k in bits(wanted)] if wanted else of.outputs
    array: Any = jax.core.ShapedArray  # pyright: ignore[reportAttributeAccessIssue]
    return [array((*leading, *shape), dtype) for shape in shapes]


def lower(ctx: Any, *operands: Any, of: Quantity, along: tuple[int, ...], wanted: int) -> Any:
    first, second = (*along, 0, 0)[:2]
    return ffi.ffi_lowering(TARGET)(
        ctx,
        *operands,
        model=np.int64(of.model),
        quantity=of.name,
        frame=of.frame,
        parameters=np.int64(of.parameters),
        along=np.int64(first),
        along_too=np.int64(second),
        wanted=np.int64(wanted),
        threads=np.int64(of.threads),
    )


# On an NVIDIA GPU: values, and the gradients of quantities with a vector-Jacobian product, by the kernels of
# `Model.to_gpu`. A kernel of gradients computes those of all inputs, along the velocities.

gradients_p = Primitive("mozzi_gradients")
gradients_p.multiple_results = True


def call_gpu(ctx: Any, *operands: Any, of: Quantity, name: str) -> Any:
    names = {"model": np.int64(of.model), "quantity": name, "frame": of.frame}
    return ffi.ffi_lowering(GPU_TARGET)(ctx, *operands, **names)


def lower_on_gpu(ctx: Any, *operands: Any, of: Quantity, along: tuple[int, ...], wanted: int) -> Any:
    if of.parameters:
        raise NotImplementedError(f"{of.name} of given parameters on a GPU: a kernel has the robot's own")
    if along:
        raise NotImplementedError(f"derivatives of {of.name} on a GPU are of first order, in reverse mode")
    if not wanted:
        return call_gpu(ctx, *operands, of=of, name=of.name)
    gradient_of(of.name)

    def gradients(*operands: Any) -> list[Any]:
        found = gradients_p.bind(*operands, of=of)
        if places := MODELS[of.model]._quaternions:
            found[0] = _tangent.position_gradient(jnp, places, operands[0], found[0])
        return [found[k] for k in bits(wanted)]

    return mlir.lower_fun(gradients, multiple_results=True)(ctx, *operands)


def abstract_gradients(*operands: Any, of: Quantity) -> list[Any]:
    _, _, outputs = MODELS[of.model]._jax_shapes(gradient_of(of.name), of.frame or None)
    array: Any = jax.core.ShapedArray  # pyright: ignore[reportAttributeAccessIssue]
    return [array((*operands[0].shape[:-1], *shape), operands[0].dtype) for _, shape in outputs]


def lower_gradients(ctx: Any, *operands: Any, of: Quantity) -> Any:
    return call_gpu(ctx, *operands, of=of, name=gradient_of(of.name))


def is_zero(tangent: Any) -> bool:
    return type(tangent) is ad.Zero


def jvp(primals: Any, tangents: Any, *, of: Quantity, along: tuple[int, ...], wanted: int) -> Any:
    x, d = Operands.split(primals, of, along), Operands.split(tangents, of, along)
    terms = []
    changed = [k for k, tangent in enumerate(d.x) if not is_zero(tangent)]
    if changed:
        operands = x._replace(along=[*x.along, [d.x[k] for k in changed]])
        terms.append(bind(operands, of, (*along, mask_of(changed)), wanted))
    for place, (mask, direction) in enumerate(zip(along, d.along)):
        changed = [k for k, tangent in zip(bits(mask), direction) if not is_zero(tangent)]
        if changed:
            own = [tangent for tangent in direction if not is_zero(tangent)]
            operands = x._replace(along=[*x.along[:place], own, *x.along[place + 1 :]])
            terms.append(bind(operands, of, (*along[:place], mask_of(changed), *along[place + 1 :]), wanted))
    if any(not is_zero(tangent) for tangent in d.w):
        terms.append(bind(x._replace(w=[ad.instantiate_zeros(tangent) for tangent in d.w]), of, along, wanted))
    return bind(x, of, along, wanted), [functools.reduce(jnp.add, parts) for parts in zip(*terms)]


def transpose(cotangents: Any, *operands: Any, of: Quantity, along: tuple[int, ...], wanted: int) -> list[Any]:
    if all(is_zero(cotangent) for cotangent in cotangents):
        return [None] * len(operands)
    x = Operands.split(operands, of, along)
    back = Operands([None] * len(x.x), [[None] * len(direction) for direction in x.along], [None] * len(x.w))
    given = [k for k, cotangent in enumerate(cotangents) if not is_zero(cotangent)]  # of the wanted gradients
    if any(ad.is_undefined_primal(w) for w in x.w):
        # wᵀ∂f(…, x̄) is linear in w with the coefficients ∂f(…, x̄)
        ends = [cotangents[k] for k in given]
        also = mask_of(bits(wanted)[k] for k in given)
        back = back._replace(w=bind(Operands(x.x, [*x.along, ends], []), of, (*along, also), 0))
    for place, (mask, direction) in enumerate(zip(along, x.along)):
        if not any(ad.is_undefined_primal(u) for u in direction):
            continue
        others, masks = [*x.along[:place], *x.along[place + 1 :]], (*along[:place], *along[place + 1 :])
        if wanted:
            # wᵀ∂²f is symmetric
            ends = [cotangents[k] for k in given]
            also = mask_of(bits(wanted)[k] for k in given)
            found = bind(Operands(x.x, [*others, ends], x.w), of, (*masks, also), mask)
        else:
            w = [ad.instantiate_zeros(cotangent) for cotangent in cotangents]
            found = bind(Operands(x.x, others, w), of, masks, mask)
        back.along[place][:] = [g if ad.is_undefined_primal(u) else None for u, g in zip(direction, found)]
    return back.flat()


def batch(operands: Any, axes: Any, *, of: Quantity, along: tuple[int, ...], wanted: int) -> Any:
    """One call for all: every operand gets the new axis."""
    size = next(x.shape[axis] for x, axis in zip(operands, axes) if axis is not None)
    moved = [
        jnp.broadcast_to(x, (size, *x.shape)) if axis is None else jnp.moveaxis(x, axis, 0)
        for x, axis in zip(operands, axes)
    ]
    found = quantity_p.bind(*moved, of=of, along=along, wanted=wanted)
    return found, [0] * len(found)


quantity_p.def_impl(evaluate)
quantity_p.def_abstract_eval(abstract)
mlir.register_lowering(quantity_p, lower, platform="cpu")
mlir.register_lowering(quantity_p, lower_on_gpu, platform="cuda")
gradients_p.def_abstract_eval(abstract_gradients)
mlir.register_lowering(gradients_p, lower_gradients, platform="cuda")
ad.primitive_jvps[quantity_p] = jvp
ad.primitive_transposes[quantity_p] = transpose
jax.interpreters.batching.primitive_batchers[quantity_p] = batch
