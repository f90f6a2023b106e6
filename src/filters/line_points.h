/// \file line_points.h
/// One scan line as structure of arrays, which the passes over all points of a scan can vectorise, and how many
/// neighbours in it tell of the surface at a point.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/scan_lines.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// The points of one scan line, in sweep order. Memory is reused from line to line.
struct LinePoints {
  std::vector<float> x, y, z;
  std::vector<float> range;         ///< distance from the sensor, m
  std::vector<float> squared_step;  ///< squared distance to the next point, m^2; 0 for the last

  [[nodiscard]] int size() const { return static_cast<int>(x.size()); }
  [[nodiscard]] Eigen::Vector3f at(int n) const
  {
    const auto k = static_cast<std::size_t>(n);
    return {x[k], y[k], z[k]};
  }

  void gather(const CloudView& cloud, const ScanLines& lines, std::size_t m);

  /// Computes `range` and `squared_step` from the coordinates.
  void measure();
};

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
