#include "motion/motion_estimate.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace pcl_floam {

namespace {

using Block6 = Eigen::Matrix<double, 6, 6>;

/// A first guess, m and rad a period: a car on a motorway, a hand that turns the sensor.
constexpr double kFirstTranslation = 0.3;
constexpr double kFirstRotation = 0.05;
/// Standard deviations a prediction is never better than, m and rad: motion may begin at any time.
constexpr double kLeastTranslation = 0.01;
constexpr double kLeastRotation = 0.002;
/// What of the mean a new error replaces.
constexpr double kShare = 0.15;
/// With exact poses the variance of a prediction over one period is so many times the density: 1/3 of it for the
/// noise since, the rest for the velocity's own error (Riccati's equation of that case).
constexpr double kPerDensity = 0.62;

Block6 adjoint(const SE3& t)
{
  Block6 a = Block6::Zero();
  a.topLeftCorner<3, 3>() = t.rotation;
  a.bottomRightCorner<3, 3>() = t.rotation;
  a.topRightCorner<3, 3>() = skew(t.translation) * t.rotation;
  return a;
}

/// From the sensor's axes to the world's, for perturbations about the sensor's position.
Block6 turned(const Eigen::Matrix3d& rotation)
{
  Block6 r = Block6::Zero();
  r.topLeftCorner<3, 3>() = rotation;
  r.bottomRightCorner<3, 3>() = rotation;
  return r;
}

}  // namespace

MotionEstimate::MotionEstimate(const SE3& world_T_sensor)
    : pose_(world_T_sensor),
      translation_error_(kFirstTranslation * kFirstTranslation),
      rotation_error_(kFirstRotation * kFirstRotation)
{
}

MotionEstimate::MotionEstimate(const SE3& world_T_sensor, const Vector6& velocity) : MotionEstimate(world_T_sensor)
{
  velocity_ = velocity;
  for (int i = 0; i < 6; ++i) {
    covariance_(6 + i, 6 + i) = i < 3 ? translation_error_ : rotation_error_;
  }
}

Matrix6 MotionEstimate::poseCovariance() const
{
  const Block6 r = turned(pose_.rotation);
  return r * covariance_.topLeftCorner<6, 6>() * r.transpose();
}

void MotionEstimate::predict(double periods)
{
  const SE3 step = exp(periods * velocity_);
  pose_ = pose_ * step;
  pose_.rotation = nearestRotation(pose_.rotation);
  Eigen::Matrix<double, 12, 12> f = Eigen::Matrix<double, 12, 12>::Identity();
  f.topLeftCorner<6, 6>() = adjoint(step.inverse());
  f.topRightCorner<6, 6>() = periods * Block6::Identity();
  const Eigen::Matrix<double, 12, 12> before = covariance_;
  covariance_ = f * before * f.transpose();
  for (int i = 0; i < 6; ++i) {
    const double least = i < 3 ? kLeastTranslation : kLeastRotation;
    const double q = std::max(i < 3 ? translation_error_ : rotation_error_, least * least) / kPerDensity;
    covariance_(i, i) += q * periods * periods * periods / 3.0;
    covariance_(i, 6 + i) += q * periods * periods / 2.0;
    covariance_(6 + i, i) += q * periods * periods / 2.0;
    covariance_(6 + i, 6 + i) += q * periods;
  }
  predicted_periods_ += periods;
}

void MotionEstimate::learn(const Vector6& error)
{
  if (predicted_periods_ > 0.0 && predicted_periods_ < 1.5) {
    translation_error_ += kShare * (error.head<3>().squaredNorm() / 3.0 - translation_error_);
    rotation_error_ += kShare * (error.tail<3>().squaredNorm() / 3.0 - rotation_error_);
  }
  predicted_periods_ = 0.0;
}

void MotionEstimate::correct(const SE3& world_T_sensor, const Matrix6& covariance)
{
  Vector6 error;
  error.head<3>() = pose_.rotation.transpose() * (world_T_sensor.translation - pose_.translation);
  error.tail<3>() = logSO3(pose_.rotation.transpose() * world_T_sensor.rotation);
  learn(error);
  const Block6 r = turned(pose_.rotation).transpose();
  const Block6 posterior = r * covariance * r.transpose();
  const Eigen::Matrix<double, 12, 12> p = covariance_;
  const Block6 pp = p.topLeftCorner<6, 6>();
  const Block6 vp = p.bottomLeftCorner<6, 6>();
  // The regression of the velocity's error on the pose's.
  const Block6 gain = pp.ldlt().solve(vp.transpose()).transpose();
  velocity_ += gain * error;
  Eigen::Matrix<double, 12, 12> after;
  after.topLeftCorner<6, 6>() = posterior;
  after.bottomLeftCorner<6, 6>() = gain * posterior;
  after.topRightCorner<6, 6>() = posterior * gain.transpose();
  after.bottomRightCorner<6, 6>() = Block6(p.bottomRightCorner<6, 6>()) - gain * (pp - posterior) * gain.transpose();
  covariance_ = after;
  pose_ = world_T_sensor;
  pose_.rotation = nearestRotation(pose_.rotation);
}

}  // namespace pcl_floam
