"""The stacked closed form of a UR5 (Modern Robotics, section 8.4): the same mass matrix by 𝒜, 𝒢 and ℒ."""

import mozzi
import numpy as np

ur5 = mozzi.models.ur5()
theta, dtheta = [0.1, -1.2, 1.5, 0.3, 1.1, 0.0], [0.5, 0.2, -0.4, 1.0, 0.3, -0.8]
form = ur5.closed_form(theta, dtheta)

M = form.A.T @ form.L.T @ form.G @ form.L @ form.A
with np.printoptions(precision=4, suppress=True):
    print("𝒲, where link i hangs on link i − 1:\n", (abs(form.W[::6, ::6]) > 0).astype(int))
    print("M = 𝒜ᵀℒᵀ𝒢ℒ𝒜:\n", M)
assert np.allclose(M, ur5.mass_matrix(theta), rtol=0, atol=1e-12)
assert np.allclose(form.c + form.g, ur5.bias_forces(theta, dtheta), rtol=0, atol=1e-12)
assert np.allclose(np.linalg.matrix_power(form.W, 6), 0, atol=1e-12)  # nilpotent: the chain ends
