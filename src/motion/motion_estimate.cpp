#include "motion/motion_estimate.h"

#include "common/perturbation.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// How far a velocity that nothing is known of may be from none, m and rad a period: a car on a motorway, a hand that
/// turns the sensor.
constexpr double kFirstTranslation = 0.3;
constexpr double kFirstRotation = 0.15;
/// By how much a prediction over one period is off, m and rad, per coordinate, where nothing is known of it: 2 m/s^2
/// and 60 degrees/s^2 at ten sweeps a second. Where the sensor cannot be seen to move it stays so: nobody must come to
/// believe that a car on an open road does not accelerate.
constexpr double kTranslation = 0.02;
constexpr double kRotation = 0.01;
/// Otherwise half as much again as late ones were in the mean, or as the very last one; at least by what a pose is.
constexpr double kTimesLate = 1.5;
constexpr double kMemory = 10.0;  // predictions
constexpr double kLeastTranslation = 0.0005;
constexpr double kLeastRotation = 0.0005;
/// With exact poses the variance of a prediction over one period is so many times the density: 1/3 of it for the
/// noise since, the rest for the velocity's own error (Riccati's equation of that case).
constexpr double kPerDensity = 0.62;

/// Turns perturbations of pose and velocity about the sensor's position into other axes.
Matrix12 turnOfBoth(const Eigen::Matrix3d& rotation)
{
  const Matrix6 turn = turnOf(rotation);
  return inBlocks(turn, Matrix6::Zero(), Matrix6::Zero(), turn);
}

}  // namespace

MotionEstimate::MotionEstimate(const SE3& world_T_sensor, const Vector6& velocity)
    : pose_(world_T_sensor), velocity_(velocity)
{
  late_errors_ << Eigen::Vector3d::Constant(kTranslation * kTranslation),
      Eigen::Vector3d::Constant(kRotation * kRotation);
  for (int i = 0; i < 6; ++i) {
    const double first = i < 3 ? kFirstTranslation : kFirstRotation;
    covariance_(6 + i, 6 + i) = first * first;
  }
}

Matrix6 MotionEstimate::poseCovariance() const
{
  return propagated(turnOf(pose_.rotation), Matrix6(covariance_.topLeftCorner<6, 6>()));
}

void MotionEstimate::place(const SE3& world_T_sensor, const Matrix6& covariance)
{
  pose_ = world_T_sensor;
  covariance_.topLeftCorner<6, 6>() = propagated(turnOf(pose_.rotation.transpose()), covariance);
  covariance_.topRightCorner<6, 6>().setZero();
  covariance_.bottomLeftCorner<6, 6>().setZero();
}

void MotionEstimate::forgetAlong(const Eigen::Vector3d& direction, double periods)
{
  const Eigen::Vector3d d = kFirstTranslation * (pose_.rotation.transpose() * direction);
  const Eigen::Matrix3d variance = d * d.transpose();
  covariance_.block<3, 3>(0, 0) += periods * periods * variance;
  covariance_.block<3, 3>(0, 6) += periods * variance;
  covariance_.block<3, 3>(6, 0) += periods * variance;
  covariance_.block<3, 3>(6, 6) += variance;
}

void MotionEstimate::predict(double periods, const std::optional<MotionHint>& hint, double periods_error)
{
  constexpr double kMostSteps = 16.0;
  // Noise turns with the sensor on the way.
  const double steps = std::clamp(std::ceil(std::abs(periods)), 1.0, kMostSteps);
  const SE3 before = pose_;
  Growth growth;
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    advance(periods / steps, growth);
  }
  const Matrix12 was = covariance_;
  const Matrix6 squared_motion = velocity_ * velocity_.transpose() + was.bottomRightCorner<6, 6>();
  growth.noise.topLeftCorner<6, 6>() += periods_error * periods_error * squared_motion;
  covariance_ = propagated(growth.transition, was) + growth.noise;
  constexpr double kUnknown = 1.0;  // period: how many went by is not known, so what was off tells nothing
  periods_ = periods_error >= kUnknown || hint ? 0.0 : periods;
  if (hint) {
    take(*hint, before, was, growth);
  }
}

void MotionEstimate::advance(double periods, Growth& growth)
{
  const double length = std::abs(periods);
  const SE3 step = exp(periods * velocity_);
  pose_ = pose_ * step;
  pose_.rotation = nearestRotation(pose_.rotation);
  const Matrix12 f =
      inBlocks(adjoint(step.inverse()), periods * Matrix6::Identity(), Matrix6::Zero(), Matrix6::Identity());
  Matrix12 q = Matrix12::Zero();
  for (int i = 0; i < 6; ++i) {
    const double density = late_errors_[i] / kPerDensity;
    q(i, i) = density * length * length * length / 3.0;
    q(i, 6 + i) = q(6 + i, i) = density * periods * length / 2.0;
    q(6 + i, 6 + i) = density * length;
  }
  growth = {product(f, growth.transition), propagated(f, growth.noise) + q};
}

