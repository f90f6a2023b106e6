/// \file text_format.h
/// printf into a string.
#pragma once

#include <string>

namespace pcl_floam::tools {

[[nodiscard]] std::string formatted(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace pcl_floam::tools
