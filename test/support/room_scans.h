/// \file room_scans.h
/// Scans of a furnished room as KITTI's .bin files, for tests that need scans an odometry can track.
#pragma once

#include "support/constants.h"
#include "support/room.h"

#include <cmath>
#include <string>

namespace pcl_floam::test {

/// One sweep of 32 lasers from the place (x, y, 0), taken in an instant: ring by ring from the top, azimuth rising.
inline std::string roomScan(double x, double y)
{
  const Room room;
  constexpr int kRings = 32;
  constexpr int kColumns = 900;
  const Eigen::Vector3d origin(x, y, 0.0);
  std::string bytes;
  for (int ring = 0; ring < kRings; ++ring) {
    const double elevation = (15.0 - 1.0 * ring) * kPi / 180.0;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = (column + 0.37) * 2.0 * kPi / kColumns;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation) + 1e-9);
      const Eigen::Vector3f place = (room.distance(origin, ray) * ray).cast<float>();
      const float point[4] = {place.x(), place.y(), place.z(), 0.5F};
      bytes.append(reinterpret_cast<const char*>(point), sizeof(point));
    }
  }
  return bytes;
}

/// The same lasers above a floor without end, of which nothing tells of the way along it.
inline std::string floorScan()
{
  constexpr int kRings = 16;
  constexpr int kColumns = 900;
  constexpr double kHeight = 1.7;  // m
  std::string bytes;
  for (int ring = 0; ring < kRings; ++ring) {
    const double range = kHeight / std::tan((3.0 + 1.0 * ring) * kPi / 180.0);
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = (column + 0.37) * 2.0 * kPi / kColumns;
      const float point[4] = {static_cast<float>(range * std::cos(azimuth)),
                              static_cast<float>(range * std::sin(azimuth)), static_cast<float>(-kHeight), 0.5F};
      bytes.append(reinterpret_cast<const char*>(point), sizeof(point));
    }
  }
  return bytes;
}

}  // namespace pcl_floam::test
