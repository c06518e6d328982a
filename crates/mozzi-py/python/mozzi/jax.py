"""Dynamics in JAX: under `jit`, `grad`, `jvp`, `jacfwd`, `jacrev`, `hessian`, `vmap`, `scan`, in float32 and float64.

>>> import jax, mozzi, mozzi.jax                                                          # doctest: +SKIP
>>> ur5 = mozzi.models.ur5()                                                              # doctest: +SKIP
>>> effort = lambda theta: (mozzi.jax.gravity_forces(ur5, theta) ** 2).sum()              # doctest: +SKIP
>>> jax.jit(jax.grad(effort))(jax.numpy.zeros(6))                                         # doctest: +SKIP

Each function takes a `mozzi.Model`, which is a constant of the compiled program, and arrays whose last axis is a state;
leading axes are many states, broadcast by NumPy's rule and computed by one call on all cores, as those of `vmap`.
Arrays on the CPU are computed by the package's own library, those on the first NVIDIA GPU by the kernels of
`Model.to_gpu`, with gradients of inverse and forward dynamics in reverse mode.

Derivatives up to the second order are exact, in both modes, on the CPU. With respect to θ they are taken with respect
to its nq numbers: a quaternion's length has no effect, so that its gradient is tangent to the unit sphere.
`tangent_gradient` converts such a gradient to n numbers along the velocities, as in the package's own derivatives;
`integrate` is θ ⊕ δ.

`parameters=` replaces the robot's inertial parameters by an array in the order of `Model.parameters`, with respect to
which results are differentiable: ∂τ/∂π = Y.
"""

import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _tangent
from ._jax import Operands, bind, quantity  # first: it reports that JAX is missing
from ._mozzi import Model
from ._names import listed as _listed
from ._names import missing as _missing

import jax
import jax.numpy as jnp

__all__ = [
    "Rollout",
    "bias_forces",
    "body_jacobian",
    "forward_dynamics",
    "forward_kinematics",
    "gravity_forces",
    "integrate",
    "inverse_dynamics",
    "mass_matrix",
    "rollout",
    "space_jacobian",
    "tangent_gradient",
    "velocity_product",
]

ArrayLike = Any
Array = jax.Array

if not TYPE_CHECKING:  # for which every name would exist

    def __getattr__(name: str) -> object:
        """The function that was meant, or all that exist, for a name that does not exist."""
        meant = {
            "rnea": "mozzi.jax.inverse_dynamics",
            "aba": "mozzi.jax.forward_dynamics",
            "crba": "mozzi.jax.mass_matrix",
            "simulate": "mozzi.jax.rollout",
            "jacobian": "mozzi.jax.body_jacobian or space_jacobian",
        }
        others = f"mozzi.jax has {', '.join(__all__)}"
        if callable(getattr(Model, name, None)):
            others = f"mozzi.Model.{name} computes it in NumPy, without JAX's gradients; {others}"
        raise _missing("mozzi.jax", name, meant, others)

    __dir__ = _listed(globals())


def _check(model: Model) -> None:
    if not isinstance(model, Model):
        raise TypeError(f"model is a {type(model).__name__}, expected a mozzi.Model")


def _arrays(names: Sequence[str], given: Sequence[ArrayLike]) -> list[Array]:
    """The arguments as arrays of one type, float32 or float64."""
    arrays = [jnp.asarray(x) for x in given]
    dtype = jnp.result_type(*arrays)
    if jnp.issubdtype(dtype, jnp.integer) or jnp.issubdtype(dtype, jnp.bool_):
        dtype = jnp.result_type(float)
    if dtype not in (jnp.float32, jnp.float64):
        raise TypeError(f"{', '.join(names)} have the common dtype {dtype}, expected float32 or float64")
    return [x.astype(dtype) for x in arrays]


_NAMES = {"theta": "position_names", "gradient": "position_names", "parameters": "parameter_names"}


