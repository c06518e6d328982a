"""Trajectories (Modern Robotics, chapter 9): where, and when. See the Rust twin."""

import mozzi
import numpy as np
from mozzi.trajectories import Cartesian, Line, Profile, Spline, Timed, poses_between

# the fastest swing of a pendulum: ½Iθ̇² = τθ + mgl(cos θ − 1), up to where it meets
# ½Iθ̇² = τ(θ₁ − θ) + mgl(cos θ − cos θ₁)
m, length, tau, end = 1.5, 0.6, 12.0, 2.5
bob, G = np.eye(4), np.zeros((6, 6))
bob[2, 3], G[3:, 3:] = -length, m * np.eye(3)
robot = mozzi.Model.from_screws([bob, np.eye(4)], [G], np.array([[0.0, 1, 0, 0, 0, 0]]).T)
swing = Line(robot, [0.0], [end]).time_optimal(torque=tau, intervals=500)
x = (np.arange(20_000) + 0.5) * np.pi / 20_000  # θ = θ₁ sin²(x/2) takes the roots at both ends away
theta = end * np.sin(x / 2) ** 2
rise = tau * theta + m * 9.81 * length * (np.cos(theta) - 1)
fall = tau * (end - theta) + m * 9.81 * length * (np.cos(theta) - np.cos(end))
T = np.sum(0.5 * end * np.sin(x) / np.sqrt(2 * np.minimum(rise, fall) / (m * length**2))) * np.pi / 20_000
print(f"pendulum to {end} rad by at most {tau:g} N m: {swing.duration:.5f} s, by its energy {T:.5f} s")
assert abs(swing.duration / T - 1) < 2e-3

ur5 = mozzi.models.ur5()
points = [
    [0.0, -1.5, 1.5, 0.0, 0.5, 0.0],
    [0.5, -1.0, 0.8, 0.5, 1.0, 0.7],
    [1.5, -1.2, 1.0, -0.4, 0.2, 1.0],
    [1.0, -0.6, 0.4, 0.0, 0.0, 0.0],
]
spline = Spline(ur5, points)
print(f"\nUR5 through {len(points)} points, within its velocities and torques and 15 rad/s²:")
fastest = spline.time_optimal(acceleration=15.0, intervals=300)
print(f"  as fast as can be   {fastest.duration:.4f} s")
for name, shape in {
    "trapezoidal": Profile.trapezoidal_in(1.0, 0.25),
    "cubic": Profile.cubic(1.0),
    "quintic": Profile.quintic(1.0),
}.items():
    profile = spline.stretched(shape, acceleration=15.0)
    print(f"  {name:19} {profile.duration:.4f} s")
    assert profile.duration > fastest.duration
now = Timed(spline, fastest).at(np.linspace(0, fastest.duration, 601))
used = np.array(
    [
        (abs(now.dtheta) / ur5.velocity_limits).max(),
        (abs(now.ddtheta) / 15.0).max(),
        (abs(ur5.inverse_dynamics(*now)) / ur5.effort_limits).max(),
    ]
)
print(f"  the fastest uses {(100 * used).round(1).tolist()} % of velocity, acceleration and torque")
assert (used < 1.02).all() and (used > 0.98).any()

# the tool along a straight line
start = [0.0, -1.2, 1.5, 0.3, 1.1, 0.0]
goal = ur5.forward_kinematics(start)
goal[:3, 3] += [-0.1, 0.3, -0.1]
line = Cartesian(ur5, start, goal, shape="straight")
print(f"\nits tool along a line of 0.33 m: {line.knots} solutions, {line.deviation:.1e} off it between them")
s = np.linspace(0, 1, 50)
straight = poses_between(ur5.forward_kinematics(start), goal, s, shape="straight")
assert np.allclose(ur5.forward_kinematics(line.at(s).theta), straight, rtol=0, atol=2e-6)
profile = line.time_optimal(acceleration=15.0, intervals=300)
print(f"  as fast as can be   {profile.duration:.4f} s")
