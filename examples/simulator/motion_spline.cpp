#include "motion_spline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace pcl_floam::simulator {

namespace {

/// Weight of the \p k-th of four controls at the fraction \p u of a segment.
double positionWeight(int k, double u)
{
  const double v = 1.0 - u;
  switch (k) {
    case 0: return v * v * v / 6.0;
    case 1: return (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0;
    case 2: return (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0;
    default: return u * u * u / 6.0;
  }
}

double velocityWeight(int k, double u)
{
  const double v = 1.0 - u;
  switch (k) {
    case 0: return -v * v / 2.0;
    case 1: return (3.0 * u * u - 4.0 * u) / 2.0;
    case 2: return (4.0 * v - 3.0 * v * v) / 2.0;
    default: return u * u / 2.0;
  }
}

double accelerationWeight(int k, double u)
{
  switch (k) {
    case 0: return 1.0 - u;
    case 1: return 3.0 * u - 2.0;
    case 2: return 1.0 - 3.0 * u;
    default: return u;
  }
}

}  // namespace

SE3 poseOf(const BodyState& state)
{
  const Eigen::Matrix3d rotation =
      (Eigen::AngleAxisd(state[3], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(state[4], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(state[5], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return {rotation, state.head<3>()};
}

MotionSpline::MotionSpline(const BodyState& state) : interval_(1.0), controls_(4, state) {}

MotionSpline::MotionSpline(double interval, std::vector<BodyState> controls)
    : interval_(interval), controls_(std::move(controls))
{
  if (controls_.size() < 4 || !(interval > 0.0)) {
    throw std::invalid_argument("a motion needs at least four controls and a positive interval");
  }
}

double MotionSpline::duration() const
{
  return interval_ * static_cast<double>(controls_.size() - 3);
}

BodyState MotionSpline::blend(double t, double (*weight)(int, double)) const
{
  const double place = std::clamp(t, 0.0, duration()) / interval_;
  const std::size_t segment = std::min(static_cast<std::size_t>(place), controls_.size() - 4);
  const double u = place - static_cast<double>(segment);
  BodyState sum = BodyState::Zero();
  for (int k = 0; k < 4; ++k) {
    sum += weight(k, u) * controls_[segment + static_cast<std::size_t>(k)];
  }
  return sum;
}

BodyState MotionSpline::state(double t) const
{
  return blend(t, positionWeight);
}

Eigen::Vector3d MotionSpline::velocity(double t) const
{
  return blend(t, velocityWeight).head<3>() / interval_;
}

Eigen::Vector3d MotionSpline::acceleration(double t) const
{
  return blend(t, accelerationWeight).head<3>() / (interval_ * interval_);
}

double MotionSpline::accelerationBound() const
{
  double bound = 0.0;
  for (std::size_t i = 2; i < controls_.size(); ++i) {
    const BodyState difference = controls_[i] - 2.0 * controls_[i - 1] + controls_[i - 2];
    bound = std::max(bound, difference.head<3>().norm());
  }
  return bound / (interval_ * interval_);
}

}  // namespace pcl_floam::simulator
