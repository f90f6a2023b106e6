/// \file synthetic_scan.h
/// Sweeps of a moving lidar in a furnished room, by ray casting.
#pragma once

#include "support/constants.h"
#include "support/room.h"

#include <pcl_floam/common/se3.h>

#include <cmath>
#include <functional>
#include <vector>

namespace pcl_floam::test {

/// A rotating lidar.
struct Lidar {
  int rings = 32;
  int columns = 900;
  double lowest = -25.0;  ///< degrees
  double highest = 15.0;
  bool clockwise = true;       ///< seen from above
  double start_azimuth = kPi;  ///< where a sweep begins

  [[nodiscard]] double elevation(int ring) const
  {
    return (lowest + (highest - lowest) * ring / (rings - 1)) * kPi / 180.0;
  }
  [[nodiscard]] double azimuth(int column) const
  {
    const double turned = 2.0 * kPi * (column + 0.5) / columns;
    return clockwise ? start_azimuth - turned : start_azimuth + turned;
  }
  [[nodiscard]] double fraction(int column) const { return static_cast<double>(column) / (columns - 1); }
};

/// One measured point, and what is true about it.
struct Return {
  Eigen::Vector3d point;  ///< in the frame of the sensor at the instant of the measurement
  int ring = 0;           ///< 0 is the lowest
  int column = 0;
  double fraction = 0.0;  ///< of the sweep, 0 for the first column, 1 for the last
};

/// `world_T_sensor` at a fraction of the sweep.
using SweepPath = std::function<SE3(double)>;

/// A sweep in firing order: column by column, from the lowest ring up.
inline std::vector<Return> sweepRoom(const Room& room, const Lidar& lidar, const SweepPath& path)
{
  std::vector<Return> returns;
  returns.reserve(static_cast<std::size_t>(lidar.rings) * static_cast<std::size_t>(lidar.columns));
  for (int column = 0; column < lidar.columns; ++column) {
    const SE3 world_T_sensor = path(lidar.fraction(column));
    const double azimuth = lidar.azimuth(column);
    for (int ring = 0; ring < lidar.rings; ++ring) {
      const double elevation = lidar.elevation(ring);
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const double range = room.distance(world_T_sensor.translation, world_T_sensor.rotation * ray);
      returns.push_back({range * ray, ring, column, lidar.fraction(column)});
    }
  }
  return returns;
}

/// A sweep of a sensor at rest.
inline std::vector<Return> sweepRoom(const Room& room, const Lidar& lidar, const SE3& world_T_sensor = {})
{
  return sweepRoom(room, lidar, [&world_T_sensor](double) { return world_T_sensor; });
}

}  // namespace pcl_floam::test
