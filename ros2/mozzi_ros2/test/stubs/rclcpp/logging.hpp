// Errors go to standard error.
#pragma once
#include <cstdio>
#include <string>

namespace rclcpp {
struct Logger {
  std::string name;
};
inline Logger get_logger(const std::string &name) { return {name}; }
}  // namespace rclcpp

#define RCLCPP_ERROR(logger, ...)                       \
  do {                                                  \
    std::fprintf(stderr, "[%s] ", (logger).name.c_str()); \
    std::fprintf(stderr, __VA_ARGS__);                  \
    std::fprintf(stderr, "\n");                         \
  } while (false)
