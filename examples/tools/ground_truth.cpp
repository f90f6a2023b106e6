#include "ground_truth.h"

#include <algorithm>
#include <string>

namespace pcl_floam::tools {

GroundTruth::GroundTruth(const std::filesystem::path& file, const std::filesystem::path& calibration,
                         const ScanSource& scans)
    : poses_(scans.size())
{
  Trajectory trajectory = readTrajectory(file);
  if (!calibration.empty()) {
    cameraToLidar(calibration, trajectory);
  }
  if (trajectory.size() == scans.size()) {
    std::transform(trajectory.begin(), trajectory.end(), poses_.begin(),
                   [](const StampedPose& pose) { return pose.world_T_sensor; });
    return;
  }
  if (trajectoryFormat(file) != TrajectoryFormat::tum || !scans.stamp(0)) {
    throw FileError(file, "has " + std::to_string(trajectory.size()) + " poses for " + std::to_string(scans.size()) +
                              " scans, and not both have times to tell which belongs to which");
  }
  requireRisingStamps(trajectory, file);
  std::size_t found = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    try {
      poses_[i] = poseAt(trajectory, scans.stamp(i).value());
    } catch (const FileError&) {
      // A recording is damaged here: the run will tell.
    }
    found += poses_[i] ? 1 : 0;
  }
  if (found == 0) {
    throw FileError(file, "has no pose within the time of the scans");
  }
}

}  // namespace pcl_floam::tools
