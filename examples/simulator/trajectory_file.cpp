#include "trajectory_file.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

/// A camera's pose as that of a body that looks the same way.
SE3 bodyPose(const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>& camera)
{
  Eigen::Matrix3d body_R_camera;
  body_R_camera << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return {body_R_camera * camera.leftCols<3>() * body_R_camera.transpose(), body_R_camera * camera.col(3)};
}

std::vector<SE3> readPoses(const std::string& file)
{
  std::ifstream stream(file);
  if (!stream) {
    throw std::invalid_argument(file + ": cannot be read");
  }
  std::vector<SE3> poses;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> row;
  while (stream >> row.data()[0]) {
    for (Eigen::Index i = 1; i < 12; ++i) {
      stream >> row.data()[i];
    }
    if (!stream) {
      throw std::invalid_argument(file + ": a row is not of twelve numbers");
    }
    poses.push_back(bodyPose(row));
  }
  return poses;
}

std::vector<SE3> cut(const std::vector<SE3>& poses, double from, double length)
{
  std::vector<SE3> part;
  double station = 0.0;
  for (std::size_t i = 0; i < poses.size() && station <= from + length; ++i) {
    station += i > 0 ? (poses[i].translation - poses[i - 1].translation).norm() : 0.0;
    if (station >= from) {
      part.push_back(poses[i]);
    }
  }
  return part;
}

}  // namespace

std::vector<BodyState> readTrajectoryPart(const TrajectoryPart& part)
{
  constexpr std::size_t kLeast = 20;  // poses: two seconds
  const std::vector<SE3> poses = cut(readPoses(part.file), part.from, part.length);
  if (poses.size() < kLeast) {
    throw std::invalid_argument(part.file + ": less than two seconds of it lie in the part that is asked for");
  }
  const Eigen::Vector3d ahead = poses.front().rotation.col(0);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(-std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  std::vector<BodyState> states;
  for (const SE3& pose : poses) {
    const Eigen::Matrix3d r = turned * pose.rotation;
    BodyState state = BodyState::Zero();
    state.head<3>() = turned * (pose.translation - poses.front().translation);
    const double yaw = std::atan2(r(1, 0), r(0, 0));
    const double before = states.empty() ? 0.0 : states.back()[3];
    state[3] = before + std::remainder(yaw - before, 2.0 * M_PI);
    state[4] = std::asin(-r(2, 0));
    state[5] = std::atan2(r(2, 1), r(2, 2));
    states.push_back(state);
  }
  return states;
}

}  // namespace pcl_floam::simulator
