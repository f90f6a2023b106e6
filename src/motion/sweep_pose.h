/// \file sweep_pose.h
/// Where the sensor was during a sweep.
#pragma once

#include <pcl_floam/filters/core/sweep_motion.h>

namespace pcl_floam {

/// A sweep's place in the world.
struct SweepPose {
  SE3 middle;                              ///< world_T_sensor at mid-sweep
  Vector6 twist = Vector6::Zero();         ///< motion during the sweep
  Vector6 acceleration = Vector6::Zero();  ///< change of the twist over the sweep

  /// At another fraction of the sweep.
  [[nodiscard]] SE3 at(double fraction) const { return middle * motion().at(fraction); }

  [[nodiscard]] SweepMotion motion() const { return SweepMotion(twist, 0.5, acceleration); }
};

/// Seen from elsewhere.
[[nodiscard]] inline SweepPose operator*(const SE3& target_T_source, const SweepPose& pose)
{
  return {target_T_source * pose.middle, pose.twist, pose.acceleration};
}

}  // namespace pcl_floam
