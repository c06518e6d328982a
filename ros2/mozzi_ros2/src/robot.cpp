#include "mozzi_ros2/robot.hpp"

#include <algorithm>
#include <rclcpp/parameter.hpp>
#include <stdexcept>

namespace mozzi_ros2 {
namespace {

using Parameters = Robot::Parameters;

/// A parameter's value, if the node has it.
class Reader {
 public:
  Reader(const Parameters *parameters, const std::string &parameter_namespace)
      : parameters_(parameters), prefix_(parameter_namespace.empty() ? "" : parameter_namespace + ".") {}

  std::string text(const std::string &name) const {
    rclcpp::Parameter parameter;
    return find(prefix_ + name, parameter) ? parameter.as_string() : std::string();
  }
  std::vector<std::string> texts(const std::string &name) const {
    rclcpp::Parameter parameter;
    return find(prefix_ + name, parameter) ? parameter.as_string_array() : std::vector<std::string>();
  }
  std::vector<double> numbers(const std::string &name) const {
    rclcpp::Parameter parameter;
    return find(prefix_ + name, parameter) ? parameter.as_double_array() : std::vector<double>();
  }
  std::string description() const {
    rclcpp::Parameter parameter;
    if (!find("robot_description", parameter)) {
      throw std::runtime_error("the parameter robot_description is not set, expected the robot's URDF");
    }
    return parameter.as_string();
  }
  const std::string &prefix() const { return prefix_; }

 private:
  bool find(const std::string &name, rclcpp::Parameter &parameter) const {
    return parameters_ != nullptr && parameters_->has_parameter(name) && parameters_->get_parameter(name, parameter);
  }

  const Parameters *parameters_;
  std::string prefix_;
};

template <class T>
T taken(mozzi::Result<T> result, const std::string &what) {
  if (!result) {
    throw std::runtime_error(what + ": " + result.message());
  }
  return std::move(result).value();
}

std::string listed(const std::vector<std::string> &names) {
  std::string text;
  for (const std::string &name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

mozzi::Model read(const std::string &description) {
  std::vector<mozzi::Diagnostic> findings;
  mozzi::Result<mozzi::Model> model = mozzi::Model::parse("robot_description", description, {}, &findings);
  if (!model) {
    std::string text = "robot_description is refused";
    for (const mozzi::Diagnostic &finding : findings) {
      text += finding.is_error ? "\n" + finding.text : "";
    }
    throw std::runtime_error(findings.empty() ? text + ": " + model.message() : text);
  }
  return std::move(model).value();
}

mozzi::Model load(const std::string &description, const Reader &reader) {
  mozzi::Model model = read(description.empty() ? reader.description() : description);

  const std::string root = reader.text("root"), tip = reader.text("tip");
  if (!root.empty() && tip.empty()) {
    throw std::runtime_error(reader.prefix() + "root is `" + root + "`, but " + reader.prefix() + "tip is not set");
  }
  if (!tip.empty()) {
    const std::string first = root.empty() ? model.frame_names().front() : root;
    model = taken(model.sub_chain(taken(model.frame(first), reader.prefix() + "root"),
                                  taken(model.frame(tip), reader.prefix() + "tip")),
                  "the chain from `" + first + "` to `" + tip + "`");
  }

  const std::vector<std::string> locked = reader.texts("locked_joints");
  std::vector<double> positions = reader.numbers("locked_positions");
  if (!positions.empty() && positions.size() != locked.size()) {
    throw std::runtime_error(reader.prefix() + "locked_positions has " + std::to_string(positions.size()) +
                             " entries, expected " + std::to_string(locked.size()) + ", one for each of locked_joints");
  }
  positions.resize(locked.size(), 0.0);
  if (!locked.empty()) {
    std::vector<std::pair<std::string, double>> at;
    for (std::size_t k = 0; k < locked.size(); ++k) {
      at.emplace_back(locked[k], positions[k]);
    }
    model = taken(model.with_locked_joints(at), reader.prefix() + "locked_joints");
  }

  const std::vector<double> gravity = reader.numbers("gravity");
  if (!gravity.empty()) {
    if (gravity.size() != 3) {
      throw std::runtime_error(reader.prefix() + "gravity has " + std::to_string(gravity.size()) +
                               " entries, expected 3: x, y, z in m/s²");
    }
    model = taken(model.with_gravity({gravity[0], gravity[1], gravity[2]}), reader.prefix() + "gravity");
  }

  if (model.is_floating() || model.n() != model.joint_count() || model.nq() != model.n()) {
    throw std::runtime_error("the robot has a floating base, a ball or a free joint, expected joints of one axis on a "
                             "fixed base: the interface has one number for each joint");
  }
  return model;
}

}  // namespace

Robot::Robot(const std::string &description, const Parameters *parameters, const std::string &parameter_namespace)
    : workspace_(load(description, Reader(parameters, parameter_namespace))) {
  const Reader reader(parameters, parameter_namespace);
  const std::vector<std::string> names = model().joint_names();
  joints_ = reader.texts("joints");
  if (joints_.empty()) {
    joints_ = names;
  }
  for (const std::string &joint : joints_) {
    const auto place = std::find(names.begin(), names.end(), joint);
    if (place == names.end()) {
      throw std::runtime_error(reader.prefix() + "joints has `" + joint + "`, expected one of " + listed(names));
    }
    const auto index = static_cast<Eigen::Index>(place - names.begin());
    if (std::find(order_.begin(), order_.end(), index) != order_.end()) {
      throw std::runtime_error(reader.prefix() + "joints has `" + joint + "` twice");
    }
    order_.push_back(index);
  }
  for (const std::string &name : names) {
    if (std::find(joints_.begin(), joints_.end(), name) == joints_.end()) {
      throw std::runtime_error("the robot's joint `" + name + "` is not in " + reader.prefix() +
                               "joints: add it there or to " + reader.prefix() + "locked_joints");
    }
  }
}

void Robot::to_mozzi(const Eigen::VectorXd &from, Eigen::VectorXd &to) const {
  for (Eigen::Index k = 0; k < n(); ++k) {
    to[index(k)] = from[k];
  }
}

void Robot::from_mozzi(const Eigen::VectorXd &from, Eigen::VectorXd &to) const {
  for (Eigen::Index k = 0; k < n(); ++k) {
    to[k] = from[index(k)];
  }
}

}  // namespace mozzi_ros2
