#include "odometry/track_map.h"

#include "common/sweep_trajectory.h"
#include "map/voxel_pyramid.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace pcl_floam {

namespace {

constexpr std::size_t kTogether = 256;

/// Calls \p take(points, their places in the map, how many) for some at a time.
template <typename Take>
void placeEach(const std::vector<ScanPoint>& points, const SweepTrajectory& sensor, const Take& take)
{
  std::array<Eigen::Vector3d, kTogether> places;
  for (std::size_t begin = 0; begin < points.size(); begin += kTogether) {
    const std::size_t count = std::min(kTogether, points.size() - begin);
    sensor.undistorted(&points[begin], 1, count,
                       [&](std::size_t i, const Eigen::Vector3d& place) { places[i] = sensor.pose() * place; });
    take(&points[begin], places.data(), count);
  }
}

}  // namespace

std::optional<SpareMaps::Map> SpareMaps::take()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (maps_.empty()) {
    return std::nullopt;
  }
  std::optional<Map> map = std::move(maps_.back());
  maps_.pop_back();
  return map;
}

void SpareMaps::give(Map map)
{
  map.space->clear();
  map.edges.clear();
  const std::lock_guard<std::mutex> lock(mutex_);
  maps_.push_back(std::move(map));
}

TrackMap::TrackMap(const TrackSettings& settings) : horizon_(settings.horizon), spare_(settings.spare_maps)
{
  const std::shared_ptr<SpareMaps> spare = spare_.lock();
  std::optional<SpareMaps::Map> map = spare ? spare->take() : std::nullopt;
  if (map) {
    space_ = std::move(map->space);
    edges_ = std::move(map->edges);
    return;
  }
  const SurfaceMap::ConstPtr& own = settings.components.map;
  space_ = own ? own->makeEmpty(settings.side) : std::make_unique<VoxelPyramid>(settings.side);
}

TrackMap::TrackMap(const TrackMap& other)
    : space_(other.space_->copy()), edges_(other.edges_), horizon_(other.horizon_), spare_(other.spare_)
{
}

TrackMap& TrackMap::operator=(TrackMap other) noexcept
{
  space_.swap(other.space_);
  std::swap(edges_, other.edges_);
  std::swap(horizon_, other.horizon_);
  spare_.swap(other.spare_);
  return *this;
}

TrackMap::~TrackMap()
{
  const std::shared_ptr<SpareMaps> spare = spare_.lock();
  if (space_ && spare) {
    spare->give({std::move(space_), std::move(edges_)});
  }
}

void TrackMap::clear()
{
  space_->clear();
  edges_.clear();
}

void TrackMap::insert(const Sweep& sweep, const SweepPose& pose)
{
  const SweepTrajectory sensor(pose.middle, pose.twist, SweepTrajectory::kMiddle, pose.acceleration);
  placeEach(sweep.dense, sensor, [&](const ScanPoint* points, const Eigen::Vector3d* places, std::size_t count) {
    std::array<std::uint32_t, kTogether> lasers;
    std::transform(points, points + count, lasers.begin(), [](const ScanPoint& point) { return point.laser; });
    space_->insert(places, lasers.data(), count);
  });
  placeEach(sweep.edges, sensor,
            [&](const ScanPoint*, const Eigen::Vector3d* places, std::size_t count) { edges_.insert(places, count); });
  space_->crop(pose.middle.translation, horizon_);
  edges_.crop(pose.middle.translation, horizon_);
}

void TrackMap::insert(const std::vector<Eigen::Vector3d>& space, const std::vector<Eigen::Vector3d>& edges)
{
  std::vector<std::uint32_t> lasers(space.size());
  std::iota(lasers.begin(), lasers.end(), 0U);
  space_->insert(space.data(), lasers.data(), space.size());
  edges_.insert(edges.data(), edges.size());
}

}  // namespace pcl_floam
