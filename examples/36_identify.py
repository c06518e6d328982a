"""A UR5 that is not what its file says: excite, measure, identify, and check what was never fitted."""

from typing import Any

import mozzi
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
file = mozzi.models.ur5()  # what the file says
random = np.random.default_rng(1763)

# the robot that we have: a forgotten tool of 1.2 kg, friction, noisy sensors
robot = file.with_payload("tool0", 1.2)
viscous, coulomb = np.array([8.0, 8.0, 5.0, 1.0, 1.0, 0.8]), np.array([6.0, 6.0, 4.0, 1.0, 1.0, 0.8])


def measured(theta: Array, dtheta: Array, ddtheta: Array) -> Array:
    """τ = M(θ)θ̈ + h + d θ̇ + μ sgn θ̇, with noise of 0.1 N m."""
    friction = viscous * dtheta + coulomb * np.tanh(dtheta / 0.05)
    tau: Array = robot.inverse_dynamics(theta, dtheta, ddtheta) + friction + 0.1 * random.normal(size=dtheta.shape)
    return tau


# a motion that tells most, within limits, and the confidence that it will give
motion = mozzi.excite(file, 8.0, harmonics=3, velocity=1.0, acceleration=3.0)
print(f"condition number {motion.condition:.0f}; of a random motion {motion.condition_of_random:.0f}")
tau = measured(motion.theta, motion.dtheta, motion.ddtheta)
log = {"t": motion.t, "theta": motion.theta, "dtheta": motion.dtheta, "tau": tau}

found = mozzi.identify(file, log, torque="link", cutoff=8.0)
left_out = found.report["left_out"]
print("errors on blocks that were left out, N m")
print("  as the file says", np.round(left_out["robot"], 2))
print("  identified      ", np.round(left_out["consistent"], 2))
assert left_out["nrms"] < 0.1

# held out: another motion, which the fit has never seen
t = np.linspace(0.0, 6.0, 600)
w, phase = random.uniform(0.5, 1.5, 6), random.uniform(0, 6, 6)
theta, dtheta, ddtheta = (np.sin(w * t[:, None] + phase + k * np.pi / 2) * w**k for k in range(3))
clean = robot.inverse_dynamics(theta, dtheta, ddtheta)
error = [np.sqrt(np.mean((model.inverse_dynamics(theta, dtheta, ddtheta) - clean) ** 2, 0)) for model in (file, robot)]
free = found.model.inverse_dynamics(theta, dtheta, ddtheta) - found.model.joint_friction(dtheta)
of_found = np.sqrt(np.mean((free - clean) ** 2, 0))
print("another motion, without friction: file", np.round(error[0], 2), "identified", np.round(of_found, 2))
assert of_found.sum() < 0.3 * error[0].sum()

# or trust the file, and weigh what it carries
weighed = mozzi.identify(file, log, only="payload", payload="tool0", cutoff=8.0)
print(f"the tool weighs {weighed.parameters['payload.m']:.3f} kg")
assert abs(weighed.parameters["payload.m"] - 1.2) < 0.05
