// The planar arm with two joints (Modern Robotics, section 8.1): hand formulas against the library.
//
//   M = [[m1L1² + m2(L1² + 2L1L2c2 + L2²), m2(L1L2c2 + L2²)], [m2(L1L2c2 + L2²), m2L2²]]
//   c = (−m2L1L2s2(2θ̇1θ̇2 + θ̇2²), m2L1L2s2θ̇1²)
//   g = ((m1 + m2)L1 g c1 + m2 g L2c12, m2 g L2c12)
#include <mozzi/mozzi.hpp>

#include <array>
#include <cmath>
#include <cstdio>

int main() {
  const double m1 = 2.0, m2 = 1.0, L1 = 0.5, L2 = 0.4, gravity = 9.81;  // the robot's file says these
  const mozzi::Model arm = mozzi::Model::embedded("two_link_planar").value();
  mozzi::Workspace workspace(arm);

  const std::array<double, 2> theta{0.6, -1.1}, dtheta{0.8, 1.5}, ddtheta{2.0, -1.0};
  std::array<double, 2> tau{};
  workspace.inverse_dynamics(theta, dtheta, ddtheta, tau).or_throw();

  const double c1 = std::cos(theta[0]), c2 = std::cos(theta[1]), s2 = std::sin(theta[1]);
  const double c12 = std::cos(theta[0] + theta[1]), M12 = m2 * (L1 * L2 * c2 + L2 * L2);
  const double M11 = m1 * L1 * L1 + m2 * (L1 * L1 + 2 * L1 * L2 * c2 + L2 * L2), M22 = m2 * L2 * L2;
  const double k = m2 * L1 * L2 * s2;
  const double by_hand[2] = {
      M11 * ddtheta[0] + M12 * ddtheta[1] - k * (2 * dtheta[0] * dtheta[1] + dtheta[1] * dtheta[1]) +
          (m1 + m2) * L1 * gravity * c1 + m2 * gravity * L2 * c12,
      M12 * ddtheta[0] + M22 * ddtheta[1] + k * dtheta[0] * dtheta[0] + m2 * gravity * L2 * c12,
  };
  std::printf("tau = %.6f %.6f N m, by hand %.6f %.6f N m\n", tau[0], tau[1], by_hand[0], by_hand[1]);

  std::array<double, 2> back{};
  workspace.forward_dynamics(theta, dtheta, tau, back).or_throw();
  const double error = std::fabs(tau[0] - by_hand[0]) + std::fabs(tau[1] - by_hand[1]) +
                       std::fabs(back[0] - ddtheta[0]) + std::fabs(back[1] - ddtheta[1]);
  return error < 1e-13 ? 0 : 1;
}
