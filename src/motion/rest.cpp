#include "motion/rest.h"

namespace pcl_floam {

/// In root mean square steps: noise hardly ever is so far from the mean, a steady motion from the eighth pose on.
bool Rest::Scatter::isFar(const Eigen::Vector3d& from_mean, int poses) const
{
  constexpr double kFar = 4.0;
  constexpr double kRounding = 1e-9;  // m or rad: poses that are all alike are so but for this
  return poses > 1 && from_mean.squaredNorm() * (poses - 1) > kFar * kFar * squares_ + kRounding * kRounding * poses;
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
  constexpr double kRounding = 1e-16;  // m^2 or rad^2
  return products_ <= kRounding - kUndone * squares_;
}

void Rest::take(const SE3& pose)
{
  constexpr int kFewest = 10;  // poses: noise of fewer looks like motion, and slow motion like noise
  constexpr int kMost = 20;    // poses: the sensor may have come to rest among them
  const Eigen::Vector3d from_mean = pose.translation - mean_.translation;
  const Eigen::Vector3d turned = logSO3(pose.rotation * mean_.rotation.transpose());
  const bool begins_again = !is_at_rest_ && poses_ == kMost;
  if (poses_ == 0 || begins_again || position_.isFar(from_mean, poses_) || rotation_.isFar(turned, poses_)) {
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
