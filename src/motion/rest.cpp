#include "motion/rest.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// What poses that are all alike differ by, m^2 or rad^2.
constexpr double kRounding = 1e-18;

/// Whether the noise of two poses does not lead so far from one to the other. Noise of three directions leads to five
/// standard deviations once in an hour and a half, at 10 Hz.
bool isMore(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance)
{
  constexpr double kFar = 5.0;  // standard deviations
  const Eigen::Matrix3d noise = covariance + kRounding * Eigen::Matrix3d::Identity();
  return off.dot(noise.ldlt().solve(off)) > kFar * kFar;
}

}  // namespace

/// Noise of one direction leads so far from the mean once in an hour. A step has twice its variance, of which few steps
/// tell little: Student's distribution, by the tail that is known in closed form, that of two directions.
bool Rest::Scatter::isFar(const Eigen::Vector3d& from_mean, int poses) const
{
  constexpr double kScans = 36000.0;  // in an hour, at 10 Hz
  if (poses < 2) {
    return false;
  }
  const int steps = poses - 1;
  const double freedom = steps / 1.5;  // each shares a pose with the one before
  const double variance = (0.5 * squares_ / steps + kRounding) * (1.0 + 1.0 / poses);
  return from_mean.squaredNorm() > variance * freedom * (std::pow(kScans, 2.0 / freedom) - 1.0);
}

void Rest::Scatter::add(const Eigen::Vector3d& step)
{
  squares_ += step.squaredNorm();
  products_ += step.dot(last_);
  last_ = step;
}

/// Steps of white noise have a correlation of -1/2 with the ones before, those of a steady motion of 1; a single jump
/// has none.
bool Rest::Scatter::isNoise() const
{
  constexpr double kUndone = 0.1;
  return products_ <= kRounding - kUndone * squares_;
}

void Rest::take(const SE3& pose, const Matrix6& covariance)
{
  constexpr int kFewest = 10;  // poses: noise of fewer looks like motion, and slow motion like noise
  const Eigen::Vector3d from_mean = pose.translation - mean_.translation;
  const Eigen::Vector3d turned = logSO3(pose.rotation * mean_.rotation.transpose());
  const bool begins_again = !is_at_rest_ && poses_ == kMostPoses;
  const Matrix6 noise = (1.0 + 1.0 / std::max(1, poses_)) * covariance;
  const bool moved = isMore(from_mean, noise.topLeftCorner<3, 3>()) || isMore(turned, noise.bottomRightCorner<3, 3>());
  if (poses_ == 0 || begins_again || moved || position_.isFar(from_mean, poses_) || rotation_.isFar(turned, poses_)) {
    *this = Rest();
    poses_ = 1;
    mean_ = last_ = pose;
    return;
  }
  position_.add(pose.translation - last_.translation);
  rotation_.add(logSO3(pose.rotation * last_.rotation.transpose()));
  last_ = pose;
  ++poses_;
  mean_.translation += from_mean / poses_;
  mean_.rotation = nearestRotation(expSO3(turned / poses_) * mean_.rotation);
  is_at_rest_ = is_at_rest_ || (poses_ >= kFewest && position_.isNoise() && rotation_.isNoise());
}

}  // namespace pcl_floam