def _broadcast(names: Sequence[str], arrays: list[Array], lengths: Sequence[int], model: Model) -> list[Array]:
    """Broadcast all arguments to common leading axes."""
    leading: tuple[int, ...] = ()
    for name, x, length in zip(names, arrays, lengths):
        if x.shape[-1:] != (length,):
            entries = f"see {_NAMES.get(name, 'velocity_names')} of '{model.name}'"
            raise ValueError(f"{name} has shape {x.shape}, expected (..., {length}): {entries}")
        try:
            leading = jnp.broadcast_shapes(leading, x.shape[:-1])
        except ValueError:
            found = f"{name} has leading axes {x.shape[:-1]}"
            raise ValueError(f"{found}, which do not go with {leading} of the arguments before it") from None
    return [jnp.broadcast_to(x, (*leading, length)) for x, length in zip(arrays, lengths)]


def _compute(
    model: Model,
    name: str,
    state: Sequence[ArrayLike],
    frame: str | None = None,
    parameters: ArrayLike | None = None,
    threads: int | None = None,
) -> Array:
    _check(model)
    if threads is not None and not 1 <= threads <= 1024:
        raise ValueError(f"threads is {threads}, expected 1 to 1024, or None for all cores")
    of = quantity(model, name, frame, parameters is not None, threads)
    names, lengths = zip(*of.inputs)
    given = [*state] if parameters is None else [*state, parameters]
    arrays = _broadcast(names, _arrays(names, given), lengths, model)
    found: Array
    [found] = bind(Operands(arrays, [], []), of, (), 0)
    return found


def inverse_dynamics(
    model: Model,
    theta: ArrayLike,
    dtheta: ArrayLike,
    ddtheta: ArrayLike,
    *,
    parameters: ArrayLike | None = None,
    threads: int | None = None,
) -> Array:
    """Compute τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + f(θ, θ̇); its gradient takes one pass over the links.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    dtheta : array_like, shape (..., n)
        Velocities: rad/s or m/s.
    ddtheta : array_like, shape (..., n)
        Accelerations: rad/s² or m/s².
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., n)
        N m or N.
    """
    return _compute(model, "inverse_dynamics", [theta, dtheta, ddtheta], None, parameters, threads)


def forward_dynamics(
    model: Model,
    theta: ArrayLike,
    dtheta: ArrayLike,
    tau: ArrayLike,
    *,
    parameters: ArrayLike | None = None,
    threads: int | None = None,
) -> Array:
    """Compute θ̈ = M⁻¹(τ − c − g − f); its gradient takes a solution of Mλ = x and a pass over the links.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    dtheta : array_like, shape (..., n)
        Velocities: rad/s or m/s.
    tau : array_like, shape (..., n)
        Torques: N m or N.
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., n)
        rad/s² or m/s².
    """
    return _compute(model, "forward_dynamics", [theta, dtheta, tau], None, parameters, threads)


def mass_matrix(
    model: Model, theta: ArrayLike, *, parameters: ArrayLike | None = None, threads: int | None = None
) -> Array:
    """Compute the mass matrix M(θ).

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., n, n)
    """
    return _compute(model, "mass_matrix", [theta], None, parameters, threads)


def velocity_product(
    model: Model,
    theta: ArrayLike,
    dtheta: ArrayLike,
    *,
    parameters: ArrayLike | None = None,
    threads: int | None = None,
) -> Array:
    """Compute the Coriolis and centripetal forces c(θ, θ̇) = C(θ, θ̇)θ̇.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    dtheta : array_like, shape (..., n)
        Velocities: rad/s or m/s.
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., n)
        N m or N.
    """
    return _compute(model, "velocity_product", [theta, dtheta], None, parameters, threads)


def gravity_forces(
    model: Model, theta: ArrayLike, *, parameters: ArrayLike | None = None, threads: int | None = None
) -> Array:
    """Compute the gravity forces g(θ).

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., n)
        N m or N.
    """
    return _compute(model, "gravity_forces", [theta], None, parameters, threads)


