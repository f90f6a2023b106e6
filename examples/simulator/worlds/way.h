/// \file way.h
/// A way that is given, and the room it leaves for what stands beside it.
#pragma once

#include "../drive.h"
#include "../world.h"

#include <vector>

namespace pcl_floam::simulator {

/// The sensor's motion along a trajectory, and the ground below it.
struct Way {
  PathLine line;  ///< on the ground below the sensor
  MotionSpline motion;
  Terrain terrain;
  std::vector<Eigen::Vector2d> places;  ///< m, of the line, closely spaced
  HeightRaster raster;
};

/// Where there is no trajectory: how one is drawn.
struct DrawnWay {
  double speed;  ///< m/s
  double leg;    ///< m between bends
  double bend;   ///< rad, greatest change of direction
  double climb;  ///< m, standard deviation of the height
  double reach;  ///< m, to each side that there is ground
};

/// Height of KITTI's lidar over the road, m.
constexpr double kLidarHeight = 1.73;

/// The way that the options tell of. Other paths than the first keep to another part of the lane.
/// \param section ditches and banks beside it; none if empty
[[nodiscard]] Way makeWay(const WorldOptions& options, const DrawnWay& drawn, Random& random,
                          const CrossSection& section = {});

/// Whether a place keeps clear of all of the way.
[[nodiscard]] bool isClear(const Way& way, const Eigen::Vector2d& place, double distance);

/// Adds the ground within reach of the way.
void addGroundAlong(TriangleMesh& mesh, const Way& way, double reflectivity);

/// A pose on the ground beside the way; see \ref besideRoad.
[[nodiscard]] SE3 besideWay(const Way& way, double station, double left, double turn = 0.0);

}  // namespace pcl_floam::simulator
