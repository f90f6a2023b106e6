#include "motion/motion_estimate.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

using Block6 = Eigen::Matrix<double, 6, 6>;

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

/// From the sensor's axes to the world's, for perturbations about the sensor's position.
Block6 turned(const Eigen::Matrix3d& rotation)
{
  Block6 r = Block6::Zero();
  r.topLeftCorner<3, 3>() = rotation;
  r.bottomRightCorner<3, 3>() = rotation;
  return r;
}

using Square12 = Eigen::Matrix<double, 12, 12>;

Square12 turnedBoth(const Eigen::Matrix3d& rotation)
{
  Square12 r = Square12::Zero();
  r.topLeftCorner<6, 6>() = turned(rotation);
  r.bottomRightCorner<6, 6>() = turned(rotation);
  return r;
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
  const Block6 r = turned(pose_.rotation);
  return r * covariance_.topLeftCorner<6, 6>() * r.transpose();
}

void MotionEstimate::place(const SE3& world_T_sensor, const Matrix6& covariance)
{
  pose_ = world_T_sensor;
  const Block6 r = turned(pose_.rotation).transpose();
  covariance_.topLeftCorner<6, 6>() = r * covariance * r.transpose();
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
  const double steps = std::clamp(std::ceil(periods), 1.0, kMostSteps);  // noise turns with the sensor on the way
  const SE3 before = pose_;
  Growth growth;
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    advance(periods / steps, growth);
  }
  const Square12 was = covariance_;
  const Block6 squared_motion = velocity_ * velocity_.transpose() + was.bottomRightCorner<6, 6>();
  growth.noise.topLeftCorner<6, 6>() += periods_error * periods_error * squared_motion;
  covariance_ = growth.of(was);
  periods_ = periods_error > 0.0 || hint ? 0.0 : periods;
  if (hint) {
    take(*hint, before, was, growth);
  }
}

void MotionEstimate::advance(double periods, Growth& growth)
{
  const SE3 step = exp(periods * velocity_);
  pose_ = pose_ * step;
  pose_.rotation = nearestRotation(pose_.rotation);
  Square12 f = Square12::Identity();
  f.topLeftCorner<6, 6>() = adjoint(step.inverse());
  f.topRightCorner<6, 6>() = periods * Block6::Identity();
  Square12 q = Square12::Zero();
  for (int i = 0; i < 6; ++i) {
    const double density = late_errors_[i] / kPerDensity;
    q(i, i) = density * periods * periods * periods / 3.0;
    q(i, 6 + i) = q(6 + i, i) = density * periods * periods / 2.0;
    q(6 + i, 6 + i) = density * periods;
  }
  growth = {f * growth.transition, Square12(f * growth.noise * f.transpose()) + q};
}

/// Kalman's filter for a motion that was measured: it says nothing of where the sensor was, but for what that has in
/// common with how it moved.
void MotionEstimate::take(const MotionHint& hint, const SE3& before, const Matrix12& was, const Growth& growth)
{
  const Eigen::Matrix<double, 6, 6> by_velocity = growth.transition.topRightCorner<6, 6>();
  const Square12 covariance = was;
  const Eigen::Matrix<double, 12, 6> common =
      growth.transition * covariance.rightCols<6>() * by_velocity.transpose() + growth.noise.leftCols<6>();
  const Block6 motion =
      by_velocity * covariance.bottomRightCorner<6, 6>() * by_velocity.transpose() + growth.noise.topLeftCorner<6, 6>();
  const Eigen::LDLT<Block6> innovation(motion + Block6(hint.covariance));
  const SE3 off = (before.inverse() * pose_).inverse() * hint.last_T_now;
  Eigen::Matrix<double, 6, 1> error;
  error << off.translation, logSO3(off.rotation);
  const Eigen::Matrix<double, 12, 6> gain = innovation.solve(common.transpose()).transpose();
  shift(gain * error);
  covariance_ -= gain * common.transpose();
}

/// \param change perturbation of pose and velocity
void MotionEstimate::shift(const Eigen::Matrix<double, 12, 1>& change)
{
  pose_ = SE3(nearestRotation(pose_.rotation * expSO3(change.segment<3>(3))),
              pose_.translation + pose_.rotation * Eigen::Vector3d(change.head<3>()));
  velocity_ += change.tail<6>();
}

MotionEstimate::Matrix12 MotionEstimate::covariance() const
{
  const Square12 r = turnedBoth(pose_.rotation);
  return r * covariance_ * r.transpose();
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
  const Block6 r = turned(pose_.rotation).transpose();
  const Square12 p = covariance_;
  const Block6 noise = r * covariance * r.transpose();
  const Block6 innovation = Block6(p.topLeftCorner<6, 6>()) + noise;
  learnFrom(error, p.diagonal().head<6>().cwiseQuotient(innovation.diagonal()));
  const Eigen::Matrix<double, 12, 6> gain =
      innovation.ldlt().solve(Eigen::Matrix<double, 6, 12>(p.topRows<6>())).transpose();
  shift(gain * error);
  Square12 left = Square12::Identity();
  left.leftCols<6>() -= gain;
  covariance_ = left * p * left.transpose() + gain * noise * gain.transpose();
}

void MotionEstimate::update(const SE3& world_T_sensor, const Vector6& velocity, const Matrix12& covariance)
{
  constexpr double kNothing = 1e-9;
  const Eigen::Matrix3d turned_back = nearestRotation(world_T_sensor.rotation).transpose();
  const Square12 r = turnedBoth(turned_back);
  const Square12 known = r * covariance * r.transpose();
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
