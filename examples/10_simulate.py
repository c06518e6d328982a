"""A double pendulum falls, and its energy stays (Modern Robotics, section 8.5)."""

from typing import Any

import mozzi
from numpy.typing import NDArray

pendulum = mozzi.models.double_pendulum()
fall = pendulum.simulate([2.0, 0.5], [0.0, 0.0], 3.0, 3000)
drift = abs(fall.energy - fall.energy[0]).max()
print(f"after {fall.t[-1]} s at θ = {fall.theta[-1].round(4)} rad; the energy moved by {drift:.1e} J")
assert drift < 1e-6

held = pendulum.simulate([2.0, 0.5], [0.0, 0.0], 3.0, 300, torque="gravity_compensation")
print(f"with τ = g(θ) it stays: {held.theta[-1]} rad")
assert abs(held.theta - held.theta[0]).max() < 1e-12


def damped(t: float, theta: NDArray[Any], dtheta: NDArray[Any]) -> NDArray[Any]:
    return pendulum.gravity_forces(theta) - 0.5 * dtheta


rest = pendulum.simulate([2.0, 0.5], [1.0, -1.0], 5.0, 1000, torque=damped)
print(f"with τ = g(θ) − ½θ̇ it comes to rest: θ̇ = {abs(rest.dtheta[-1]).max():.1e} rad/s")
assert abs(rest.dtheta[-1]).max() < 0.02
