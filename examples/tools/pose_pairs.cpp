#include "pose_pairs.h"

#include <pcl_floam/io/scan_source.h>

#include <algorithm>
#include <fstream>
#include <locale>
#include <sstream>
#include <string>

namespace pcl_floam::tools {

namespace {

/// s; across a longer gap in the ground truth the pose in between is a guess.
constexpr double kLongestGap = 1.0;

SE3 readLidarToCamera(const std::filesystem::path& calibration)
{
  std::ifstream stream(calibration);
  if (!stream) {
    throw FileError(calibration, "cannot be opened");
  }
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("Tr:", 0) != 0) {
      continue;
    }
    std::istringstream numbers(line.substr(3));
    numbers.imbue(std::locale::classic());
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix;
    for (Eigen::Index i = 0; i < matrix.size(); ++i) {
      numbers >> matrix.data()[i];
    }
    if (!numbers) {
      throw FileError(calibration, "the line 'Tr:' has no 12 numbers");
    }
    return {nearestRotation(matrix.leftCols<3>()), matrix.col(3)};
  }
  throw FileError(calibration, "has no line 'Tr:' (lidar to camera)");
}

}  // namespace

void PosePairs::add(const SE3& estimated, const SE3& true_pose)
{
  estimate.push_back(estimated);
  truth.push_back(true_pose);
}

std::optional<SE3> poseAt(const Trajectory& trajectory, double stamp)
{
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& pose, double time) { return pose.stamp < time; });
  if (after == trajectory.end()) {
    return std::nullopt;
  }
  if (after->stamp == stamp) {
    return after->world_T_sensor;
  }
  if (after == trajectory.begin() || after->stamp - std::prev(after)->stamp > kLongestGap) {
    return std::nullopt;
  }
  const StampedPose& before = *std::prev(after);
  const double fraction = (stamp - before.stamp) / (after->stamp - before.stamp);
  const Vector6 motion = log(before.world_T_sensor.inverse() * after->world_T_sensor);
  return before.world_T_sensor * exp(fraction * motion);
}

void requireRisingStamps(const Trajectory& trajectory, const std::filesystem::path& file)
{
  const auto falls = std::adjacent_find(trajectory.begin(), trajectory.end(),
                                        [](const StampedPose& a, const StampedPose& b) { return a.stamp >= b.stamp; });
  if (falls != trajectory.end()) {
    throw FileError(file, "pose " + std::to_string(falls - trajectory.begin() + 2) + ": the time does not rise");
  }
}

void cameraToLidar(const std::filesystem::path& calibration, Trajectory& trajectory)
{
  const SE3 camera_T_lidar = readLidarToCamera(calibration);
  const SE3 lidar_T_camera = camera_T_lidar.inverse();
  for (StampedPose& pose : trajectory) {
    pose.world_T_sensor = lidar_T_camera * pose.world_T_sensor * camera_T_lidar;
  }
}

}  // namespace pcl_floam::tools
