/// \file backward_pass.h
/// Where the first sweeps were, as the later ones tell.
#pragma once

#include "odometry/track.h"

#include <vector>

namespace pcl_floam {

/// The first poses of a track are those of a young map; the last ones are better, and time may be followed backwards
/// from them.
/// \param kept     four sweeps or more: the last four are where they were found
/// \param forwards poses of the sweeps as they were found
/// \return poses seen from the first one; nothing if a sweep cannot be registered
[[nodiscard]] std::vector<SE3> posesFoundBackwards(const std::vector<Sweep>& kept, const std::vector<SE3>& forwards,
                                                   const TrackSettings& settings);

}  // namespace pcl_floam
