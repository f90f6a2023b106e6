/// \file first_motion.h
/// How the sensor may have moved between the first two sweeps.
#pragma once

#include "odometry/track.h"

#include <vector>

namespace pcl_floam {

/// m a period: 40 m/s at ten sweeps a second.
inline constexpr double kFastestMotion = 4.0;

struct FirstMotions {
  std::vector<Vector6> likely;  ///< velocities per period, the likeliest first; none if the sweeps do not fit at all
  Eigen::Vector3d open = Eigen::Vector3d::Zero();  ///< the direction of which they tell least, in the sensor's axes
};

/// Those that registrations of two thinned sweeps lead to: from rest, along the direction that this leaves open, and as
/// it is told.
[[nodiscard]] FirstMotions likelyFirstMotions(const Sweep& first, const Sweep& second, const TrackSettings& settings);

}  // namespace pcl_floam
