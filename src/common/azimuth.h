/// \file azimuth.h
/// Angles about the sensor's vertical axis.
#pragma once

#include <cmath>
#include <initializer_list>

namespace pcl_floam {

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

/// atan2(y, x) in turns, in [0, 1], to 1e-7 of a turn: a division and a polynomial. A sweep without
/// a time field asks for thousands of them.
inline float azimuthInTurns(float x, float y)
{
  const float right = std::abs(x);
  const float up = std::abs(y);
  const float norm = right + up;
  if (norm == 0.0F) {
    return 0.0F;
  }
  // Within a quarter of a turn the angle is an eighth and that of tangent t, since tan(a - pi/4) is
  // (tan(a) - 1) / (tan(a) + 1). The polynomial is its minimax fit, in quarters of a turn.
  const float t = (up - right) / norm;
  const float s = t * t;
  float p = -0.00258120685F;
  for (const float coefficient :
       {0.0139183523F, -0.0355948359F, 0.061384093F, -0.0885450691F, 0.126983777F, -0.212184489F, 0.636619329F}) {
    p = p * s + coefficient;
  }
  const float quarter = 0.5F + t * p;
  const float half = x >= 0.0F ? quarter : 2.0F - quarter;
  return 0.25F * (y >= 0.0F ? half : 4.0F - half);
}

}  // namespace pcl_floam
