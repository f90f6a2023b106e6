/// \file first_motion.h
/// How the sensor may have moved between the first two sweeps.
#pragma once

#include "odometry/track.h"

#include <vector>

namespace pcl_floam {

/// Velocities per period, the likeliest first, that registrations of two thinned sweeps lead to: from rest, along the
/// direction that this leaves open, and as it is told. Nothing if the sweeps do not fit at all.
/// \param side m, of the finest cells of a track's map
[[nodiscard]] std::vector<Vector6> likelyFirstMotions(const Sweep& first, const Sweep& second,
                                                      const TrackSettings& settings, double side);

}  // namespace pcl_floam
