"""The book's lists, in and out: a UR5 from M, G and S (Modern Robotics, section 8.3), and by one changed import."""

import mozzi
import mozzi.modern_robotics as mr
import numpy as np

ur5 = mozzi.models.ur5()
lists = ur5.screws()
M, G, S = [*lists.M_relative, np.eye(4)], lists.G, lists.S
again = mozzi.Model.from_screws(M, G, S)

theta, dtheta, ddtheta = np.array([0.1, -1.2, 1.5, 0.3, 1.1, 0.0]), np.full(6, 0.2), np.full(6, 0.5)
tau = ur5.inverse_dynamics(theta, dtheta, ddtheta)
print("τ from the file:            ", tau.round(4))
print("from its lists:             ", again.inverse_dynamics(theta, dtheta, ddtheta).round(4))
book = mr.InverseDynamics(theta, dtheta, ddtheta, [0, 0, -9.81], np.zeros(6), M, G, S)
print("by the book's own functions:", book.round(4))
assert np.allclose(tau, again.inverse_dynamics(theta, dtheta, ddtheta)) and np.allclose(tau, book)
