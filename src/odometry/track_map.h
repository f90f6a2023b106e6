/// \file track_map.h
/// What a track registers with.
#pragma once

#include "map/voxel_pyramid.h"
#include "motion/sweep_pose.h"
#include "odometry/sweep.h"

namespace pcl_floam {

/// Space (all points) and edges (the paper's features), as pyramids of voxels.
struct TrackMap {
  /// \param side    m, of the finest cells
  /// \param horizon m: what lies farther from the sensor is forgotten
  TrackMap(double side, double horizon);

  void insert(const Sweep& sweep, const SweepPose& pose);

  /// As it began, but for its memory, which is used again.
  void clear();

  VoxelPyramid space;
  VoxelPyramid edges;
  double horizon;
};

}  // namespace pcl_floam
