/// \file point_times.h
/// The times of many points of a scan.
#pragma once

#include "common/field_type.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/scan_timing.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

inline constexpr std::size_t kTimesAtOnce = 64;

/// \ref ScanTiming::at of up to so many points, by azimuth.
void timesByAzimuth(const CloudView& cloud, const ScanTiming& timing, const std::int32_t* index, std::size_t count,
                    float* times);

/// Sets the `time` of points by their `index` in the cloud, if there are times: in loops for each source of them.
template <typename Point>
void setTimes(const CloudView& cloud, const ScanTiming& timing, std::vector<Point>& points)
{
  if (timing.source == ScanTimingSource::time_field) {
    withReader(cloud.time, [&](const auto& time_of) {
      for (Point& point : points) {
        point.time = timing.fractionOf(time_of(cloud.point(static_cast<std::size_t>(point.index))));
      }
    });
  } else if (timing.source == ScanTimingSource::azimuth) {
    std::array<std::int32_t, kTimesAtOnce> index;
    std::array<float, kTimesAtOnce> times;
    for (std::size_t begin = 0; begin < points.size(); begin += kTimesAtOnce) {
      const std::size_t count = std::min(kTimesAtOnce, points.size() - begin);
      for (std::size_t i = 0; i < count; ++i) {
        index[i] = points[begin + i].index;
      }
      timesByAzimuth(cloud, timing, index.data(), count, times.data());
      for (std::size_t i = 0; i < count; ++i) {
        points[begin + i].time = times[i];
      }
    }
  } else if (timing.valid()) {
    for (Point& point : points) {
      point.time = timing.at(cloud, static_cast<std::size_t>(point.index));
    }
  }
}

}  // namespace pcl_floam
