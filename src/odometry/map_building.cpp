#include "odometry/map_building.h"

#include "common/sweep_trajectory.h"

#include <pcl_floam/filters/core/sweep_motion.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace pcl_floam {

namespace {

SweepMotion motionDuring(const SweepPose& pose)
{
  return SweepMotion(pose.twist, SweepTrajectory::kMiddle, pose.acceleration);
}

void undistort(const std::vector<ScanPoint>& measured, const SweepPose& pose, int threads,
               std::vector<Eigen::Vector3f>& points)
{
  const SweepTrajectory sensor(SE3(), pose.twist, SweepTrajectory::kMiddle, pose.acceleration);
  points.resize(measured.size());
  constexpr std::ptrdiff_t kTogether = 256;
  const auto count = static_cast<std::ptrdiff_t>(points.size());
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::ptrdiff_t begin = 0; begin < count; begin += kTogether) {
    const auto first = static_cast<std::size_t>(begin);
    const auto some = static_cast<std::size_t>(std::min(kTogether, count - begin));
    std::array<Eigen::Vector3d, kTogether> places;
    sensor.undistorted(&measured[first], 1, some, places.data());
    for (std::size_t i = 0; i < some; ++i) {
      points[first + i] = places[i].cast<float>();
    }
  }
}

}  // namespace

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
  compensate(measured, motionDuring(world_T_sensor), undistorted_, threads);
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
      scan.takePoints(cloud, parameters);
      undistort(scan.points, world_T_sensor, parameters.threads, all_undistorted_);
      map_.forgetSeenThrough(all_undistorted_, world_T_sensor.middle, parameters.threads);
    }
    insert(scan.features, world_T_sensor, parameters.threads);
  }
  return is_keyframe;
}

}  // namespace pcl_floam
