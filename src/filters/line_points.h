/// \file line_points.h
/// One scan line as structure of arrays, which the smoothness pass can vectorise.
#pragma once

#include <pcl_floam/common/cloud_view.h>
#include <pcl_floam/filters/scan_lines.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// The points of one scan line, in sweep order. Memory is reused from line to line.
struct LinePoints {
  std::vector<float> x, y, z;
  std::vector<float> range;         ///< distance from the sensor, m
  std::vector<float> squared_step;  ///< squared distance to the next point, m^2; 0 for the last

  [[nodiscard]] int size() const { return static_cast<int>(x.size()); }

  void gather(const CloudView& cloud, const ScanLines& lines, std::size_t m)
  {
    const auto first = static_cast<std::size_t>(lines.begin[m]);
    const auto count = static_cast<std::size_t>(lines.begin[m + 1]) - first;
    x.resize(count);
    y.resize(count);
    z.resize(count);
    range.resize(count);
    squared_step.assign(count, 0.0F);
    for (std::size_t n = 0; n < count; ++n) {
      const auto i = static_cast<std::size_t>(lines.index[first + n]);
      x[n] = cloud.x(i);
      y[n] = cloud.y(i);
      z[n] = cloud.z(i);
    }
    for (std::size_t n = 0; n < count; ++n) {
      range[n] = std::sqrt(x[n] * x[n] + y[n] * y[n] + z[n] * z[n]);
    }
    for (std::size_t n = 0; n + 1 < count; ++n) {
      const float dx = x[n + 1] - x[n];
      const float dy = y[n + 1] - y[n];
      const float dz = z[n + 1] - z[n];
      squared_step[n] = dx * dx + dy * dy + dz * dz;
    }
  }
};

}  // namespace pcl_floam
