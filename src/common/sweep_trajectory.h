/// \file sweep_trajectory.h
/// Where the points of a moving sweep lie: the motion model of compensation and registration.
#pragma once

#include <pcl_floam/common/se3.h>

#include <algorithm>
#include <array>

namespace pcl_floam {

/// The sensor's poses during one sweep: T(s) = T(r) exp((s - r) xi + (s - r)^2 alpha / 2); without alpha Eq. 3 and 4.
///
/// A perturbation of the pose at r, on the left (Eq. 11), moves all points as it would move a rigid scan.
class SweepTrajectory {
public:
  /// \param twist        xi, motion over the sweep
  /// \param reference    r in [0, 1], the instant of the pose
  /// \param acceleration alpha, change of the twist over the sweep
  SweepTrajectory(const SE3& target_T_sensor, const Vector6& twist, double reference,
                  const Vector6& acceleration = Vector6::Zero())
      : pose_(target_T_sensor), twist_(twist), acceleration_(acceleration), reference_(reference)
  {
    tabulate();
  }

  [[nodiscard]] const SE3& pose() const { return pose_; }
  [[nodiscard]] const Vector6& twist() const { return twist_; }
  [[nodiscard]] const Vector6& acceleration() const { return acceleration_; }

  /// Time from the reference instant.
  [[nodiscard]] double sinceReference(double time) const { return time - reference_; }

  /// A point of the sensor's frame, measured at a fraction of the sweep in [0, 1], in the target's frame.
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& point, double time) const
  {
    if (still_) {
      return pose_ * point;
    }
    const double place = std::clamp(time, 0.0, 1.0) * kSteps;
    const auto step = static_cast<int>(place + 0.5);
    const Eigen::Vector3d near = poses_[static_cast<std::size_t>(step)] * point;
    // The rest of the way to second order: half a step of a turn of 1 rad leaves 5e-6 rad out of account.
    const double rest = (place - step) / kSteps;
    const double since = static_cast<double>(step) / kSteps - reference_ + 0.5 * rest;
    const Eigen::Vector3d angular_velocity = angular_velocity_ + since * angular_acceleration_;
    const Eigen::Vector3d velocity = velocity_ + since * linear_acceleration_ + angular_velocity.cross(near);
    return near + rest * (velocity + 0.5 * rest * angular_velocity.cross(velocity));
  }

  /// The trajectory perturbed on the left by \p delta at the reference instant.
  [[nodiscard]] SweepTrajectory perturbed(const Vector6& delta) const;

private:
  static constexpr int kSteps = 16;

  void tabulate();

  SE3 pose_;
  Vector6 twist_;
  Vector6 acceleration_;
  double reference_;
  bool still_ = true;
  std::array<SE3, kSteps + 1> poses_;
  // Spatial: without acceleration the same all through the sweep.
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_acceleration_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_acceleration_ = Eigen::Vector3d::Zero();
};

}  // namespace pcl_floam
