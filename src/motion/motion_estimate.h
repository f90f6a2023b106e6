/// \file motion_estimate.h
/// The one estimate of how the sensor moves: pose, velocity and what is known of both.
#pragma once

#include "common/covariance.h"

#include <pcl_floam/motion/motion_hint.h>

#include <optional>

namespace pcl_floam {

/// Sweeps until the velocity is known again where the sensor has been sought.
constexpr int kSweepsUntilKnown = 3;

/// Pose and velocity under white noise of acceleration (Barfoot 2017, ch. 11): a constant velocity (Eq. 2), and how far
/// that may be off. Errors are perturbations on the right, in the sensor's axes: T exp(d), v + n. Times are in periods
/// of the sensor.
class MotionEstimate {
public:
  /// A pose that is exact, and a velocity that is a guess.
  explicit MotionEstimate(const SE3& world_T_sensor = {}, const Vector6& velocity = Vector6::Zero());

  [[nodiscard]] const SE3& pose() const { return pose_; }
  [[nodiscard]] const Vector6& velocity() const { return velocity_; }  ///< m and rad a period

  /// Of the pose, as a perturbation on the left about the sensor's position, in the world's axes.
  [[nodiscard]] Matrix6 poseCovariance() const;

  /// Of pose and velocity, both about the sensor's position in the world's axes.
  [[nodiscard]] Matrix12 covariance() const;

  /// The sensor is elsewhere than was thought; how it moves in its own axes stays as it is known.
  /// \param covariance as \ref poseCovariance
  void place(const SE3& world_T_sensor, const Matrix6& covariance);

  /// The velocity along a direction of the world's axes is no better known than at first, and was not for so many
  /// periods.
  void forgetAlong(const Eigen::Vector3d& direction, double periods);

  /// Goes on by so many periods, or back, if they are negative.
  /// \param hint          of the motion meanwhile
  /// \param periods_error one standard deviation
  void predict(double periods, const std::optional<MotionHint>& hint = std::nullopt, double periods_error = 0.0);

  /// The last prediction's error tells nothing of how restless the sensor is.
  void learnNothing() { periods_ = 0.0; }

  /// Takes in a measured pose.
  /// \param covariance of its errors, as \ref poseCovariance
  void correct(const SE3& world_T_sensor, const Matrix6& covariance);

  /// Takes what a registration made of the prediction.
  /// \param covariance as \ref covariance
  void update(const SE3& world_T_sensor, const Vector6& velocity, const Matrix12& covariance);

private:
  /// What becomes of pose and velocity over a time, to first order.
  struct Growth {
    Matrix12 transition = Matrix12::Identity();
    Matrix12 noise = Matrix12::Zero();
  };

  void advance(double periods, Growth& growth);
  void take(const MotionHint& hint, const SE3& before, const Matrix12& was, const Growth& growth);
  void shift(const Vector12& change);
  void learnFrom(const Vector6& innovation, const Vector6& told);

  SE3 pose_;
  Vector6 velocity_ = Vector6::Zero();
  Matrix12 covariance_ = Matrix12::Zero();
  double periods_ = 0.0;  ///< of the last prediction; 0: it tells nothing of how restless the sensor is
  Vector6 late_errors_;   ///< m^2 and rad^2 per coordinate, of predictions over one period: squared, the mean of late
};

}  // namespace pcl_floam
