/// \file line_neighborhood.h
/// How many neighbours in a scan line tell of the surface at a point.
#pragma once

#include "filters/line_points.h"

#include <vector>

namespace pcl_floam {

/// The neighbours that the smoothness of a line's points is computed from (the set S of Eq. 1).
struct LineNeighborhood {
  int each_side = 5;
  /// The points are far and unevenly apart, as where most returns are missing.
  bool is_sparse = false;
  float spacing = 0.0F;  ///< median angle between neighbours, seen from the sensor, rad
};

/// Sparse lines have fewer neighbours: those asked for would be spread over tens of degrees, where no surface is even.
/// \param wanted on each side
/// \param scratch memory to use
[[nodiscard]] LineNeighborhood neighborhoodIn(const LinePoints& line, int wanted, std::vector<float>& scratch);

}  // namespace pcl_floam
