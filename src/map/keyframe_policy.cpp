#include <pcl_floam/map/core/keyframe_policy.h>

namespace pcl_floam {

bool KeyframePolicy::isKeyframe(const SE3& last_keyframe, const SE3& pose) const
{
  constexpr double kArm = 5.0;  // m: how far away what is seen typically is, which turns with the sensor
  const SE3 moved = last_keyframe.inverse() * pose;
  return moved.translation.norm() >= translation || kArm * rotationAngle(moved.rotation) >= translation;
}

}  // namespace pcl_floam
