#include "ground_truth.h"

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

bool isAnyWithin(const Trajectory& trajectory, const ScanSource& scans)
{
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::optional<double> stamp = stampOf(scans, i);
    if (stamp && poseAt(trajectory, *stamp)) {
      return true;
    }
  }
  return false;
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
  const bool have_times = trajectoryFormat(file) == TrajectoryFormat::tum && stampOf(scans, 0);
  if (have_times) {
    requireRisingStamps(trajectory_, file);
    is_by_time_ = isAnyWithin(trajectory_, scans);
  }
  const std::size_t readable = scansBeforeTheCut(scans);
  if (!is_by_time_ && trajectory_.size() != readable && trajectory_.size() != scans.size()) {
    throw FileError(file, have_times
                              ? "has no pose within the time of the scans"
                              : "has " + std::to_string(trajectory_.size()) + " poses for " + std::to_string(readable) +
                                    " scans, and not both have times to tell which belongs to which");
  }
}

std::optional<SE3> GroundTruth::pose(std::size_t scan, double time) const
{
  if (is_by_time_) {
    return poseAt(trajectory_, time);
  }
  return scan < trajectory_.size() ? std::optional<SE3>(trajectory_[scan].world_T_sensor) : std::nullopt;
}

}  // namespace pcl_floam::tools
