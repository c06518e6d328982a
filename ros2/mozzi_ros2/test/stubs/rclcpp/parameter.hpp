// What the plugins use of rclcpp::Parameter, to compile them where there is no ROS.
#pragma once
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rclcpp {

class Parameter {
 public:
  Parameter() = default;
  template <class T>
  Parameter(std::string name, T value) : name_(std::move(name)), value_(std::move(value)) {}
  std::string as_string() const { return std::get<std::string>(value_); }
  double as_double() const { return std::get<double>(value_); }
  std::vector<double> as_double_array() const { return std::get<std::vector<double>>(value_); }
  std::vector<std::string> as_string_array() const { return std::get<std::vector<std::string>>(value_); }

 private:
  std::string name_;
  std::variant<std::monostate, double, std::string, std::vector<double>, std::vector<std::string>> value_;
};

}  // namespace rclcpp
