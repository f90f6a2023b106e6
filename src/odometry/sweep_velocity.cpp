#include "odometry/sweep_velocity.h"

#include <algorithm>
#include <cstddef>

namespace pcl_floam {

namespace {

constexpr double kLongGap = 3.5;  // periods, after which nothing that was known holds

/// Points that are spread evenly over a sweep tell the motion over it with twelve times the variance of its pose.
constexpr double kMotionVariance = 12.0;

/// A pose is never known better, and locked degrees of freedom have no variance at all.
constexpr double kLeastTranslation = 1e-4;  // m
constexpr double kLeastRotation = 1e-5;     // rad

}  // namespace

void SweepVelocity::begin(const Vector6& twist)
{
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].begin(twist[static_cast<int>(i)]);
  }
  begun_ = true;
}

SweepMotion SweepVelocity::refine(const SweepMotion& registered, const Matrix6& covariance, double sweep_fraction,
                                  const Vector6& between, double periods)
{
  const Vector6 velocity = registered.twist() / sweep_fraction;
  if (!begun_ || periods > kLongGap) {
    begin(velocity);
    return registered;
  }
  Vector6 twist;
  Vector6 acceleration;
  for (int i = 0; i < 6; ++i) {
    AxisVelocity& axis = axes_[static_cast<std::size_t>(i)];
    const double least = i < 3 ? kLeastTranslation : kLeastRotation;
    const double variance = std::max(least * least, covariance(i, i));
    const double velocity_variance = kMotionVariance / (sweep_fraction * sweep_fraction) * variance;
    axis.observe({periods * between[i], velocity[i], variance, velocity_variance}, periods);
    twist[i] = sweep_fraction * axis.velocity();
    acceleration[i] = sweep_fraction * sweep_fraction * axis.acceleration();
  }
  return SweepMotion(twist, registered.reference(), acceleration);
}

}  // namespace pcl_floam
