/// \file keyframe_policy.h
/// Which scans are added to the map.
#pragma once

#include <pcl_floam/common/se3.h>

#include <functional>

namespace pcl_floam {

/// A scan becomes a keyframe when the sensor has moved by as much since the last one, or has turned so far that what is
/// 5 m away has moved by as much: by default 0.1 rad.
struct KeyframePolicy {
  double translation = 0.5;  ///< m, >= 0; 0 makes every scan a keyframe. Reasonable: 0.1 (indoors) to 2

  [[nodiscard]] bool isKeyframe(const SE3& last_keyframe, const SE3& pose) const
  {
    constexpr double kArm = 5.0;  // m: how far away what is seen typically is, which turns with the sensor
    const SE3 moved = last_keyframe.inverse() * pose;
    return moved.translation.norm() >= translation || kArm * rotationAngle(moved.rotation) >= translation;
  }
};

/// A rule of one's own: whether a scan becomes a keyframe. Both poses are `world_T_sensor`s, up to a common motion.
using KeyframeRule = std::function<bool(const SE3& last_keyframe, const SE3& pose)>;

}  // namespace pcl_floam
