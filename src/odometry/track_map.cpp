#include "odometry/track_map.h"

#include "registration/sweep_points.h"

#include <cstdint>
#include <vector>

namespace pcl_floam {

namespace {

void insertInto(VoxelPyramid& map, const std::vector<ScanPoint>& points, const MovingSensor& sensor)
{
  std::vector<Eigen::Vector3d> places;
  std::vector<std::uint32_t> lasers;
  places.reserve(points.size());
  lasers.reserve(points.size());
  for (const ScanPoint& point : points) {
    places.push_back(sensor.at(point));
    lasers.push_back(point.laser);
  }
  map.beginKeyframe();
  map.insert(places.data(), lasers.data(), places.size());
}

}  // namespace

TrackMap::TrackMap(double side, double given_horizon)
    : space(side), edges(side, SurfaceShapes::lines), horizon(given_horizon)
{
}

void TrackMap::insert(const Sweep& sweep, const SweepPose& pose)
{
  const MovingSensor sensor(pose.middle, pose.twist, pose.acceleration);
  insertInto(space, sweep.dense, sensor);
  insertInto(edges, sweep.edges, sensor);
  space.crop(pose.middle.translation, horizon);
  edges.crop(pose.middle.translation, horizon);
}

}  // namespace pcl_floam
