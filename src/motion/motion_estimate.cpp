#include "motion/motion_estimate.h"

#include <Eigen/Cholesky>

namespace pcl_floam {

namespace {

using Block6 = Eigen::Matrix<double, 6, 6>;

/// How far a velocity that nothing is known of may be from none, m and rad a period: a car on a motorway, a hand that
/// turns the sensor.
constexpr double kFirstTranslation = 0.3;
constexpr double kFirstRotation = 0.15;
/// By how much a prediction over one period is off, m and rad, per coordinate: 2 m/s^2 and 60 degrees/s^2 at ten
/// sweeps a second.
constexpr double kTranslation = 0.02;
constexpr double kRotation = 0.01;
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

MotionEstimate::MotionEstimate(const SE3& world_T_sensor, const Vector6& velocity)
    : pose_(world_T_sensor), velocity_(velocity)
{
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
    const double error = i < 3 ? kTranslation : kRotation;
    const double q = error * error / kPerDensity;
    covariance_(i, i) += q * periods * periods * periods / 3.0;
    covariance_(i, 6 + i) += q * periods * periods / 2.0;
    covariance_(6 + i, i) += q * periods * periods / 2.0;
    covariance_(6 + i, 6 + i) += q * periods;
  }
}

/// The regression of the velocity's error on the pose's.
Matrix6 MotionEstimate::velocityPerPose() const
{
  const Eigen::Matrix<double, 12, 12> p = covariance_;
  const Block6 innovation = Block6(p.topLeftCorner<6, 6>()) + noise_;
  return innovation.ldlt().solve(Block6(p.topRightCorner<6, 6>())).transpose();
}

void MotionEstimate::correct(const SE3& world_T_sensor, const Matrix6& covariance, const Matrix6& noise)
{
  Vector6 error;
  error.head<3>() = pose_.rotation.transpose() * (world_T_sensor.translation - pose_.translation);
  error.tail<3>() = logSO3(pose_.rotation.transpose() * world_T_sensor.rotation);
  const Block6 r = turned(pose_.rotation).transpose();
  const Block6 posterior = r * covariance * r.transpose();
  noise_ = r * noise * r.transpose();
  const Eigen::Matrix<double, 12, 12> p = covariance_;
  const Block6 innovation = Block6(p.topLeftCorner<6, 6>()) + noise_;
  const Block6 gain = velocityPerPose();
  velocity_ += gain * error;
  Eigen::Matrix<double, 12, 12> after;
  after.topLeftCorner<6, 6>() = posterior;
  after.bottomLeftCorner<6, 6>() = gain * posterior;
  after.topRightCorner<6, 6>() = posterior * gain.transpose();
  after.bottomRightCorner<6, 6>() =
      Block6(p.bottomRightCorner<6, 6>()) - gain * (innovation - posterior) * gain.transpose();
  covariance_ = after;
  pose_ = world_T_sensor;
  pose_.rotation = nearestRotation(pose_.rotation);
}

}  // namespace pcl_floam
