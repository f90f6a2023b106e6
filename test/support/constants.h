/// \file constants.h
/// Numbers that many tests need.
#pragma once

#include <limits>

namespace pcl_floam::test {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace pcl_floam::test
