/// \file sweep_model.h
/// How the registration lets the sensor move during the sweep that it registers.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// The sensor's motion during the sweep. The default is a sensor that stands still.
struct SweepModel {
  /// Motion from the sweep's start to its end, seen from the sensor: log(T(0)^-1 T(1)). The sweep is undistorted with
  /// it and moves as one (the paper).
  Vector6 twist = Vector6::Zero();
  double reference = 1.0;  ///< the instant of the pose, as a fraction of the sweep; [0, 1]

  /// The twist follows from the pose instead, since an earlier pose is held (LOAM):
  /// twist = sweep_per_motion * log(held_pose^-1 * pose).
  bool follows_pose = false;
  SE3 held_pose;
  double sweep_per_motion = 0.0;
};

}  // namespace pcl_floam
