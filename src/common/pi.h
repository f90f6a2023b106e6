/// \file pi.h
/// The circle constant, and a whole turn.
#pragma once

namespace pcl_floam {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2.0 * kPi;

}  // namespace pcl_floam
