"""The planar arm with two joints (Modern Robotics, section 8.1): hand formulas against the library. See 01_two_link.rs for Lagrange's way."""

import mozzi
import numpy as np

m1, m2, L1, L2, gravity = 2.0, 1.0, 0.5, 0.4, 9.81  # the robot's file says these
arm = mozzi.models.two_link_planar()

theta, dtheta, ddtheta = np.array([0.6, -1.1]), np.array([0.8, 1.5]), np.array([2.0, -1.0])
c1, c2, s2, c12 = np.cos(theta[0]), np.cos(theta[1]), np.sin(theta[1]), np.cos(theta.sum())

# by hand
M12 = m2 * (L1 * L2 * c2 + L2**2)
M = np.array([[m1 * L1**2 + m2 * (L1**2 + 2 * L1 * L2 * c2 + L2**2), M12], [M12, m2 * L2**2]])
k = m2 * L1 * L2 * s2
c = np.array([-k * (2 * dtheta[0] * dtheta[1] + dtheta[1] ** 2), k * dtheta[0] ** 2])
g = np.array([(m1 + m2) * L1 * gravity * c1 + m2 * gravity * L2 * c12, m2 * gravity * L2 * c12])

# by the library
for name, found, expected in [
    ("M", arm.mass_matrix(theta), M),
    ("c", arm.velocity_product(theta, dtheta), c),
    ("g", arm.gravity_forces(theta), g),
    ("τ = Mθ̈ + c + g", arm.inverse_dynamics(theta, dtheta, ddtheta), M @ ddtheta + c + g),
]:
    print(f"{name}, by hand and by the library, differ by {abs(found - expected).max():.1e}\n{found}")
    assert np.allclose(found, expected, rtol=0, atol=1e-13)
