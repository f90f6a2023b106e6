/// \file trajectory_file.h
/// Real motion: trajectories as KITTI's odometry benchmark publishes them.
#pragma once

#include "motion_spline.h"

#include <string>
#include <vector>

namespace pcl_floam::simulator {

/// A part of a trajectory, and where to find it.
struct TrajectoryPart {
  std::string file;       ///< KITTI rows of camera poses, 10 a second: x right, y down, z forward
  double from = 0.0;      ///< m along it where the part begins
  double length = 800.0;  ///< m; less if the trajectory ends before
};

/// Reads a part of a trajectory as a body's states 0.1 s apart: x forward, y left, z up, begun at the origin and
/// looking along x, but for pitch and roll.
/// \throws std::invalid_argument if the file cannot be read, or holds no such part
[[nodiscard]] std::vector<BodyState> readTrajectoryPart(const TrajectoryPart& part);

}  // namespace pcl_floam::simulator
