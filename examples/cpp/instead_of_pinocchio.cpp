// What a program with Pinocchio does, with mozzi, on a robot with a floating base, with Eigen.
//
//   with Pinocchio                                             with mozzi
//   urdf::buildModel(file, JointModelFreeFlyer(), model)       Model::load(file, options) with options.floating
//   Data data(model)                                           Workspace workspace(model)
//   rnea(model, data, q, v, a)         → data.tau              workspace.inverse_dynamics(θ, θ̇, θ̈, τ)
//   aba(model, data, q, v, tau)        → data.ddq              workspace.forward_dynamics(θ, θ̇, τ, θ̈)
//   crba(model, data, q)               → data.M, upper half    workspace.mass_matrix(θ, M), whole
//   nonLinearEffects, computeGeneralizedGravity                bias_forces, gravity_forces
//   computeRNEADerivatives, computeABADerivatives              inverse_dynamics_derivatives, forward_…
//   framesForwardKinematics, getFrameJacobian                  frame_poses, body_jacobian, space_jacobian
//
// A floating base: Pinocchio's q is (p, quaternion x y z w, joints), v is (v, ω, joints); mozzi's θ is (quaternion w x y
// z, p, joints), θ̇ is (ω, v, joints). The functions below translate. docs/cpp.md has the whole table.
#include <mozzi/mozzi.hpp>

#include <Eigen/Core>
#include <Eigen/Cholesky>

#include <cstdio>

namespace {

// Pinocchio's q as mozzi's θ
Eigen::VectorXd theta_of(const Eigen::VectorXd &q) {
  Eigen::VectorXd theta = q;
  theta.head<7>() << q[6], q[3], q[4], q[5], q[0], q[1], q[2];
  return theta;
}

// Pinocchio's v, a or tau as mozzi's, and back: (linear, angular) to (angular, linear)
Eigen::VectorXd exchanged(const Eigen::VectorXd &v) {
  Eigen::VectorXd list = v;
  list.head<6>() << v[3], v[4], v[5], v[0], v[1], v[2];
  return list;
}

}  // namespace

int main() {
  mozzi::LoadOptions options;
  options.floating = true;
  const mozzi::Model model = mozzi::Model::open("anymal", options).value();
  mozzi::Workspace workspace(model);
  const auto n = static_cast<Eigen::Index>(model.n()), nq = static_cast<Eigen::Index>(model.nq());

  Eigen::VectorXd q = Eigen::VectorXd::Constant(nq, 0.2), v = Eigen::VectorXd::Constant(n, 0.1);
  q.segment<4>(3).normalize();
  const Eigen::VectorXd a = Eigen::VectorXd::LinSpaced(n, -1, 1);

  const Eigen::VectorXd theta = theta_of(q), dtheta = exchanged(v), ddtheta = exchanged(a);
  Eigen::VectorXd tau(n), bias(n), friction(n), back(n);
  Eigen::MatrixXd M(n, n);
  workspace.inverse_dynamics(theta, dtheta, ddtheta, tau).or_throw();
  workspace.forward_dynamics(theta, dtheta, tau, back).or_throw();
  workspace.mass_matrix(theta, M).or_throw();
  workspace.bias_forces(theta, dtheta, bias).or_throw();
  workspace.joint_friction(dtheta, friction).or_throw();

  const Eigen::VectorXd pinocchio_tau = exchanged(tau);  // the force on the base first
  std::printf("force on the base %.3f %.3f %.3f N\n", pinocchio_tau[0], pinocchio_tau[1], pinocchio_tau[2]);
  const double round_trip = (back - ddtheta).cwiseAbs().maxCoeff();
  const double sum = (M * ddtheta + bias + friction - tau).cwiseAbs().maxCoeff();
  const double solved = (M.llt().solve(tau - bias - friction) - ddtheta).cwiseAbs().maxCoeff();
  std::printf("aba(rnea(a)) - a: %.1e; M a + h - tau: %.1e; by Cholesky: %.1e\n", round_trip, sum, solved);
  return round_trip < 1e-8 && sum < 1e-9 && solved < 1e-8 ? 0 : 1;
}
