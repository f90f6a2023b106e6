/// \file feature_rooms.h
/// Rooms whose corners and walls are known.
#pragma once

#include "support/synthetic_cloud.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam::test {

/// An empty room, so that the only edges are its four vertical ones (the horizontal ones are crossed at an angle by
/// scan lines that are not level).
inline Room emptyRoom()
{
  Room room;
  room.walls = {{-6.0, -4.0, -30.0}, {5.0, 5.0, 30.0}};
  room.furniture.clear();
  return room;
}

inline pcl::PointCloud<PointXYZIRT>::Ptr scanOf(const Room& room)
{
  return pcl::make_shared<pcl::PointCloud<PointXYZIRT>>(toCloud(sweepRoom(room, Lidar())));
}

/// Distances of a point from the nearest walls: the first is how far off the walls, the second how far off a corner.
inline std::pair<double, double> distancesFromWalls(const Room& room, double x, double y)
{
  const double to_x = std::min(std::abs(x - room.walls.lowest[0]), std::abs(x - room.walls.highest[0]));
  const double to_y = std::min(std::abs(y - room.walls.lowest[1]), std::abs(y - room.walls.highest[1]));
  return {std::min(to_x, to_y), std::max(to_x, to_y)};
}

}  // namespace pcl_floam::test
