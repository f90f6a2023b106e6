/// \file pi.h
/// The circle constant.
#pragma once

namespace pcl_floam {

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace pcl_floam
