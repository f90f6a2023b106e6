/// \file sweep_pose.h
/// Where the sensor was during a sweep.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// A sweep's place in the world.
struct SweepPose {
  SE3 middle;                              ///< world_T_sensor at mid-sweep
  Vector6 twist = Vector6::Zero();         ///< motion during the sweep
  Vector6 acceleration = Vector6::Zero();  ///< change of the twist over the sweep

  /// At another fraction of the sweep.
  [[nodiscard]] SE3 at(double fraction) const;
};

/// Seen from elsewhere.
[[nodiscard]] SweepPose operator*(const SE3& target_T_source, const SweepPose& pose);

}  // namespace pcl_floam
