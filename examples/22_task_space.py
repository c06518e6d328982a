"""Task-space control (Modern Robotics, section 11.4.3): the tool's error obeys 𝒱̇_e + K_d 𝒱_e + K_p X_e = 0."""

from mozzi.controllers import TaskSpace
from shared.tracking import both_arms, both_loads

# the Panda's seventh joint keeps its posture in the null space of the task
errors = both_loads(
    both_arms(),
    "task space",
    lambda arm: TaskSpace(arm.model, arm.motion, arm.tool, p=400.0, d=40.0, posture_p=100.0, posture_d=20.0),
)
for free, loaded in errors:
    assert free < 1e-6 and 1e-3 < loaded < 0.3, "exact of the robot as modelled"
