"""Computed torque (Modern Robotics, section 11.4.3): τ = M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇)."""

from mozzi.controllers import ComputedTorque
from shared.tracking import both_arms, both_loads

omega = 20.0  # critically damped: K_p = ω², K_d = 2ω
errors = both_loads(
    both_arms(),
    "computed torque",
    lambda arm: ComputedTorque(arm.model, arm.motion, p=omega**2, d=2 * omega),
)
for free, loaded in errors:
    assert free < 1e-6 and 1e-3 < loaded < 0.3, "exact of the robot as modelled"
