/// \file line_points.h
/// One scan line as structure of arrays, which the passes over all points of a scan can vectorise.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/scan_lines.h>

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// The points of one scan line, in sweep order. Memory is reused from line to line.
struct LinePoints {
  std::vector<float> x, y, z;
  std::vector<float> range;         ///< distance from the sensor, m
  std::vector<float> squared_step;  ///< squared distance to the next point, m^2; 0 for the last

  [[nodiscard]] int size() const { return static_cast<int>(x.size()); }

  void gather(const CloudView& cloud, const ScanLines& lines, std::size_t m);

  /// Computes `range` and `squared_step` from the coordinates.
  void measure();
};

}  // namespace pcl_floam
