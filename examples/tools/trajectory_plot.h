/// \file trajectory_plot.h
/// A trajectory as a picture: top view, height, error.
#pragma once

#include "pose_pairs.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_floam::tools {

struct TrajectoryPlot {
  std::string title;
  std::vector<SE3> estimate;
  PosePairs pairs;  ///< with ground truth, brought to the estimate by SE(3) alignment when drawn; may be empty
  std::vector<Eigen::Vector3d> map_points;  ///< drawn beneath the path; may be empty
};

/// The gnuplot script that draws a picture; its ending, .svg or .png, names the format.
[[nodiscard]] std::string plotScript(const TrajectoryPlot& plot, const std::filesystem::path& image);

/// Draws the picture with gnuplot.
/// \return empty, or in one line why it could not be drawn
[[nodiscard]] std::string drawTrajectory(const TrajectoryPlot& plot, const std::filesystem::path& image);

}  // namespace pcl_floam::tools
