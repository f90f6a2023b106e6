#include "ground_truth.h"

#include <algorithm>
#include <string>

namespace pcl_floam::tools {

namespace {

/// Nothing where a recording is damaged: the run will tell.
std::optional<double> stampOf(const ScanSource& scans, std::size_t i)
{
  try {
    return scans.stamp(i);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

struct ScansByTime {
  std::size_t stamped = 0;
  std::size_t within = 0;  ///< the time of the truth
};

ScansByTime scansWithin(const Trajectory& trajectory, const ScanSource& scans)
{
  ScansByTime found;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::optional<double> stamp = stampOf(scans, i);
    found.stamped += stamp ? 1 : 0;
    found.within += stamp && poseAt(trajectory, *stamp) ? 1 : 0;
  }
  return found;
}

bool rises(const Trajectory& trajectory)
{
  return std::adjacent_find(trajectory.begin(), trajectory.end(), [](const StampedPose& a, const StampedPose& b) {
           return !(a.stamp < b.stamp);
         }) == trajectory.end();
}

/// Where a recording is cut off, a scan is counted that there need not be.
std::size_t scansBeforeTheCut(const ScanSource& scans)
{
  const bool are_files = scans.format() == ScanFormat::pcd || scans.format() == ScanFormat::kitti_bin;
  std::size_t count = scans.size();
  while (!are_files && count > 0 && !stampOf(scans, count - 1)) {
    --count;
  }
  return count;
}

}  // namespace

GroundTruth::GroundTruth(const std::filesystem::path& file, const std::filesystem::path& calibration,
                         const ScanSource& scans)
    : trajectory_(readTrajectory(file))
{
  if (!calibration.empty()) {
    cameraToLidar(calibration, trajectory_);
  }
  const std::size_t readable = scansBeforeTheCut(scans);
  const bool is_one_each = trajectory_.size() == readable || trajectory_.size() == scans.size();
  const bool is_tum = trajectoryFormat(file) == TrajectoryFormat::tum;
  const ScansByTime by_time = is_tum && rises(trajectory_) ? scansWithin(trajectory_, scans) : ScansByTime();
  is_by_time_ = by_time.within > 0 && (!is_one_each || 2 * by_time.within >= by_time.stamped);
  if (is_by_time_ || is_one_each) {
    return;
  }
  if (is_tum) {
    requireRisingStamps(trajectory_, file);
  }
  throw FileError(file, by_time.stamped > 0
                            ? "has no pose within the time of the scans"
                            : "has " + std::to_string(trajectory_.size()) + " poses for " + std::to_string(readable) +
                                  " scans, and not both have times to tell which belongs to which");
}

std::optional<SE3> GroundTruth::pose(std::size_t scan, double time) const
{
  if (is_by_time_) {
    return poseAt(trajectory_, time);
  }
  return scan < trajectory_.size() ? std::optional<SE3>(trajectory_[scan].world_T_sensor) : std::nullopt;
}

}  // namespace pcl_floam::tools
