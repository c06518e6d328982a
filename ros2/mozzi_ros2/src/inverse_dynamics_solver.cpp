#include "mozzi_ros2/inverse_dynamics_solver.hpp"

#include <inverse_dynamics_solver/exceptions.h>

#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>

namespace mozzi_ros2 {

void InverseDynamicsSolver::initialize(
    rclcpp::node_interfaces::NodeParametersInterface::ConstSharedPtr parameters_interface,
    const std::string &param_namespace, const std::string &robot_description) {
  try {
    robot_ = std::make_unique<Robot>(robot_description, parameters_interface.get(), param_namespace);
  } catch (const std::runtime_error &error) {
    throw inverse_dynamics_solver::InvalidParameterValueException(error.what());
  }
  const Eigen::Index n = robot_->n();
  for (Eigen::VectorXd *vector : {&theta_, &dtheta_, &ddtheta_, &tau_, &part_}) {
    vector->setZero(n);
  }
  M_.setZero(n, n);
}

Robot &InverseDynamicsSolver::robot() const {
  if (!robot_) {
    throw inverse_dynamics_solver::UninitializedException();
  }
  return *robot_;
}

const Eigen::VectorXd &InverseDynamicsSolver::ordered(const char *name, const Eigen::VectorXd &from,
                                                      Eigen::VectorXd &to) const {
  if (from.size() != robot().n()) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(from.size()) + " entries, expected " +
                                std::to_string(robot().n()));
  }
  robot().to_mozzi(from, to);
  return to;
}

Eigen::VectorXd InverseDynamicsSolver::answer(mozzi::Status status, const Eigen::VectorXd &result) const {
  status.or_throw();
  Eigen::VectorXd in_order(result.size());
  robot().from_mozzi(result, in_order);
  return in_order;
}

Eigen::MatrixXd InverseDynamicsSolver::getInertiaMatrix(const Eigen::VectorXd &joint_positions) const {
  robot().workspace().mass_matrix(ordered("joint_positions", joint_positions, theta_), M_).or_throw();
  Eigen::MatrixXd in_order(M_.rows(), M_.cols());
  for (Eigen::Index i = 0; i < M_.rows(); ++i) {
    for (Eigen::Index j = 0; j < M_.cols(); ++j) {
      in_order(i, j) = M_(robot().index(i), robot().index(j));
    }
  }
  return in_order;
}

Eigen::VectorXd InverseDynamicsSolver::getCoriolisVector(const Eigen::VectorXd &joint_positions,
                                                         const Eigen::VectorXd &joint_velocities) const {
  const auto &theta = ordered("joint_positions", joint_positions, theta_);
  return answer(
      robot().workspace().velocity_product(theta, ordered("joint_velocities", joint_velocities, dtheta_), tau_), tau_);
}

Eigen::VectorXd InverseDynamicsSolver::getGravityVector(const Eigen::VectorXd &joint_positions) const {
  const auto &theta = ordered("joint_positions", joint_positions, theta_);
  robot().workspace().spring_forces(theta, part_).or_throw();
  robot().workspace().gravity_forces(theta, tau_).or_throw();
  tau_ += part_;
  return answer(mozzi::Status(MOZZI_OK), tau_);
}

Eigen::VectorXd InverseDynamicsSolver::getFrictionVector(const Eigen::VectorXd &joint_velocities) const {
  return answer(robot().workspace().joint_friction(ordered("joint_velocities", joint_velocities, dtheta_), tau_), tau_);
}

Eigen::VectorXd InverseDynamicsSolver::getTorques(const Eigen::VectorXd &joint_positions,
                                                  const Eigen::VectorXd &joint_velocities,
                                                  const Eigen::VectorXd &joint_accelerations) const {
  const auto &theta = ordered("joint_positions", joint_positions, theta_);
  const auto &dtheta = ordered("joint_velocities", joint_velocities, dtheta_);
  const auto &ddtheta = ordered("joint_accelerations", joint_accelerations, ddtheta_);
  robot().workspace().joint_friction(dtheta, part_).or_throw();
  robot().workspace().inverse_dynamics(theta, dtheta, ddtheta, tau_).or_throw();
  tau_ -= part_;
  return answer(mozzi::Status(MOZZI_OK), tau_);
}

}  // namespace mozzi_ros2

PLUGINLIB_EXPORT_CLASS(mozzi_ros2::InverseDynamicsSolver, inverse_dynamics_solver::InverseDynamicsSolver)
