/// \file repeated_points.h
/// Points of a cloud that are others again.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>

#include <utility>
#include <vector>

namespace pcl_floam {

/// Leaves each place once: repeated, as by second returns that are the first again, it would stand for all the others.
/// \param[in,out] numbers of points of the cloud; the first one of each place stays
/// \return those that went, each with the one that stays
std::vector<std::pair<int, int>> dropRepeated(const CloudView& cloud, std::vector<int>& numbers);

}  // namespace pcl_floam