def bias_forces(
    model: Model,
    theta: ArrayLike,
    dtheta: ArrayLike,
    *,
    parameters: ArrayLike | None = None,
    threads: int | None = None,
) -> Array:
    """Compute the bias forces h(θ, θ̇) = c + g.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    dtheta : array_like, shape (..., n)
        Velocities: rad/s or m/s.
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., n)
        N m or N.
    """
    return _compute(model, "bias_forces", [theta, dtheta], None, parameters, threads)


def forward_kinematics(
    model: Model, theta: ArrayLike, frame: str | None = None, *, threads: int | None = None
) -> Array:
    """Compute the pose T_sb(θ) of a frame in {s}.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    frame : str, optional
        A link or frame. Default: the end effector.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., 4, 4)
    """
    return _compute(model, "forward_kinematics", [theta], frame, None, threads)


def space_jacobian(model: Model, theta: ArrayLike, frame: str | None = None, *, threads: int | None = None) -> Array:
    """Compute the space Jacobian J_s(θ) of a frame, angular rows first.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    frame : str, optional
        A link or frame. Default: the end effector.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., 6, n)
    """
    return _compute(model, "space_jacobian", [theta], frame, None, threads)


def body_jacobian(model: Model, theta: ArrayLike, frame: str | None = None, *, threads: int | None = None) -> Array:
    """Compute the body Jacobian J_b(θ) of a frame, angular rows first.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    frame : str, optional
        A link or frame. Default: the end effector.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    jax.Array, shape (..., 6, n)
    """
    return _compute(model, "body_jacobian", [theta], frame, None, threads)


def integrate(model: Model, theta: ArrayLike, dtheta: ArrayLike) -> Array:
    """Compute θ ⊕ θ̇, the positions after constant velocities θ̇ for one second.

    `jax.grad(lambda d: f(integrate(model, theta, d)))(jax.numpy.zeros(n))` is the gradient of f along the velocities.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    dtheta : array_like, shape (..., n)
        Velocities: rad/s or m/s.

    Returns
    -------
    jax.Array, shape (..., nq)
    """
    _check(model)
    names, lengths = ("theta", "dtheta"), (model.nq, model.n)
    theta, dtheta = _broadcast(names, _arrays(names, (theta, dtheta)), lengths, model)
    found: Array = _tangent.advance(jnp, model._quaternions, theta, dtheta)
    return found


def tangent_gradient(model: Model, theta: ArrayLike, gradient: ArrayLike) -> Array:
    """Convert a gradient with respect to θ's numbers to the gradient along the velocities.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    gradient : array_like, shape (..., nq)
        Gradient with respect to the numbers of θ.

    Returns
    -------
    jax.Array, shape (..., n)
    """
    _check(model)
    names, lengths = ("theta", "gradient"), (model.nq, model.nq)
    theta, gradient = _broadcast(names, _arrays(names, (theta, gradient)), lengths, model)
    found: Array = _tangent.velocity_gradient(jnp, model._quaternions, theta, gradient)
    return found


class Rollout(NamedTuple):
    """The start and the states of N steps: see ``rollout``."""

    theta: Array
    """Shape (..., N + 1, nq): rad or m."""
    dtheta: Array
    """Shape (..., N + 1, n): rad/s or m/s."""


