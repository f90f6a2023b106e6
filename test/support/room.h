/// \file room.h
/// The furnished room that scans are taken in, as rays see it.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pcl_floam::test {

/// An axis-aligned box: the room around the sensor, or furniture in it. m
struct Box {
  Eigen::Vector3d lowest;
  Eigen::Vector3d highest;
};

/// Distance along a unit ray to a box: to its far side from inside, to its near side from outside.
inline double distanceTo(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray, bool from_inside)
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

/// What the walls of a room and the boxes in it look like to rays.
struct Room {
  Box walls = {{-15.0, -9.0, -1.7}, {25.0, 11.0, 4.0}};
  std::vector<Box> furniture = {{{3.0, 3.0, -1.7}, {5.0, 6.0, 1.0}},
                                {{9.0, -6.0, -1.7}, {10.0, -3.0, 3.0}},
                                {{-6.0, -5.0, -1.7}, {-4.0, -4.0, 2.0}},
                                {{14.0, 4.0, -1.7}, {17.0, 5.0, 0.5}},
                                {{-9.0, 5.0, -1.7}, {-8.0, 7.0, 3.5}}};

  [[nodiscard]] double distance(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const
  {
    double nearest = distanceTo(walls, origin, ray, true);
    for (const Box& box : furniture) {
      nearest = std::min(nearest, distanceTo(box, origin, ray, false));
    }
    return nearest;
  }
};

/// An empty room, so that the only edges are its four vertical ones (the horizontal ones are crossed at an angle by
/// scan lines that are not level).
inline Room emptyRoom()
{
  Room room;
  room.walls = {{-6.0, -4.0, -30.0}, {5.0, 5.0, 30.0}};
  room.furniture.clear();
  return room;
}

/// Distances of a point from the nearest walls: the first is how far off the walls, the second how far off a corner.
inline std::pair<double, double> distancesFromWalls(const Room& room, double x, double y)
{
  const double to_x = std::min(std::abs(x - room.walls.lowest[0]), std::abs(x - room.walls.highest[0]));
  const double to_y = std::min(std::abs(y - room.walls.lowest[1]), std::abs(y - room.walls.highest[1]));
  return {std::min(to_x, to_y), std::max(to_x, to_y)};
}

}  // namespace pcl_floam::test
