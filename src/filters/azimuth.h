/// \file azimuth.h
/// Angles about the sensor's vertical axis.
#pragma once

#include <cmath>

namespace pcl_floam {

constexpr double kTwoPi = 6.283185307179586;

/// A monotonic stand-in for atan2(y, x) in [0, 4): one division instead of a transcendental function.
/// 0 at the front (+x), 1 at the left (+y), 2 at the rear, 3 at the right.
inline float pseudoAzimuth(float x, float y)
{
  const float norm = std::abs(x) + std::abs(y);
  if (norm == 0.0F) {
    return 0.0F;
  }
  const float s = y / norm;
  const float rising = x >= 0.0F ? s : 2.0F - s;
  return rising >= 0.0F ? rising : rising + 4.0F;
}

}  // namespace pcl_floam
