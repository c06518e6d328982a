#include "mozzi_ros2/kinematics.hpp"

#include <cmath>
#include <pluginlib/class_list_macros.hpp>
#include <rclcpp/logging.hpp>
#include <rclcpp/parameter.hpp>
#include <stdexcept>

namespace mozzi_ros2 {
namespace {

rclcpp::Logger logger() { return rclcpp::get_logger("mozzi_ros2::Kinematics"); }

}  // namespace

bool Kinematics::failed(const std::string &why) const {
  RCLCPP_ERROR(logger(), "%s", why.c_str());
  return false;
}

bool Kinematics::has_length(const char *name, Eigen::Index found) const {
  return found == robot_->n() || failed(std::string(name) + " has " + std::to_string(found) + " entries, expected " +
                                        std::to_string(robot_->n()));
}

bool Kinematics::initialize(const std::string &robot_description,
                            std::shared_ptr<rclcpp::node_interfaces::NodeParametersInterface> parameters_interface,
                            const std::string &param_namespace) {
  robot_.reset();
  const std::string name = (param_namespace.empty() ? "" : param_namespace + ".") + "alpha";
  rclcpp::Parameter alpha(name, 5e-6);
  if (parameters_interface && parameters_interface->has_parameter(name)) {
    parameters_interface->get_parameter(name, alpha);
  }
  alpha_ = alpha.as_double();
  if (!(alpha_ >= 0)) {
    return failed(name + " is " + std::to_string(alpha_) + ", expected 0 or more");
  }
  try {
    robot_ = std::make_unique<Robot>(robot_description, parameters_interface.get(), param_namespace);
  } catch (const std::runtime_error &error) {
    return failed(error.what());
  }
  theta_.setZero(robot_->n());
  J_b_.setZero(6, robot_->n());
  J_.setZero(6, robot_->n());
  return true;
}

bool Kinematics::pose(const Eigen::VectorXd &joint_pos, const std::string &link_name, mozzi::Frame &frame) {
  if (!robot_) {
    return failed("`initialize` was not called, or failed");
  }
  if (!has_length("joint_pos", joint_pos.size())) {
    return false;
  }
  mozzi_frame number = 0;
  if (mozzi_model_frame(robot_->model().get(), link_name.c_str(), &number) != MOZZI_OK) {
    return failed(mozzi_last_error());
  }
  frame = mozzi::Frame(number);
  robot_->to_mozzi(joint_pos, theta_);
  const mozzi::Status status = robot_->workspace().forward_kinematics(theta_, frame, T_);
  return status.ok() || failed(status.message());
}

bool Kinematics::update(const Eigen::VectorXd &joint_pos, const std::string &link_name) {
  mozzi::Frame frame;
  if (!pose(joint_pos, link_name, frame)) {
    return false;
  }
  const mozzi::Status status = robot_->workspace().body_jacobian(theta_, frame, J_b_);
  if (!status.ok()) {
    return failed(status.message());
  }
  const Eigen::Matrix3d R = T_.topLeftCorner<3, 3>();
  for (Eigen::Index k = 0; k < robot_->n(); ++k) {
    const auto column = J_b_.col(robot_->index(k));  // (ω, v) in the link's axes
    J_.col(k).head<3>().noalias() = R * column.tail<3>();
    J_.col(k).tail<3>().noalias() = R * column.head<3>();
  }
  return true;
}

bool Kinematics::has_damped(const Eigen::VectorXd &joint_pos, const std::string &link_name) {
  if (!update(joint_pos, link_name)) {
    return false;
  }
  Eigen::Matrix<double, 6, 6> sum = J_ * J_.transpose();
  sum.diagonal().array() += alpha_;
  damped_.compute(sum);
  return damped_.info() == Eigen::Success ||
         failed("the Jacobian of `" + link_name + "` does not have full rank, and alpha is 0");
}

bool Kinematics::calculate_link_transform(const Eigen::VectorXd &joint_pos, const std::string &link_name,
                                          Eigen::Isometry3d &transform) {
  mozzi::Frame frame;
  if (!pose(joint_pos, link_name, frame)) {
    return false;
  }
  transform.matrix() = T_;
  return true;
}

bool Kinematics::calculate_jacobian(const Eigen::VectorXd &joint_pos, const std::string &link_name,
                                    Eigen::Matrix<double, 6, Eigen::Dynamic> &jacobian) {
  if (!update(joint_pos, link_name) || !has_length("jacobian's columns", jacobian.cols())) {
    return false;
  }
  jacobian = J_;
  return true;
}

bool Kinematics::calculate_jacobian_inverse(const Eigen::VectorXd &joint_pos, const std::string &link_name,
                                            Eigen::Matrix<double, Eigen::Dynamic, 6> &jacobian_inverse) {
  if (!has_damped(joint_pos, link_name) || !has_length("jacobian_inverse's rows", jacobian_inverse.rows())) {
    return false;
  }
  const Eigen::Matrix<double, 6, 6> inverse = damped_.solve(Eigen::Matrix<double, 6, 6>::Identity());
  jacobian_inverse.noalias() = J_.transpose() * inverse;
  return true;
}

bool Kinematics::convert_cartesian_deltas_to_joint_deltas(const Eigen::VectorXd &joint_pos,
                                                          const Eigen::Matrix<double, 6, 1> &delta_x,
                                                          const std::string &link_name, Eigen::VectorXd &delta_theta) {
  if (!has_damped(joint_pos, link_name) || !has_length("delta_theta", delta_theta.size())) {
    return false;
  }
  const Eigen::Matrix<double, 6, 1> y = damped_.solve(delta_x);
  delta_theta.noalias() = J_.transpose() * y;
  return true;
}

bool Kinematics::convert_joint_deltas_to_cartesian_deltas(const Eigen::VectorXd &joint_pos,
                                                          const Eigen::VectorXd &delta_theta,
                                                          const std::string &link_name,
                                                          Eigen::Matrix<double, 6, 1> &delta_x) {
  if (!update(joint_pos, link_name) || !has_length("delta_theta", delta_theta.size())) {
    return false;
  }
  delta_x.noalias() = J_ * delta_theta;
  return true;
}

bool Kinematics::calculate_frame_difference(Eigen::Matrix<double, 7, 1> &x_a, Eigen::Matrix<double, 7, 1> &x_b,
                                            double dt, Eigen::Matrix<double, 6, 1> &delta_x) {
  if (!(dt > 0) || !std::isfinite(dt)) {
    return failed("dt is " + std::to_string(dt) + " s, expected a positive, finite number");
  }
  Eigen::Quaterniond R[2];
  for (int k = 0; k < 2; ++k) {
    const Eigen::Matrix<double, 7, 1> &x = k == 0 ? x_a : x_b;  // (x, y, z, qx, qy, qz, qw)
    R[k] = Eigen::Quaterniond(x[6], x[3], x[4], x[5]);
    if (!(std::abs(R[k].norm() - 1) < 1e-3)) {
      return failed("the quaternion of x_" + std::string(k == 0 ? "a" : "b") + " has length " +
                    std::to_string(R[k].norm()) + ", expected 1");
    }
    R[k].normalize();
  }
  const Eigen::AngleAxisd turn(R[1] * R[0].conjugate());  // in the axes of the root
  delta_x.head<3>() = (x_b.head<3>() - x_a.head<3>()) / dt;
  delta_x.tail<3>() = turn.angle() / dt * turn.axis();
  return true;
}

}  // namespace mozzi_ros2

PLUGINLIB_EXPORT_CLASS(mozzi_ros2::Kinematics, kinematics_interface::KinematicsInterface)
