"""Forward dynamics by inverse dynamics (Modern Robotics, section 8.5): n + 1 calls by hand, which are one call on many states."""

import mozzi
import numpy as np

ur5, random = mozzi.models.ur5(), np.random.default_rng(5)
theta, dtheta, tau, tip_wrench = (random.uniform(-1, 1, 6) for _ in range(4))  # F = (m, f), by the tool on the environment

# h(θ, θ̇) + JᵀF is the torque of θ̈ = 0; column i of M that of θ̈ = e_i where nothing moves, pulls or is touched
h = ur5.inverse_dynamics(theta, dtheta, np.zeros(6), tip_wrench)
M = ur5.inverse_dynamics(theta, np.zeros(6), np.eye(6), gravity=[0, 0, 0]).T
assert np.allclose(M, ur5.mass_matrix(theta), rtol=0, atol=1e-13)

by_hand = np.linalg.solve(M, tau - h)  # O(n³)
found = ur5.forward_dynamics(theta, dtheta, tau, tip_wrench)  # articulated bodies, O(n)
print("θ̈ by hand             ", by_hand)
print("θ̈ by forward_dynamics ", found)
assert np.allclose(found, by_hand, rtol=1e-11, atol=0)
assert np.allclose(ur5.inverse_dynamics(theta, dtheta, found, tip_wrench), tau, rtol=0, atol=1e-12)
