"""Conversions of states, forces and matrices to and from the conventions of Pinocchio and MuJoCo.

>>> import mozzi
>>> from mozzi.conventions import Pinocchio
>>> anymal = mozzi.models.anymal()
>>> bridge = Pinocchio(anymal)
>>> q = bridge.configuration(anymal.neutral_configuration)
>>> q[:7].tolist() # the origin first, the quaternion's real part last
[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
>>> bool((bridge.from_configuration(q) == anymal.neutral_configuration).all())
True

To compare results: ``bridge.force(robot.inverse_dynamics(θ, θ̇, θ̈))`` equals ``pin.rnea(model, data,
bridge.configuration(θ), bridge.velocity(θ̇), bridge.acceleration(θ̈))``. All methods take leading axes. Six-vectors are
angular first in mozzi, (ω, v) and (m, f); `linear_first` and `angular_first` exchange the halves. Wrenches act from the
robot on the environment in mozzi, and from the environment on the robot in Pinocchio and MuJoCo: `external` exchanges
halves and sign.
"""

from typing import Any, Optional, cast

import numpy as np

from ._mozzi import Model
from ._mozzi import MuJoCo as _MuJoCo
from ._mozzi import Pinocchio as _Pinocchio
from ._names import listed as _listed

__all__ = ["MuJoCo", "Pinocchio", "angular_first", "external", "from_external", "linear_first"]

__dir__ = _listed(globals())


def linear_first(six: Any) -> Any:
    """Exchange the halves of six-vectors: (v, ω) of (ω, v), or (f, m) of (m, f), along the last axis.

    Parameters
    ----------
    six : array_like, shape (..., 6)
        Twists or wrenches.

    Returns
    -------
    numpy.ndarray, shape (..., 6)
    """
    six = np.asarray(six)
    if six.dtype.kind in "bui":
        six = six.astype(float)  # an unsigned number has no opposite
    if six.dtype.kind != "f":
        raise TypeError(f"the six-vector has dtype {six.dtype}, expected real numbers")
    if six.shape[-1:] != (6,):
        raise ValueError(f"the six-vector has shape {six.shape}, expected (..., 6)")
    return np.concatenate([six[..., 3:], six[..., :3]], -1)


angular_first = linear_first


def external(wrench: Any) -> Any:
    """Convert a wrench (m, f) on the environment to the force (f, m) of the environment on the frame.

    It is `pin.Force`'s vector, in the frame's coordinates. The function is its own inverse.

    Parameters
    ----------
    wrench : array_like, shape (..., 6)
        N m, N.

    Returns
    -------
    numpy.ndarray, shape (..., 6)
        N, N m.
    """
    return -linear_first(wrench)


from_external = external


def _check(robot: Any, library: str) -> None:
    if not isinstance(robot, Model):
        expected = f"a mozzi.Model, and {library}'s model after it: {library}(robot, model)"
        raise TypeError(f"robot is a {type(robot).__name__}, expected {expected}")


def Pinocchio(robot: Model, model: Optional[Any] = None) -> _Pinocchio:
    """Make the conversions to and from Pinocchio.

    Parameters
    ----------
    robot : Model
        The robot.
    model : pinocchio.Model, optional
        Pinocchio's model of the robot, whose joint order is used. Default: the order of Pinocchio's URDF reader.

    Returns
    -------
    bridge
        `configuration(theta)`, `velocity(dtheta)`, `acceleration(ddtheta)`, `force(tau)`, `mass_matrix(M)`,
        `jacobian(J)` to Pinocchio; `from_configuration(q)`, `from_velocity(v)`, `from_acceleration(a)`,
        `from_force(tau)`, `from_mass_matrix(M)` back.
    """
    _check(robot, "Pinocchio")
    if model is None:
        return _Pinocchio(robot, None)
    # the universe is number 0, then the free flyer of a floating base; mimics have no positions
    moving = [(str(name), int(nq)) for name, nq, nv in zip(model.names, model.nqs, model.nvs) if nv > 0]
    moving = moving[1:] if robot.is_floating else moving
    return _Pinocchio(robot, ([name for name, _ in moving], [nq for _, nq in moving]))


def MuJoCo(robot: Model, model: Optional[Any] = None) -> _MuJoCo:
    """Make the conversions to and from MuJoCo.

    Parameters
    ----------
    robot : Model
        The robot.
    model : mujoco.MjModel, optional
        MuJoCo's model of the robot, whose joint order is used. Default: mozzi's order, with mimic joints.

    Returns
    -------
    bridge
        `configuration(theta)`, `velocity(theta, dtheta)`, `acceleration(theta, dtheta, ddtheta)`, `force(theta, tau)`,
        `mass_matrix(theta, M)`, `bias_forces(theta, dtheta, M, h)` to MuJoCo; `from_configuration(qpos)`,
        `from_velocity(qpos, qvel)`, `from_acceleration(qpos, qvel, qacc)`, `from_force(qpos, qfrc)`,
        `from_mass_matrix(qpos, M)`, `from_bias_forces(qpos, qvel, M, qfrc_bias)` back; M of the bias forces is
        mozzi's in both directions. A mimic joint has its places in MuJoCo's lists: they are filled, forces with 0, and
        on the way back its forces and its inertia are added to the joint that it follows; M and h of such a robot are
        converted from MuJoCo only. Quaternions in `qpos` are normalized, as in MuJoCo.
    """
    if model is None:
        return _MuJoCo(robot, None)
    free = 0  # mjJNT_FREE; of a floating base it is no joint
    names = [cast(str, model.joint(j).name) for j in range(model.njnt)]
    for j in range(model.njnt):
        if names[j] == "":  # named as in `Model.from_mjcf`
            body = model.jnt_bodyid[j]
            is_free = model.jnt_type[j] == free
            generated = f"{model.body(body).name or f'body{body}'}:free" if is_free else f"joint{j}"
            while generated in names:
                generated += "'"
            names[j] = generated
    return _MuJoCo(robot, [names[j] for j in range(model.njnt) if model.jnt_type[j] != free or not robot.is_floating])
