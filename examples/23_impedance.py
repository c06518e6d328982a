"""Impedance control (Modern Robotics, section 11.7; Hogan 1985): the tool yields as a spring and a damper would."""

from typing import Any

import mozzi.modern_robotics as mr
import numpy as np
from mozzi.controllers import Impedance
from mozzi.trajectories import Hold, Reference
from numpy.typing import NDArray
from shared.agreement import agree
from shared.tracking import Arm, both_arms, both_loads

K, B = np.array([20.0, 20, 20, 1000, 1000, 1000]), np.array([1.5, 1.5, 1.5, 90, 90, 90])


def impedance(arm: Arm, reference: Reference) -> Impedance:
    return Impedance(arm.model, reference, arm.tool, stiffness=K, damping=B)


arms = both_arms()
for free, loaded in both_loads(arms, "impedance", lambda arm: impedance(arm, arm.motion)):
    assert free < 1e-6 and 1e-3 < loaded < 0.5, "soft under a load"

# against a wall that takes 15 N the tool yields by KX_e = 𝓕
print()
push = np.array([0.0, 0, 0, 0, 0, 15.0])  # what the tool applies to the wall: τ = τ_motors − JᵀF
for arm in arms:
    start, robot = arm.motion.at(0.0).theta, arm.model
    control = impedance(arm, Hold(robot, start))

    def motors(t: float, theta: NDArray[Any], dtheta: NDArray[Any]) -> NDArray[Any]:
        return control(t, theta, dtheta) - robot.tip_forces(theta, applied_wrenches={arm.tool: push})

    held = robot.simulate(start, np.zeros(robot.n), 2.1, 700, torque=motors)
    there, wanted = robot.forward_kinematics(np.stack([held.theta[-1], start]), arm.tool)
    X = mr.se3ToVec(mr.MatrixLog6(np.linalg.inv(there) @ wanted))
    print(f"{arm.name}: pushed back by 15 N, the tool yields by {1e3 * X[5]:.2f} mm along its axis")
    agree("KX_e and 𝓕", K * X, push, 5e-3)
