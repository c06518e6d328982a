"""PD control with gravity compensation (Modern Robotics, section 11.4.2): τ = g(θ) + K_p e + K_d ė lags, and sags."""

from mozzi.controllers import PdGravity
from shared.tracking import both_arms, both_loads

# stiff at the base, soft at the wrist, where the inertia is small
p, d = [600.0, 600.0, 400.0, 300.0, 30.0, 30.0, 10.0], [20.0, 20.0, 15.0, 10.0, 0.6, 0.6, 0.2]

errors = both_loads(
    both_arms(),
    "pd gravity",
    lambda arm: PdGravity(arm.model, arm.motion, p=p[: arm.model.n], d=d[: arm.model.n]),
)
for free, loaded in errors:
    assert 1e-3 < free < 0.3 and loaded < 0.3, "it lags, and follows all the same"
