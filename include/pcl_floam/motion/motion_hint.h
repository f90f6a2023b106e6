/// \file motion_hint.h
/// What others than the lidar tell of the sensor's motion: wheels, an IMU, another estimator.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// The motion from one scan to the next.
struct MotionHint {
  /// The sensor's pose at a scan, seen from where it was at the scan before: both in the middle of the sweep.
  SE3 last_T_now;
  /// Of that pose's errors: translation in m, then rotation in rad, both in the sensor's axes. Symmetric and positive
  /// definite; large where nothing is told (wheels: height, roll and pitch; a gyroscope: all translation).
  Matrix6 covariance = Matrix6::Identity();

  /// The motion back.
  [[nodiscard]] MotionHint inverse() const;

  /// \throws std::invalid_argument if it is not finite or its covariance is not as above.
  void validate() const;
};

/// One motion after the other.
[[nodiscard]] MotionHint operator*(const MotionHint& first, const MotionHint& second);

}  // namespace pcl_floam
