"""What mass does a tool show (Modern Robotics, section 8.6)? 𝓕 = Λ𝒱̇ + η, and τ = Jᵀ(Λa + η) gives the acceleration a."""

import mozzi
import numpy as np

ur5 = mozzi.models.ur5()
theta, dtheta = np.array([0.3, -1.2, 1.4, -0.5, 0.9, 2.0]), np.array([0.5, -0.3, 0.8, 1.1, -0.6, 0.4])

# from 𝒱 = Jθ̇: Λ = J⁻ᵀMJ⁻¹ and η = J⁻ᵀh − ΛJ̇θ̇
Lambda, eta = ur5.task_space_dynamics(theta, dtheta)
J, dJ = ur5.body_jacobian(theta), ur5.body_jacobian_rate(theta, dtheta)
J_inverse = np.linalg.inv(J)
assert np.allclose(Lambda, J_inverse.T @ ur5.mass_matrix(theta) @ J_inverse, rtol=0, atol=1e-10)
assert np.allclose(eta, J_inverse.T @ ur5.bias_forces(theta, dtheta) - Lambda @ dJ @ dtheta, rtol=0, atol=1e-10)

# a computed force: the tool is to accelerate by a
a = np.array([0.5, -1.0, 0.2, 0.3, 0.8, -0.6])
ddtheta = ur5.forward_dynamics(theta, dtheta, J.T @ (Lambda @ a + eta))
print("𝒱̇ asked for ", a, "\n𝒱̇ found     ", (J @ ddtheta + dJ @ dtheta).round(12))
assert np.allclose(J @ ddtheta + dJ @ dtheta, a, rtol=0, atol=1e-10)

# the mass that the tool's origin shows along each direction, with the tool free to turn: rows v alone
Lambda_v, _ = ur5.task_space_dynamics(theta, dtheta, rows=[3, 4, 5])
masses, directions = np.linalg.eigh(Lambda_v)
print("the tool feels like", masses.round(2), "kg along the columns of\n", directions.round(2))
assert masses[0] > 0

try:  # stretched out it cannot be moved in every direction
    ur5.task_space_dynamics(np.zeros(6), np.zeros(6))
except mozzi.SingularError as error:
    print("at θ = 0:", error)
else:
    raise AssertionError("the UR5 is singular at θ = 0")
