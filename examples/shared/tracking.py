"""Two arms, a motion for each, and how well a controller follows it, with and without a load unknown to it."""

from collections.abc import Callable
from typing import NamedTuple

import mozzi
import numpy as np
from mozzi.controllers import Controller, Saturated, tracking_error
from mozzi.modern_robotics import VecToso3
from mozzi.trajectories import Line, Profile, Timed


class Arm(NamedTuple):
    """An arm with a motion to make: a straight line of the joints in 1.2 s, and 0.6 s to settle."""

    name: str
    model: mozzi.Model
    tool: str
    motion: Timed


def both_arms() -> list[Arm]:
    """The UR5, and the Panda with its fingers locked."""
    ur5 = mozzi.models.ur5()
    panda = mozzi.models.panda().with_locked_joints({"panda_finger_joint1": 0.02})
    line = Line(ur5, [0.3, -1.4, 1.6, -0.6, 0.9, 0.5], [1.1, -0.9, 1.0, -0.1, 1.4, -0.3])
    other = Line(panda, [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7], [-0.3, 0.1, 0.5, -1.5, 0.1, 1.4, 0.1])
    profile = Profile.quintic(1.2)
    return [Arm("UR5", ur5, "tool0", Timed(line, profile)), Arm("Panda", panda, "panda_hand", Timed(other, profile))]


def both_loads(arms: list[Arm], name: str, controller: Callable[[Arm], Controller]) -> list[tuple[float, float]]:
    """The largest error of any joint of each arm, without and with 2 kg in its hand, unknown to the controller."""
    print(f"{name}, largest error of any joint, and the largest root of a mean square:")
    errors = []
    for arm in arms:
        worst = []
        for load in (0.0, 2.0):
            robot = arm.model
            if load > 0.0:
                c = VecToso3([0.0, 0.0, 0.05])  # a point, 5 cm in front of the hand
                robot = robot.with_payload(arm.tool, load * np.block([[-c @ c, c], [-c, np.eye(3)]]))
            motors = Saturated(robot, controller(arm))
            start = arm.motion.at(0.0).theta
            followed = robot.simulate(start, np.zeros(robot.n), 1.8, 600, torque=motors)
            found = tracking_error(followed, arm.motion)
            print(f"  {arm.name:6} with {load:g} kg: {found.worst:.2e} rad, {found.worst_rms:.2e} rad")
            worst.append(float(found.worst))
        errors.append((worst[0], worst[1]))
    return errors