@functools.partial(jax.jit, static_argnums=(0, 1, 2))
def _steps(
    model: Model,
    method: str,
    threads: int | None,
    theta: Array,
    dtheta: Array,
    torques: Array,
    h: Array,
    parameters: Array | None,
) -> tuple[Array, Array]:
    """The states after each step; compiled once for a model, method and shapes."""
    places = model._quaternions

    def advance(theta: Array, u: Array) -> Array:
        found: Array = _tangent.advance(jnp, places, theta, u)
        return found

    def one(state: tuple[Array, Array], tau: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        theta, dtheta = state

        def accelerations(theta: Array, dtheta: Array) -> Array:
            return forward_dynamics(model, theta, dtheta, tau, parameters=parameters, threads=threads)

        if method == "euler":
            after = advance(theta, h * dtheta), dtheta + h * accelerations(theta, dtheta)
        elif method == "semi-implicit-euler":
            later = dtheta + h * accelerations(theta, dtheta)
            after = advance(theta, h * later), later
        else:
            # θ = θ₀ ⊕ u
            slopes: list[tuple[Array, Array]] = []
            u, rates = jnp.zeros_like(dtheta), dtheta
            for fraction in (0.5, 0.5, 1.0, 0.0):
                du = _tangent.logarithm_rate(jnp, places, u, rates)
                ddtheta = accelerations(advance(theta, u), rates) if slopes else accelerations(theta, rates)
                slopes.append((du, ddtheta))
                u, rates = fraction * h * du, dtheta + fraction * h * ddtheta
            (a, da), (b, db), (c, dc), (d, dd) = slopes
            mean, dmean = (a + 2.0 * (b + c) + d) / 6.0, (da + 2.0 * (db + dc) + dd) / 6.0
            after = advance(theta, h * mean), dtheta + h * dmean
        return after, after

    found: tuple[Array, Array] = jax.lax.scan(one, (theta, dtheta), torques)[1]
    return found


def rollout(
    model: Model,
    theta: ArrayLike,
    dtheta: ArrayLike,
    tau: ArrayLike,
    step: ArrayLike,
    method: str = "rk4",
    *,
    parameters: ArrayLike | None = None,
    threads: int | None = None,
) -> Rollout:
    """Compute the states of N steps under torques that are constant over each step.

    Joint limits are ignored. It is a `jax.lax.scan` over `forward_dynamics`, which 'rk4' calls four times a step;
    reverse mode keeps the stages of all steps, and `jax.checkpoint` trades this memory for time.

    Parameters
    ----------
    model : mozzi.Model
        The robot.
    theta : array_like, shape (..., nq)
        Positions: rad or m.
    dtheta : array_like, shape (..., n)
        Velocities: rad/s or m/s.
    tau : array_like, shape (..., N, n)
        Torques of each step: N m or N.
    step : array_like, shape ()
        The length of a step, s.
    method : {'rk4', 'euler', 'semi-implicit-euler'}
        Integration method, as in `Model.simulate`.
    parameters : array_like, shape (..., p), optional
        Inertial parameters π. Default: the model's.
    threads : int, optional
        Maximum number of threads on the CPU. Default: all cores.

    Returns
    -------
    Rollout
        The start and the state after each step.

    Raises
    ------
    ValueError
        If the model has constraints, which `Model.rollout` keeps.
    """
    _check(model)
    if method not in ("rk4", "euler", "semi-implicit-euler"):
        raise ValueError(f"method is {method!r}, expected 'rk4', 'euler' or 'semi-implicit-euler'")
    _tangent.require_tree(model.constraints)
    names = ("theta", "dtheta", "tau", "parameters")
    given = [theta, dtheta, tau] if parameters is None else [theta, dtheta, tau, parameters]
    theta, dtheta, tau, *inertial = _arrays(names[: len(given)], given)
    h = jnp.asarray(step, theta.dtype)
    if h.shape != ():
        raise ValueError(f"step has shape {h.shape}, expected one number of seconds")
    if tau.ndim < 2 or tau.shape[-1] != model.n:
        raise ValueError(f"tau has shape {tau.shape}, expected (..., N, {model.n}): the torques of N steps")
    torques = jnp.moveaxis(tau, -2, 0)
    lengths = (model.nq, model.n, model.n, len(model.parameters))
    one_tau = jnp.zeros((*tau.shape[:-2], model.n), tau.dtype)
    theta, dtheta, *_ = _broadcast(names, [theta, dtheta, one_tau, *inertial], lengths, model)
    parameters = inertial[0] if inertial else None
    later, dlater = _steps(model, method, threads, theta, dtheta, torques, h, parameters)
    tables = (jnp.concatenate([first[None], rest]) for first, rest in ((theta, later), (dtheta, dlater)))
    return Rollout(*(jnp.moveaxis(table, 0, -2) for table in tables))
