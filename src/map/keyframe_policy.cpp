#include <pcl_floam/map/keyframe_policy.h>

namespace pcl_floam {

bool KeyframePolicy::isKeyframe(const SE3& last_keyframe, const SE3& pose) const
{
  const SE3 moved = last_keyframe.inverse() * pose;
  return moved.translation.norm() >= translation || rotationAngle(moved.rotation) >= rotation;
}

}  // namespace pcl_floam