/// Kalman's filter for a motion that was measured: it says nothing of where the sensor was, but for what that has in
/// common with how it moved.
void MotionEstimate::take(const MotionHint& hint, const SE3& before, const Matrix12& was, const Growth& growth)
{
  const Matrix6 zero = Matrix6::Zero();
  const Matrix12 moved = inBlocks(zero, growth.transition.topRightCorner<6, 6>(), zero, zero);  // the motion's Jacobian
  Matrix12 common = product(product(growth.transition, was), moved.transpose());
  common.leftCols<6>() += growth.noise.leftCols<6>();
  const Matrix6 motion =
      propagated(moved, was).topLeftCorner<6, 6>() + growth.noise.topLeftCorner<6, 6>() + hint.covariance;
  const Matrix12 gain = product(common, inBlocks(inverseOf(motion), zero, zero, zero));
  const SE3 off = (before.inverse() * pose_).inverse() * hint.last_T_now;
  Vector6 error;
  error << off.translation, logSO3(off.rotation);
  shift(gain.leftCols<6>() * error);
  covariance_ -= product(gain, common.transpose());
}

/// \param change perturbation of pose and velocity
void MotionEstimate::shift(const Vector12& change)
{
  pose_ = SE3(nearestRotation(pose_.rotation * expSO3(change.segment<3>(3))),
              pose_.translation + pose_.rotation * Eigen::Vector3d(change.head<3>()));
  velocity_ += change.tail<6>();
}

Matrix12 MotionEstimate::covariance() const
{
  return propagated(turnOfBoth(pose_.rotation), covariance_);
}

/// \param innovation what was measured against the prediction, as a perturbation of the pose
/// \param told       how much of it the measurement says against what was known, in [0,1]
void MotionEstimate::learnFrom(const Vector6& innovation, const Vector6& told)
{
  constexpr double kHardly = 0.05;
  if (periods_ > 0.0) {
    const double over = std::max(1.0, periods_);
    for (int i = 0; i < 6; ++i) {
      const double usual = i < 3 ? kTranslation : kRotation;
      const double least = i < 3 ? kLeastTranslation : kLeastRotation;
      const double error = told[i] > kHardly ? kTimesLate * std::abs(innovation[i]) / over : usual;
      const double squared = i < 3 ? std::min(error * error, usual * usual) : error * error;
      late_errors_[i] += (squared - late_errors_[i]) / kMemory;
      late_errors_[i] = std::max({late_errors_[i], squared, least * least});
    }
  }
  periods_ = 0.0;
}

/// Kalman's filter; the covariance in Joseph's form, which stays positive.
void MotionEstimate::correct(const SE3& world_T_sensor, const Matrix6& covariance)
{
  Vector6 error;
  error.head<3>() = pose_.rotation.transpose() * (world_T_sensor.translation - pose_.translation);
  error.tail<3>() = logSO3(pose_.rotation.transpose() * world_T_sensor.rotation);
  const Matrix6 noise = propagated(turnOf(pose_.rotation.transpose()), covariance);
  const Matrix6 innovation = covariance_.topLeftCorner<6, 6>() + noise;
  learnFrom(error, covariance_.diagonal().head<6>().cwiseQuotient(innovation.diagonal()));
  const Matrix6 zero = Matrix6::Zero();
  const Matrix12 gain = product(covariance_, inBlocks(inverseOf(innovation), zero, zero, zero));
  shift(gain.leftCols<6>() * error);
  const Matrix12 left = Matrix12::Identity() - gain;
  covariance_ = propagated(left, covariance_) + propagated(gain, inBlocks(noise, zero, zero, zero));
}

void MotionEstimate::update(const SE3& world_T_sensor, const Vector6& velocity, const Matrix12& covariance)
{
  constexpr double kNothing = 1e-9;
  const Eigen::Matrix3d turned_back = nearestRotation(world_T_sensor.rotation).transpose();
  const Matrix12 known = propagated(turnOfBoth(turned_back), covariance);
  const Vector6 told = (1.0 - known.diagonal().head<6>().array() / covariance_.diagonal().head<6>().array()).matrix();
  Vector6 off;
  off << pose_.rotation.transpose() * (world_T_sensor.translation - pose_.translation),
      logSO3(pose_.rotation.transpose() * world_T_sensor.rotation);
  learnFrom(off.cwiseQuotient(told.cwiseMax(kNothing)), told);
  pose_ = {turned_back.transpose(), world_T_sensor.translation};
  velocity_ = velocity;
  covariance_ = known;
}

}  // namespace pcl_floam
