/// \file room_scans.h
/// Scans of a furnished room as KITTI's .bin files, for tests that need scans an odometry can track.
#pragma once

#include "support/constants.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace pcl_floam::test {

/// An axis-aligned box: the room around the sensor, or furniture in it. m
struct Box {
  double lowest[3];
  double highest[3];
};

/// Distance along a unit ray to a box: to its far side from inside, to its near side from outside.
inline double distanceTo(const Box& box, const double (&origin)[3], const double (&ray)[3], bool from_inside)
{
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.lowest[axis] - origin[axis]) / ray[axis];
    const double b = (box.highest[axis] - origin[axis]) / ray[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (from_inside) {
    return leave;
  }
  return enter > 0.0 && enter < leave ? enter : std::numeric_limits<double>::infinity();
}

/// One sweep of 32 lasers from the place (x, y, 0), taken in an instant: ring by ring from the top, azimuth rising.
inline std::string roomScan(double x, double y)
{
  const Box room = {{-15.0, -9.0, -1.7}, {25.0, 11.0, 4.0}};
  const std::vector<Box> furniture = {{{3.0, 3.0, -1.7}, {5.0, 6.0, 1.0}},
                                      {{9.0, -6.0, -1.7}, {10.0, -3.0, 3.0}},
                                      {{-6.0, -5.0, -1.7}, {-4.0, -4.0, 2.0}},
                                      {{14.0, 4.0, -1.7}, {17.0, 5.0, 0.5}},
                                      {{-9.0, 5.0, -1.7}, {-8.0, 7.0, 3.5}}};
  constexpr int kRings = 32;
  constexpr int kColumns = 900;
  const double origin[3] = {x, y, 0.0};
  std::string bytes;
  for (int ring = 0; ring < kRings; ++ring) {
    const double elevation = (15.0 - 1.0 * ring) * kPi / 180.0;
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = (column + 0.37) * 2.0 * kPi / kColumns;
      const double ray[3] = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation) + 1e-9};
      double range = distanceTo(room, origin, ray, true);
      for (const Box& box : furniture) {
        range = std::min(range, distanceTo(box, origin, ray, false));
      }
      const float point[4] = {static_cast<float>(range * ray[0]), static_cast<float>(range * ray[1]),
                              static_cast<float>(range * ray[2]), 0.5F};
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
