/// \file constant_motion.h
/// Estimates of constant motions.
#pragma once

#include "motion/motion_estimate.h"

namespace pcl_floam {

inline double poseDistance(const SE3& a, const SE3& b)
{
  return log(a.inverse() * b).norm();
}

/// An estimate that has seen so many poses of a constant velocity.
inline MotionEstimate afterSteps(const Vector6& velocity, int steps)
{
  constexpr double kExact = 1e-10;  // m^2, rad^2
  MotionEstimate motion(SE3(), Vector6::Zero());
  for (int i = 1; i <= steps; ++i) {
    motion.predict(1.0);
    motion.correct(exp(i * velocity), kExact * Matrix6(Matrix6::Identity()));
  }
  return motion;
}

}  // namespace pcl_floam
