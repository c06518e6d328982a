"""Positions θ with quaternions, in arrays of NumPy, JAX or PyTorch: velocities, gradients and ⊕, by one rule for all.

A floating base, a ball and a free joint have a quaternion q = (w, v) in θ, of 4 numbers, and an angular velocity ω in
the moving body's axes, of 3. Quantities use the rotation R of q, whatever the length of q, so that

    ω = 2 (w q̇_v − v q̇_w − v × q̇_v) / |q|²,      q̇ = ½ (−vᵀω, w ω + v × ω)

and, for a floating base and a free joint with their origin at p, v_p = Rᵀ ṗ and ṗ = R v_p. All other numbers of θ̇ are
the derivatives of those of θ.

A derivative with respect to θ is tangent by default: n numbers along ω and v_p are the nq numbers of
`position_gradient`, whose part of q is perpendicular to q. `velocity_gradient` gives n numbers from nq.

`places` is `Model._quaternions`: for each quaternion its index in θ, that of ω in θ̇, and whether an origin follows.
`xp` is the arrays' library: `numpy`, `jax.numpy` or `torch`. Leading axes are many states.
"""

from collections.abc import Callable, Sequence
from typing import Any

Place = tuple[int, int, bool]

# below this square of an angle, series are exact to rounding, and their derivatives exist at 0
_SMALL = 1e-3


def require_tree(constraints: Sequence[Any]) -> None:
    """Steps by θ̈ of the tree, θ ← θ ⊕ hθ̇, leave what constraints allow."""
    if constraints:
        raise ValueError(
            f"these rollouts do not keep constraints, and the robot has {len(constraints)}: Model.rollout does; "
            "Model.without_constraints() is the tree alone"
        )


def _joined(xp: Any, parts: list[Any]) -> Any:
    # torch's `concatenate` has no rule for torch.autograd.grad(is_grads_batched=True), its `cat` has
    return xp.cat(parts, dim=-1) if hasattr(xp, "cat") else xp.concatenate(parts, axis=-1)


def _walk(
    xp: Any, places: Sequence[Place], flat: Callable[[slice, slice], Any], turned: Callable[[int, int, bool], list[Any]]
) -> Any:
    """The parts of θ or θ̇ in their order: `flat` those without quaternions, `turned` the others."""
    parts, q, j = [], 0, 0
    for at_q, at_j, is_free in places:
        parts.append(flat(slice(q, at_q), slice(j, at_j)))
        parts += turned(at_q, at_j, is_free)
        q, j = at_q + (7 if is_free else 4), at_j + (6 if is_free else 3)
    return _joined(xp, [*parts, flat(slice(q, None), slice(j, None))])


def _quaternion(theta: Any, q: int) -> tuple[Any, Any]:
    return theta[..., q : q + 1], theta[..., q + 1 : q + 4]


def _three(x: Any, first: int) -> Any:
    return x[..., first : first + 3]


def _dot(a: Any, b: Any) -> Any:
    return (a * b).sum(-1)[..., None]


def _cross(xp: Any, a: Any, b: Any) -> Any:
    (ax, ay, az), (bx, by, bz) = ([x[..., k : k + 1] for k in range(3)] for x in (a, b))
    return _joined(xp, [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _rotate(xp: Any, w: Any, v: Any, x: Any, sign: float = 1.0) -> Any:
    """R x, or Rᵀ x with sign −1."""
    turn = _cross(xp, v, x)
    return x + (sign * w * turn + _cross(xp, v, turn)) * (2.0 / (w * w + _dot(v, v)))


def velocities(xp: Any, places: Sequence[Place], theta: Any, rates: Any) -> Any:
    """θ̇, n numbers, from the derivatives of the nq positions."""

    def turned(q: int, j: int, is_free: bool) -> list[Any]:
        (w, v), (dw, dv) = _quaternion(theta, q), _quaternion(rates, q)
        omega = (w * dv - v * dw - _cross(xp, v, dv)) * (2.0 / (w * w + _dot(v, v)))
        return [omega, _rotate(xp, w, v, _three(rates, q + 4), -1.0)] if is_free else [omega]

    return _walk(xp, places, lambda q, _: rates[..., q], turned)


def position_gradient(xp: Any, places: Sequence[Place], theta: Any, gradient: Any) -> Any:
    """The gradient by the nq positions, from that along the n velocities: the transpose of `velocities`."""

    def turned(q: int, j: int, is_free: bool) -> list[Any]:
        (w, v), g = _quaternion(theta, q), _three(gradient, j)
        scale = 2.0 / (w * w + _dot(v, v))
        of_q = [-_dot(v, g) * scale, (w * g + _cross(xp, v, g)) * scale]
        return [*of_q, _rotate(xp, w, v, _three(gradient, j + 3))] if is_free else of_q

    return _walk(xp, places, lambda _, j: gradient[..., j], turned)


def rates(xp: Any, places: Sequence[Place], theta: Any, dtheta: Any) -> Any:
    """The derivatives of the nq positions, from θ̇; the length of a quaternion does not change."""

    def turned(q: int, j: int, is_free: bool) -> list[Any]:
        (w, v), half = _quaternion(theta, q), 0.5 * _three(dtheta, j)
        of_q = [-_dot(v, half), w * half + _cross(xp, v, half)]
        return [*of_q, _rotate(xp, w, v, _three(dtheta, j + 3))] if is_free else of_q

    return _walk(xp, places, lambda _, j: dtheta[..., j], turned)


def velocity_gradient(xp: Any, places: Sequence[Place], theta: Any, gradient: Any) -> Any:
    """The gradient along the n velocities, from that by the nq positions: the transpose of `rates`."""

    def turned(q: int, j: int, is_free: bool) -> list[Any]:
        (w, v), (gw, gv) = _quaternion(theta, q), _quaternion(gradient, q)
        of_omega = 0.5 * (w * gv - v * gw - _cross(xp, v, gv))
        return [of_omega, _rotate(xp, w, v, _three(gradient, q + 4), -1.0)] if is_free else [of_omega]

    return _walk(xp, places, lambda q, _: gradient[..., q], turned)


def bracket(xp: Any, places: Sequence[Place], along: Any, gradient: Any) -> Any:
    """Second derivatives along velocities do not commute: what the gradient of gᵀu, u constant, has beyond the
    derivative of the gradient g along u.

    Along e_j it is g[e_j, u] with the bracket of body twists: (ω_u × m + v_u × f, ω_u × f) for g = (m, f); 0 for joints
    of one axis.
    """

    def turned(_: int, j: int, is_free: bool) -> list[Any]:
        omega, m = _three(along, j), _three(gradient, j)
        if not is_free:
            return [_cross(xp, omega, m)]
        v, f = _three(along, j + 3), _three(gradient, j + 3)
        return [_cross(xp, omega, m) + _cross(xp, v, f), _cross(xp, omega, f)]

    return _walk(xp, places, lambda _, j: 0 * gradient[..., j], turned)


def _sinc(xp: Any, z: Any) -> Any:
    """sin θ / θ of z = θ²."""
    is_small = z < _SMALL
    theta = xp.sqrt(xp.where(is_small, 1.0, z))
    series = 1.0 - z / 6.0 * (1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0)))
    return xp.where(is_small, series, xp.sin(theta) / theta)


