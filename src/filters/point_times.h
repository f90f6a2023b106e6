/// \file point_times.h
/// The times of many points of a scan.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/scan_timing.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

inline constexpr std::size_t kTimesAtOnce = 64;

/// \ref ScanTiming::at of points of the cloud, if there are times.
void timesOf(const CloudView& cloud, const ScanTiming& timing, const std::int32_t* index, std::size_t count,
             float* times);

/// Sets the `time` of points by their `index` in the cloud, if there are times.
template <typename Point>
void setTimes(const CloudView& cloud, const ScanTiming& timing, std::vector<Point>& points)
{
  std::array<std::int32_t, kTimesAtOnce> index;
  std::array<float, kTimesAtOnce> times;
  for (std::size_t begin = 0; begin < points.size() && timing.valid(); begin += kTimesAtOnce) {
    const std::size_t count = std::min(kTimesAtOnce, points.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      index[i] = points[begin + i].index;
    }
    timesOf(cloud, timing, index.data(), count, times.data());
    for (std::size_t i = 0; i < count; ++i) {
      points[begin + i].time = times[i];
    }
  }
}

}  // namespace pcl_floam
