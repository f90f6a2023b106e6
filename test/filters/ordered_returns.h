// The returns of one sweep in the orders in which clouds have them.
#pragma once

#include "support/constants.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/scan_lines.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace pcl_floam::test {

inline Lidar smallLidar()
{
  Lidar lidar;
  lidar.rings = 16;
  lidar.columns = 360;
  return lidar;
}

inline double azimuthOf(const Return& r)
{
  return std::fmod(std::atan2(r.point.y(), r.point.x()) + 2.0 * kPi, 2.0 * kPi);
}

inline std::vector<Return> firingOrder()
{
  return sweepRoom(Room(), smallLidar());
}

/// As in KITTI's files: the top ring first, azimuth rising from the front.
inline std::vector<Return> kittiOrder()
{
  std::vector<Return> returns = firingOrder();
  std::sort(returns.begin(), returns.end(), [](const Return& a, const Return& b) {
    return a.ring != b.ring ? a.ring > b.ring : azimuthOf(a) < azimuthOf(b);
  });
  return returns;
}

/// Row by row, the top ring first, each in firing order.
inline std::vector<Return> rowOrder()
{
  std::vector<Return> returns = firingOrder();
  std::stable_sort(returns.begin(), returns.end(), [](const Return& a, const Return& b) { return a.ring > b.ring; });
  return returns;
}

inline std::vector<Return> shuffled()
{
  std::vector<Return> returns = firingOrder();
  std::mt19937 random(1);
  for (std::size_t i = returns.size() - 1; i > 0; --i) {
    std::swap(returns[i], returns[random() % (i + 1)]);
  }
  return returns;
}

inline SensorModel sensorOf(const Lidar& lidar)
{
  std::vector<float> elevations;
  for (int ring = 0; ring < lidar.rings; ++ring) {
    elevations.push_back(static_cast<float>(lidar.elevation(ring) * 180.0 / kPi));
  }
  return customSensor("test", elevations);
}

inline ScanLines find(const CloudView& cloud, ScanLineSource source = ScanLineSource::automatic,
                      const SensorModel& sensor = {}, int threads = 1)
{
  ScanLines lines;
  findScanLines(cloud, sensor, source, lines, threads);
  return lines;
}

/// Every point is on exactly one line, with all the others of its ring, in the order of the sweep.
inline void expectTrueLines(const ScanLines& lines, const std::vector<Return>& returns)
{
  ASSERT_TRUE(lines.valid()) << toString(lines.failure);
  EXPECT_GT(lines.confidence, 0.95F);
  EXPECT_EQ(std::set<std::int32_t>(lines.index.begin(), lines.index.end()).size(), returns.size());
  ASSERT_EQ(lines.index.size(), returns.size());
  std::set<int> rings;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    std::size_t breaks = 0;
    const auto at = [&](std::int32_t n) {
      return returns[static_cast<std::size_t>(lines.index[static_cast<std::size_t>(n)])];
    };
    for (std::int32_t n = lines.begin[m]; n < lines.begin[m + 1]; ++n) {
      ASSERT_EQ(at(n).ring, at(lines.begin[m]).ring) << "line " << m;
      if (n > lines.begin[m]) {
        breaks += std::abs(at(n).column - at(n - 1).column) == 1 ? 0 : 1;
      }
    }
    EXPECT_LE(breaks, 1U) << "line " << m;  // the seam of the sweep may lie within the line
    if (lines.begin[m] < lines.begin[m + 1]) {
      EXPECT_TRUE(rings.insert(at(lines.begin[m]).ring).second) << "two lines for one ring";
    }
  }
  EXPECT_EQ(rings.size(), 16U);
}

}  // namespace pcl_floam::test
