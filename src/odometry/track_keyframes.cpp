#include "odometry/track_keyframes.h"

namespace pcl_floam {

bool becomesKeyframe(const SE3& last_keyframe, const SE3& pose, const TrackSettings& settings)
{
  constexpr double kSides = 0.3;  // of the finest cells: much nearer, a sweep tells the map nothing new
  constexpr double kTurn = 0.1;   // rad
  if (settings.components.is_keyframe) {
    return settings.components.is_keyframe(last_keyframe, pose);
  }
  const SE3 moved = last_keyframe.inverse() * pose;
  return moved.translation.norm() > kSides * settings.side || rotationAngle(moved.rotation) > kTurn;
}

std::vector<bool> keyframesAmong(const std::vector<SweepPose>& poses, const TrackSettings& settings)
{
  std::vector<bool> keyframes;
  SE3 last;
  for (const SweepPose& pose : poses) {
    keyframes.push_back(keyframes.empty() || becomesKeyframe(last, pose.middle, settings));
    last = keyframes.back() ? pose.middle : last;
  }
  return keyframes;
}

}  // namespace pcl_floam
