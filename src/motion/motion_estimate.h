/// \file motion_estimate.h
/// The one estimate of how the sensor moves: pose, velocity and what is known of both.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// Pose and velocity under white noise of acceleration (Barfoot 2017, ch. 11): a constant velocity (Eq. 2), and how far
/// that may be off. Errors are perturbations on the right, in the sensor's axes: T exp(d), v + n. Times are in periods
/// of the sensor.
///
/// The noise's density follows from the predictions' own errors, for translations and rotations apart.
class MotionEstimate {
public:
  using Matrix12 = Eigen::Matrix<double, 12, 12, Eigen::DontAlign>;

  MotionEstimate() : MotionEstimate(SE3()) {}
  /// A pose that is exact, and a velocity of which nothing is known.
  explicit MotionEstimate(const SE3& world_T_sensor);
  MotionEstimate(const SE3& world_T_sensor, const Vector6& velocity);

  [[nodiscard]] const SE3& pose() const { return pose_; }
  [[nodiscard]] const Vector6& velocity() const { return velocity_; }  ///< m and rad a period

  /// Of the pose, as a perturbation on the left about the sensor's position, in the world's axes.
  [[nodiscard]] Matrix6 poseCovariance() const;

  /// Goes on by so many periods.
  void predict(double periods);

  /// Takes in what a registration made of the predicted pose: the posterior, prior included.
  /// \param covariance as \ref poseCovariance
  void correct(const SE3& world_T_sensor, const Matrix6& covariance);

  [[nodiscard]] SE3 poseAt(double periods) const { return pose_ * exp(periods * velocity_); }

private:
  void learn(const Vector6& error);

  SE3 pose_;
  Vector6 velocity_ = Vector6::Zero();
  Matrix12 covariance_ = Matrix12::Zero();
  double predicted_periods_ = 0.0;
  double translation_error_;  ///< mean squared error of predictions over one period, per coordinate, m^2
  double rotation_error_;     ///< rad^2
};

}  // namespace pcl_floam
