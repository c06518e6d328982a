"""Trajectories: desired motions of the joints over time (Modern Robotics, chapter 9).

A ``Path`` is θ(s) for s from 0 to 1: a ``Line`` in joint space, a ``Spline`` through via points, or a ``Cartesian``
path of a frame. A ``Profile`` is s(t): cubic, quintic, trapezoidal, or as fast as limits allow (``Path.time_optimal``,
``Path.stretched``). A ``Reference`` is a motion that a controller follows: a path with a profile, ``Timed``; a table,
``Recorded``; or constant positions, ``Hold``.

>>> import mozzi
>>> import numpy as np
>>> from mozzi.trajectories import Line, Timed
>>> ur5 = mozzi.models.ur5()
>>> line = Line(ur5, [0.0, -1.5, 1.5, 0.0, 0.0, 0.0], [1.5, -1.0, 0.5, 0.0, 1.0, 0.0])
>>> motion = Timed(line, line.time_optimal(acceleration=10.0))
>>> theta, dtheta, ddtheta = motion.at(np.linspace(0.0, motion.duration, 200))
>>> dtheta.shape, bool((abs(dtheta) <= 1.000001 * ur5.velocity_limits).all())
((200, 6), True)
>>> torques = ur5.inverse_dynamics(theta, dtheta, ddtheta)
"""

from ._mozzi import Cartesian, Hold, Line, OfJoints, Path, Profile, Recorded, Reference, Spline, Timed, poses_between
from ._results import Desired, PathPoint, Progress

__all__ = [
    "Cartesian",
    "Desired",
    "Hold",
    "Line",
    "OfJoints",
    "Path",
    "PathPoint",
    "Profile",
    "Progress",
    "Recorded",
    "Reference",
    "Spline",
    "Timed",
    "poses_between",
]
