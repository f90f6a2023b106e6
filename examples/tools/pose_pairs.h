/// \file pose_pairs.h
/// Which true pose belongs to which estimated one.
#pragma once

#include <pcl_floam/io/trajectory.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace pcl_floam::tools {

/// Estimated and true poses of the same instants, in the same order.
struct PosePairs {
  std::vector<SE3> estimate;
  std::vector<SE3> truth;

  [[nodiscard]] std::size_t size() const { return estimate.size(); }
  void add(const SE3& estimated, const SE3& true_pose);
};

/// The pose at an instant, interpolated between the two around it.
/// \param trajectory in rising order of time
/// \return nothing outside the trajectory, or in a gap of more than a second
[[nodiscard]] std::optional<SE3> poseAt(const Trajectory& trajectory, double stamp);

/// \throws FileError if the stamps do not rise; \p file is for the message.
void requireRisingStamps(const Trajectory& trajectory, const std::filesystem::path& file);

/// Turns a camera's poses, as in the ground truth of KITTI's odometry benchmark, into the lidar's.
/// \param calibration KITTI's calib.txt, with the line `Tr:` (lidar to camera)
/// \throws FileError if the file cannot be read or has no such line.
void cameraToLidar(const std::filesystem::path& calibration, Trajectory& trajectory);

}  // namespace pcl_floam::tools