def _cosc(xp: Any, z: Any) -> Any:
    """(1 − cos θ) / θ² of z = θ²."""
    return 0.5 * _sinc(xp, 0.25 * z) ** 2


def _sinc3(xp: Any, z: Any) -> Any:
    """(θ − sin θ) / θ³ of z = θ²."""
    is_small = z < 1.0
    z_small = xp.where(is_small, z, 0.0)
    theta = xp.sqrt(xp.where(is_small, 1.0, z))
    series = 1.0
    for k in range(9, 0, -1):  # Σ (−z)ᵏ 6 / (2k + 3)!
        series = 1.0 - z_small / ((2.0 * k + 2.0) * (2.0 * k + 3.0)) * series
    return xp.where(is_small, series / 6.0, (theta - xp.sin(theta)) / theta**3)


def advance(xp: Any, places: Sequence[Place], theta: Any, dtheta: Any) -> Any:
    """θ ⊕ θ̇: the positions after constant velocities θ̇ for one second; quaternions become unit ones."""

    def turned(q: int, j: int, is_free: bool) -> list[Any]:
        (w, v), omega = _quaternion(theta, q), _three(dtheta, j)
        square = 0.25 * _dot(omega, omega)
        s, t = 1.0 - square * _cosc(xp, square), 0.5 * omega * _sinc(xp, square)  # of exp(ω)
        s, u = w * s - _dot(v, t), w * t + v * s + _cross(xp, v, t)
        scale = 1.0 / xp.sqrt(s * s + _dot(u, u))
        if not is_free:
            return [s * scale, u * scale]
        shift, angle = _three(dtheta, j + 3), 4.0 * square
        once = _cross(xp, omega, shift)
        shift = shift + _cosc(xp, angle) * once + _sinc3(xp, angle) * _cross(xp, omega, once)
        return [s * scale, u * scale, _three(theta, q + 4) + _rotate(xp, w, v, shift)]

    return _walk(xp, places, lambda q, j: theta[..., q] + dtheta[..., j], turned)


def logarithm_rate(xp: Any, places: Sequence[Place], u: Any, dtheta: Any) -> Any:
    """u̇ for θ = θ₀ ⊕ u that moves with θ̇, to third order in u: 𝒱 + ½[ad_u]𝒱 + ¹⁄₁₂[ad_u]²𝒱 (Munthe-Kaas 1999)."""

    def turned(q: int, j: int, is_free: bool) -> list[Any]:
        u_w, omega = _three(u, j), _three(dtheta, j)
        once = _cross(xp, u_w, omega)
        of_omega = omega + 0.5 * once + _cross(xp, u_w, once) / 12.0
        if not is_free:
            return [of_omega]
        u_v, v = _three(u, j + 3), _three(dtheta, j + 3)
        once_v = _cross(xp, u_w, v) + _cross(xp, u_v, omega)
        twice_v = _cross(xp, u_w, once_v) + _cross(xp, u_v, once)
        return [of_omega, v + 0.5 * once_v + twice_v / 12.0]

    return _walk(xp, places, lambda _, j: dtheta[..., j], turned)
