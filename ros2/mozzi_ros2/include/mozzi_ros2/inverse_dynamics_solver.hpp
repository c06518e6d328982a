// mozzi behind inverse_dynamics_solver::InverseDynamicsSolver (github.com/unisa-acg/inverse-dynamics-solver).
#pragma once

#include <inverse_dynamics_solver/inverse_dynamics_solver.h>

#include <memory>
#include <string>

#include "mozzi_ros2/robot.hpp"

namespace mozzi_ros2 {

/// M, Cq̇, g and friction of trees and chains, mimic joints included. The parameters are those of `Robot`.
///
/// * Gravity forces include the springs of the joints: what holds the robot still.
/// * Torques are M q̈ + C q̇ + g, without friction, as the interface defines them; the friction vector is that of the
///   URDF's `<dynamics>`, damping and Coulomb.
///
/// One thread at a time. Results are allocated, since the interface returns them; nothing else is.
class InverseDynamicsSolver : public inverse_dynamics_solver::InverseDynamicsSolver {
 public:
  void initialize(rclcpp::node_interfaces::NodeParametersInterface::ConstSharedPtr parameters_interface,
                  const std::string &param_namespace, const std::string &robot_description) override;
  Eigen::MatrixXd getInertiaMatrix(const Eigen::VectorXd &joint_positions) const override;
  Eigen::VectorXd getCoriolisVector(const Eigen::VectorXd &joint_positions,
                                    const Eigen::VectorXd &joint_velocities) const override;
  Eigen::VectorXd getGravityVector(const Eigen::VectorXd &joint_positions) const override;
  Eigen::VectorXd getFrictionVector(const Eigen::VectorXd &joint_velocities) const override;
  Eigen::VectorXd getTorques(const Eigen::VectorXd &joint_positions, const Eigen::VectorXd &joint_velocities,
                             const Eigen::VectorXd &joint_accelerations) const override;

 private:
  /// In mozzi's order, after a check of the length.
  const Eigen::VectorXd &ordered(const char *name, const Eigen::VectorXd &from, Eigen::VectorXd &to) const;
  Eigen::VectorXd answer(mozzi::Status status, const Eigen::VectorXd &result) const;
  Robot &robot() const;

  std::unique_ptr<Robot> robot_;
  mutable Eigen::VectorXd theta_, dtheta_, ddtheta_, tau_, part_;
  mutable Eigen::MatrixXd M_;
};

}  // namespace mozzi_ros2
