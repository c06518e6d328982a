"""The world of a robot as one object."""

from collections.abc import Mapping
from dataclasses import dataclass

from numpy.typing import ArrayLike


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Environment:
    """Gravity, the motion of the base, wrenches and inertial parameters, for many calls.

    Every quantity takes the parts that it depends on; ``None`` is the robot's own.

    Parameters
    ----------
    gravity : array_like, shape (..., 3), optional
        Gravity in the axes of {s}, m/s².
    base_twist : array_like, shape (6,), optional
        Twist (ω, v) of {s}: rad/s, m/s.
    base_acceleration : array_like, shape (6,), optional
        Rates (ω̇, v̇) of the twist of {s}: rad/s², m/s². The acceleration of its origin is v̇ + ω × v.
    tip_wrench : array_like, shape (..., 6), optional
        Wrench (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
    applied_wrenches : dict of str to array_like of shape (..., 6), optional
        Wrench (m, f) that each frame applies to the environment, in its own coordinates: N m, N.
    parameters : array_like, shape (..., p), optional
        Inertial parameters in the order of ``Model.parameters``.

    Examples
    --------
    >>> import mozzi
    >>> on_the_moon = mozzi.Environment(gravity=[0, 0, -1.62])
    >>> mozzi.models.ur5().gravity_forces([0.0] * 6, environment=on_the_moon).round(2)
    array([ 0.  , -9.13, -2.3 ,  0.  ,  0.  ,  0.  ])
    """

    gravity: ArrayLike | None = None
    base_twist: ArrayLike | None = None
    base_acceleration: ArrayLike | None = None
    tip_wrench: ArrayLike | None = None
    applied_wrenches: Mapping[str, ArrayLike] | None = None
    parameters: ArrayLike | None = None
