#include "odometry/map_building.h"

#include "common/sweep_trajectory.h"
#include "filters/point_times.h"

#include <array>
#include <cstddef>
#include <utility>

namespace pcl_floam {

void MapBuilding::clear()
{
  map_.clear();
  keyframes_ = 0;
}

void MapBuilding::begin(KeyframeVoxelMap map, MapUse use, const SE3& world_T_sensor)
{
  map_ = std::move(map);
  prior_ = use;
  world_T_keyframe_ = world_T_sensor;
}

/// Some returns at a time: a list of all, with what else is known of them, would be some megabytes.
void MapBuilding::undistort(const ScanReturns& measured, const SweepPose& world_T_sensor)
{
  const SweepTrajectory sensor(SE3(), world_T_sensor.twist, SweepTrajectory::kMiddle, world_T_sensor.acceleration);
  all_undistorted_.clear();
  std::array<ScanPoint, ReturnBatch::kMost> points;
  std::array<float, ReturnBatch::kMost> times;
  times.fill(ScanPoint().time);
  ReturnReader reader(measured);
  for (ReturnBatch batch; reader.next(batch);) {
    timesOf(measured.cloud, measured.timing, batch.index.data(), batch.count, times.data());
    for (std::size_t n = 0; n < batch.count; ++n) {
      points[n] = batch.point(n);
      points[n].time = times[n];
    }
    sensor.undistorted(points.data(), 1, batch.count, [this](std::size_t, const Eigen::Vector3d& place) {
      all_undistorted_.push_back(place.cast<float>());
    });
  }
}

bool MapBuilding::takes(const SE3& world_T_sensor, const KeyframePolicy& policy) const
{
  if (!prior_ && keyframes_ == 0) {
    return true;
  }
  return prior_ != MapUse::frozen &&
         (rule_ ? rule_(world_T_keyframe_, world_T_sensor) : policy.isKeyframe(world_T_keyframe_, world_T_sensor));
}

void MapBuilding::insert(const FeatureSet& measured, const SweepPose& world_T_sensor, int threads)
{
  compensate(measured, world_T_sensor.motion(), undistorted_, threads);
  map_.insert(undistorted_, world_T_sensor.middle, threads);
  world_T_keyframe_ = world_T_sensor.middle;
  ++keyframes_;
}

bool MapBuilding::add(const FeatureSet& measured, const SweepPose& world_T_sensor, const OdometryParameters& parameters)
{
  const bool is_keyframe = takes(world_T_sensor.middle, parameters.keyframe);
  if (is_keyframe) {
    insert(measured, world_T_sensor, parameters.threads);
  }
  return is_keyframe;
}

/// Cars and people leave the places where earlier scans saw them. All of a scan's points tell of that, so it is looked
/// at only now and then.
bool MapBuilding::add(const CloudView& cloud, PreparedScan& scan, const SweepPose& world_T_sensor,
                      const OdometryParameters& parameters)
{
  constexpr int kKeyframesBetween = 7;
  const bool is_keyframe = takes(world_T_sensor.middle, parameters.keyframe);
  if (is_keyframe) {
    if (map_.getParameters().see_through_range > 0.0 && keyframes_ % kKeyframesBetween == kKeyframesBetween - 1) {
      undistort(scan.returnsOf(cloud, parameters), world_T_sensor);
      map_.forgetSeenThrough(all_undistorted_, world_T_sensor.middle, parameters.threads);
    }
    insert(scan.features, world_T_sensor, parameters.threads);
  }
  return is_keyframe;
}

}  // namespace pcl_floam
