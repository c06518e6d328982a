"""Rates of change of θ and gradients by θ, between its nq numbers and the n velocities.

A quaternion q = (w, r) and the position p of a free joint or a floating base move with the body twist (ω, v):

    ω = 2/‖q‖² (w ṙ − ẇ r − r × ṙ),    v = Rᵀ ṗ

Rates of θ are mapped by this matrix, gradients by its transpose: a gradient by q is tangent to the sphere, as that of
a function of q/‖q‖. All other numbers are themselves. The functions work on arrays of any library: `xp` is its module,
numpy, jax.numpy or torch.
"""

from typing import Any

Quaternions = list[tuple[int, int, bool]]
"""For each quaternion in θ: its index in θ, its joint's index in θ̇, and whether a position follows it."""


def _joined(xp: Any, parts: list[Any]) -> Any:
    # torch's `concatenate` has no rule for torch.autograd.grad(is_grads_batched=True), its `cat` has
    return xp.cat(parts, dim=-1) if hasattr(xp, "cat") else xp.concatenate(parts, axis=-1)


def cross(xp: Any, a: Any, b: Any) -> Any:
    (a0, a1, a2), (b0, b1, b2) = (a[..., 0], a[..., 1], a[..., 2]), (b[..., 0], b[..., 1], b[..., 2])
    return xp.stack([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0], axis=-1)


def _parts(theta: Any, at: int) -> tuple[Any, Any, Any]:
    """w, r and 2/‖q‖² of the quaternion at this index."""
    w, r = theta[..., at : at + 1], theta[..., at + 1 : at + 4]
    return w, r, 2 / (w * w + (r * r).sum(-1)[..., None])


def _rotated(xp: Any, w: Any, r: Any, two: Any, u: Any) -> Any:
    """Ru; with −w, Rᵀu."""
    turned = cross(xp, r, u)
    return u + two * (w * turned + cross(xp, r, turned))


def to_velocities(xp: Any, quaternions: Quaternions, theta: Any, rate: Any, is_gradient: bool = False) -> Any:
    """The rate (..., nq) of θ as velocities (..., n).

    A gradient (..., nq) by θ as gradient along the velocities, by the transpose of q̇ = ½ q (0, ω), ṗ = Rv.
    """
    parts, last = [], 0
    for q, _, is_free in quaternions:
        w, r, two = _parts(theta, q)
        dw, dr = rate[..., q : q + 1], rate[..., q + 1 : q + 4]
        factor = 0.5 if is_gradient else two
        parts += [rate[..., last:q], factor * (w * dr - dw * r - cross(xp, r, dr))]
        last = q + 4
        if is_free:
            parts.append(_rotated(xp, -w, r, two, rate[..., q + 4 : q + 7]))
            last = q + 7
    return _joined(xp, [*parts, rate[..., last:]]) if quaternions else rate


def to_positions(xp: Any, quaternions: Quaternions, theta: Any, gradient: Any) -> Any:
    """The gradient (..., n) along the velocities as gradient (..., nq) by the numbers of θ: the transpose."""
    parts, last = [], 0
    for q, j, is_free in quaternions:
        w, r, two = _parts(theta, q)
        g = gradient[..., j : j + 3]
        parts += [gradient[..., last:j], -two * (r * g).sum(-1)[..., None], two * (w * g + cross(xp, r, g))]
        last = j + 3
        if is_free:
            parts.append(_rotated(xp, w, r, two, gradient[..., j + 3 : j + 6]))
            last = j + 6
    return _joined(xp, [*parts, gradient[..., last:]]) if quaternions else gradient


def bracket(xp: Any, quaternions: Quaternions, along: Any, gradient: Any) -> Any:
    """Second derivatives along velocities do not commute: what the gradient of gᵀu, u constant, has beyond the
    derivative of the gradient g along u.

    Along e_j it is g[e_j, u] with the bracket of body twists: (ω_u × m + v_u × f, ω_u × f) for g = (m, f); 0 for joints
    of one axis.
    """
    parts, last = [], 0
    for _, j, is_free in quaternions:
        omega, m = along[..., j : j + 3], gradient[..., j : j + 3]
        parts.append(0 * gradient[..., last:j])
        last = j + 3
        if is_free:
            v, f = along[..., j + 3 : j + 6], gradient[..., j + 3 : j + 6]
            parts += [cross(xp, omega, m) + cross(xp, v, f), cross(xp, omega, f)]
            last = j + 6
        else:
            parts.append(cross(xp, omega, m))
    return _joined(xp, [*parts, 0 * gradient[..., last:]])
