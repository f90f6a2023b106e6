/// \file neighbor_moments.h
/// Mean and axes of the neighbours of a place.
#pragma once

#include "common/point_moments.h"

#include <pcl_floam/map/core/neighbor_search.h>

namespace pcl_floam {

/// Relative to the place.
inline PointMoments momentsOf(const Neighbors& neighbors)
{
  PointMoments moments;
  for (int i = 0; i < neighbors.count; ++i) {
    moments.add(neighbors[i].offset.cast<double>());
  }
  return moments;
}

}  // namespace pcl_floam
