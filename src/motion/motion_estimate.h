/// \file motion_estimate.h
/// The one estimate of how the sensor moves: pose, velocity and what is known of both.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// Pose and velocity under white noise of acceleration (Barfoot 2017, ch. 11): a constant velocity (Eq. 2), and how far
/// that may be off. Errors are perturbations on the right, in the sensor's axes: T exp(d), v + n. Times are in periods
/// of the sensor.
class MotionEstimate {
public:
  using Matrix12 = Eigen::Matrix<double, 12, 12, Eigen::DontAlign>;

  /// A pose that is exact, and a velocity that is a guess.
  explicit MotionEstimate(const SE3& world_T_sensor = {}, const Vector6& velocity = Vector6::Zero());

  [[nodiscard]] const SE3& pose() const { return pose_; }
  [[nodiscard]] const Vector6& velocity() const { return velocity_; }  ///< m and rad a period

  /// Of the pose, as a perturbation on the left about the sensor's position, in the world's axes.
  [[nodiscard]] Matrix6 poseCovariance() const;

  /// By how much the velocity changes with what the pose turns out to be, 1 / period: after a prediction it is also the
  /// best guess of the motion during the sweep.
  [[nodiscard]] Matrix6 velocityPerPose() const;

  /// The sensor is elsewhere than was thought; how it moves in its own axes stays as it is known.
  /// \param covariance as \ref poseCovariance
  void place(const SE3& world_T_sensor, const Matrix6& covariance);

  /// Goes on by so many periods.
  void predict(double periods);

  /// Takes in what a registration made of the predicted pose: the posterior, prior included.
  /// \param covariance as \ref poseCovariance
  /// \param noise      likewise: by how much the pose is off from scan to scan beyond that; the velocity follows it
  /// less
  void correct(const SE3& world_T_sensor, const Matrix6& covariance, const Matrix6& noise = Matrix6::Zero());

private:
  SE3 pose_;
  Vector6 velocity_ = Vector6::Zero();
  Matrix12 covariance_ = Matrix12::Zero();
  Matrix6 noise_ = Matrix6::Zero();  ///< of the last correction, in the sensor's axes
};

}  // namespace pcl_floam
