/// \file constant_velocity.h
/// Motion prediction (Eq. 2), with gaps and uneven periods.
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/registration/sweep_model.h>

#include <optional>
#include <vector>

namespace pcl_floam {

/// The constant-velocity model: the next motion is the last one (Eq. 2), as far as that is known.
class ConstantVelocity {
public:
  /// Whether two poses have been seen.
  [[nodiscard]] bool isKnown() const { return known_; }

  /// xi of Eq. 2, motion within one period.
  [[nodiscard]] const Vector6& twist() const { return twist_; }

  /// Of the twist, in the sensor's axes.
  [[nodiscard]] const Matrix6& covariance() const { return covariance_; }

  /// Motion over a number of periods; extrapolation ends after ten.
  [[nodiscard]] SE3 motion(double periods) const;

  /// Begins anew with a velocity that is roughly known.
  void set(const Vector6& twist);

  /// Takes in a measured velocity as far as it is worth it: wholly where the pose is well known, little along
  /// directions of which the scan said little (Kalman's gain). A velocity that follows the noise of such directions
  /// leads the sensor astray as soon as they are not seen at all.
  /// \param measured        motion per period, since a pose that is \p periods ago
  /// \param pose_covariance of the present pose, in the sensor's axes
  /// \param noise           variance of the velocity's change within one period
  /// \return by what the velocity changed
  Vector6 observe(const Vector6& measured, const Matrix6& pose_covariance, const Vector6& noise, double periods);

private:
  Vector6 twist_ = Vector6::Zero();
  Matrix6 covariance_ = Matrix6::Zero();
  bool known_ = false;
};

/// How far predictions have been off lately, in m of displacement of a point at a typical distance.
class PredictionError {
public:
  void observe(const SE3& predicted_T_estimated, double typical_range);

  /// A bound for the next prediction: three times the recent root mean square, growing over gaps.
  [[nodiscard]] double bound(double periods) const;

private:
  static constexpr double kUnknown = 1.0;  // m, before anything was observed
  double squared_ = kUnknown;
};

/// How much the velocity changes from scan to scan, as seen lately, and the motion prior that follows from it.
class VelocityNoise {
public:
  /// \param change of the velocity, over \p periods
  void observe(const Vector6& change, double periods);

  /// Of the velocity's change within one period, per coordinate. The floors let a motion begin after a long rest.
  [[nodiscard]] Vector6 variance() const;

  /// The prior of a sweep.
  ///
  /// It says little of the pose, and of the twist mainly that it goes with the pose: a stiff prior of the pose (white
  /// noise of acceleration, as seen) lags behind every acceleration, the map takes that in, and the drift of the real
  /// drive of the tests went from 0.03 to 0.12 m.
  /// \param periods        since the last scan, > 0
  /// \param sweep_fraction duration of the sweep in periods
  [[nodiscard]] MotionPrior prior(const SE3& predicted, const Vector6& sweep_twist, double periods,
                                  double sweep_fraction) const;

private:
  // Variance per coordinate and period; the first values are those before anything was observed.
  double translation_ = 0.1 * 0.1;  // m^2
  double rotation_ = 0.05 * 0.05;   // rad^2
};

}  // namespace pcl_floam
