// mozzi behind kinematics_interface::KinematicsInterface (github.com/ros-controls/kinematics_interface).
#pragma once

#include <Eigen/Cholesky>
#include <kinematics_interface/kinematics_interface.hpp>
#include <memory>
#include <string>

#include "mozzi_ros2/robot.hpp"

namespace mozzi_ros2 {

/// Poses, Jacobians and their damped inverses of every frame of the robot.
///
/// The interface's twists are linear first, at the link's origin, in the axes of the root: the linear and then the
/// angular rows of the body Jacobian, each times R. The parameters are those of `Robot`, and `alpha`, the damping of
/// the inverse (double, 5e-6): J⁺ = Jᵀ(JJᵀ + α1)⁻¹.
///
/// One thread at a time. Calls that succeed do not allocate.
class Kinematics : public kinematics_interface::KinematicsInterface {
 public:
  bool initialize(const std::string &robot_description,
                  std::shared_ptr<rclcpp::node_interfaces::NodeParametersInterface> parameters_interface,
                  const std::string &param_namespace) override;
  bool convert_cartesian_deltas_to_joint_deltas(const Eigen::VectorXd &joint_pos,
                                                const Eigen::Matrix<double, 6, 1> &delta_x,
                                                const std::string &link_name, Eigen::VectorXd &delta_theta) override;
  bool convert_joint_deltas_to_cartesian_deltas(const Eigen::VectorXd &joint_pos, const Eigen::VectorXd &delta_theta,
                                                const std::string &link_name,
                                                Eigen::Matrix<double, 6, 1> &delta_x) override;
  bool calculate_link_transform(const Eigen::VectorXd &joint_pos, const std::string &link_name,
                                Eigen::Isometry3d &transform) override;
  bool calculate_jacobian(const Eigen::VectorXd &joint_pos, const std::string &link_name,
                          Eigen::Matrix<double, 6, Eigen::Dynamic> &jacobian) override;
  bool calculate_jacobian_inverse(const Eigen::VectorXd &joint_pos, const std::string &link_name,
                                  Eigen::Matrix<double, Eigen::Dynamic, 6> &jacobian_inverse) override;
  bool calculate_frame_difference(Eigen::Matrix<double, 7, 1> &x_a, Eigen::Matrix<double, 7, 1> &x_b, double dt,
                                  Eigen::Matrix<double, 6, 1> &delta_x) override;

 private:
  /// The link's pose in T_, and the interface's Jacobian of it in J_.
  bool update(const Eigen::VectorXd &joint_pos, const std::string &link_name);
  /// The same, and the factors of JJᵀ + α1.
  bool has_damped(const Eigen::VectorXd &joint_pos, const std::string &link_name);
  bool pose(const Eigen::VectorXd &joint_pos, const std::string &link_name, mozzi::Frame &frame);
  bool has_length(const char *name, Eigen::Index found) const;
  bool failed(const std::string &why) const;

  std::unique_ptr<Robot> robot_;
  double alpha_ = 0;
  Eigen::VectorXd theta_;
  Eigen::Matrix4d T_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J_b_, J_;
  Eigen::LLT<Eigen::Matrix<double, 6, 6>> damped_;
};

}  // namespace mozzi_ros2
