/// \file track_keyframes.h
/// Which sweeps enter the map that a track registers with.
#pragma once

#include "motion/sweep_pose.h"
#include "odometry/track_settings.h"

#include <pcl_floam/common/se3.h>

#include <vector>

namespace pcl_floam {

[[nodiscard]] bool becomesKeyframe(const SE3& last_keyframe, const SE3& pose, const TrackSettings& settings);

/// Those of some poses, in the order of time, at which a map takes in the sweeps.
[[nodiscard]] std::vector<bool> keyframesAmong(const std::vector<SweepPose>& poses, const TrackSettings& settings);

}  // namespace pcl_floam
