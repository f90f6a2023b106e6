#include "odometry/track_map.h"

#include "registration/sweep_points.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

namespace {

void insertInto(VoxelPyramid& map, const std::vector<ScanPoint>& points, const MovingSensor& sensor)
{
  constexpr std::size_t kTogether = 256;
  std::array<Eigen::Vector3d, kTogether> places;
  std::array<std::uint32_t, kTogether> lasers;
  map.beginKeyframe();
  for (std::size_t begin = 0; begin < points.size(); begin += kTogether) {
    const std::size_t count = std::min(kTogether, points.size() - begin);
    sensor.undistorted(&points[begin], 1, count, places.data());
    for (std::size_t i = 0; i < count; ++i) {
      places[i] = sensor.pose() * places[i];
      lasers[i] = points[begin + i].laser;
    }
    map.insert(places.data(), lasers.data(), count);
  }
}

}  // namespace

TrackMap::TrackMap(double side, double given_horizon)
    : space(side), edges(side, SurfaceShapes::lines), horizon(given_horizon)
{
}

void TrackMap::clear()
{
  space.clear();
  edges.clear();
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
