#pragma once
#include <type_traits>

#define PLUGINLIB_EXPORT_CLASS(Class, Interface)                                     \
  static_assert(std::is_base_of_v<Interface, Class>, "a plugin is of its interface"); \
  static_assert(std::is_default_constructible_v<Class>, "pluginlib constructs it");
