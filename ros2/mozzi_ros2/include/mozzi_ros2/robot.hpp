// The robot of a plugin: its model from the node's parameters, and the order of the caller's joints.
#pragma once

#include <Eigen/Core>
#include <mozzi/mozzi.hpp>
#include <rclcpp/node_interfaces/node_parameters_interface.hpp>
#include <string>
#include <vector>

namespace mozzi_ros2 {

/// A robot whose joints have one axis each, with memory for calls of one thread at a time.
///
/// Parameters, in the plugin's namespace:
///
/// | name | type | meaning |
/// |---|---|---|
/// | root, tip | string | only the chain between these links; without `tip`, the whole robot, trees and mimic joints too |
/// | joints | string array | the joints in the order of the caller's vectors; by default that of the robot's file |
/// | locked_joints | string array | joints that do not move, such as a gripper's |
/// | locked_positions | double array | where they stand, rad or m; by default 0 |
/// | gravity | double array | in the root's axes, m/s²; by default (0, 0, -9.81) |
class Robot {
 public:
  using Parameters = rclcpp::node_interfaces::NodeParametersInterface;

  /// Reads a robot from `description`, or, if that is empty, from the node's parameter robot_description.
  ///
  /// Throws std::runtime_error that says what is wrong, with the line of the URDF if it is there.
  Robot(const std::string &description, const Parameters *parameters, const std::string &parameter_namespace);

  Eigen::Index n() const noexcept { return static_cast<Eigen::Index>(order_.size()); }
  const mozzi::Model &model() const noexcept { return workspace_.model(); }
  mozzi::Workspace &workspace() noexcept { return workspace_; }
  /// In the caller's order.
  const std::vector<std::string> &joints() const noexcept { return joints_; }

  /// Joint numbers from the caller's order to mozzi's, and back. Neither allocates if `to` has its size.
  void to_mozzi(const Eigen::VectorXd &from, Eigen::VectorXd &to) const;
  void from_mozzi(const Eigen::VectorXd &from, Eigen::VectorXd &to) const;
  /// The index in mozzi's vectors of the caller's joint k.
  Eigen::Index index(Eigen::Index k) const noexcept { return order_[static_cast<std::size_t>(k)]; }

 private:
  mozzi::Workspace workspace_;
  std::vector<std::string> joints_;
  std::vector<Eigen::Index> order_;
};

}  // namespace mozzi_ros2
