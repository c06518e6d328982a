// What a program with KDL does, with mozzi: a chain of a URDF, and the torques of a motion under a wrench at its tip.
//
//   with KDL                                                   with mozzi
//   kdl_parser::treeFromFile(file, tree)                       Model::load(file)
//   tree.getChain(base, tip, chain)                            model.sub_chain(base, tip)
//   ChainIdSolver_RNE solver(chain, gravity)                   Workspace workspace(chain)
//   solver.CartToJnt(q, qd, qdd, f_ext, torques)               workspace.inverse_dynamics(θ, θ̇, θ̈, τ, environment)
//   ChainDynParam::JntToMass / JntToGravity / JntToCoriolis    mass_matrix / gravity_forces / velocity_product
//   ChainFkSolverPos_recursive::JntToCart                      forward_kinematics
//   ChainJntToJacSolver::JntToJac                              body_jacobian, turned into the base's axes
//
// KDL's f_ext are wrenches (force, torque) that act on the segments, in their frames; mozzi's are (m, f), what the robot
// applies to its environment, in the frames: exchange the halves and change the sign. KDL's Jacobian has linear rows
// first, is of the tip's origin, and in the base's axes. docs/cpp.md has the whole table.
#include <mozzi/mozzi.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  const mozzi::Model robot = mozzi::Model::open("panda").value();
  const mozzi::Frame base = robot.frame("panda_link0").value(), tip = robot.frame("panda_hand").value();
  const mozzi::Model chain = robot.sub_chain(base, tip).value();
  mozzi::Workspace solver(chain);
  const std::size_t n = chain.n();

  const std::vector<double> q(n, 0.3), qd(n, 0.1), qdd(n, -0.2);
  std::vector<double> torques(n);
  // KDL: f_ext at the last segment is Wrench(Vector(0, 0, -20), Vector(0, 0, 1)): force, torque
  const mozzi::Frame hand = chain.end_effector().value();
  mozzi::Environment environment = chain.environment();
  environment.apply(hand, {0, 0, -1, 0, 0, 20});
  solver.inverse_dynamics(q, qd, qdd, torques, environment).or_throw();
  for (std::size_t j = 0; j < n; ++j) {
    std::printf("%-14s %9.4f N m\n", chain.joint_names()[j].c_str(), torques[j]);
  }

  // the same from its parts: M qdd + c + g + friction + JᵀF, F in the hand's frame
  std::vector<double> M(n * n), c(n), g(n), f(n), J(6 * n);
  solver.mass_matrix(q, M).or_throw();
  solver.velocity_product(q, qd, c).or_throw();
  solver.gravity_forces(q, g).or_throw();
  solver.joint_friction(qd, f).or_throw();
  solver.body_jacobian(q, hand, J).or_throw();
  double error = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double tau = c[i] + g[i] + f[i] - J[2 * n + i] + 20 * J[5 * n + i];
    for (std::size_t j = 0; j < n; ++j) {
      tau += M[i * n + j] * qdd[j];
    }
    error = std::fmax(error, std::fabs(tau - torques[i]));
  }
  std::printf("the sum of its parts differs by %.1e N m\n", error);
  return error < 1e-12 ? 0 : 1;
}
