#include "odometry/axis_velocity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Of the change of acceleration within one period, in variances of the pose, for the first filter and from one to the
/// next.
constexpr double kLeastChange = 1e-8;
constexpr double kStep = 10.0;

/// Points that are spread evenly over a sweep tell its velocity with twelve times the variance of its pose. With 4 or
/// 30 the errors of all worlds tried are within 5 % of the same.
constexpr double kVelocityVariance = 12.0;

/// The velocity to begin with is as good as ten poses' noise.
constexpr double kFirstVariance = 100.0;

constexpr double kForgetting = 0.97;  // about 30 scans of memory; 0.95 and 0.99 do as well

}  // namespace

void AxisVelocity::begin(double velocity)
{
  filters_ = {};
  for (Filter& filter : filters_) {
    filter.state[1] = velocity;
  }
  mean_ = {0.0, velocity, 0.0};
  measurements_ = 0.0;
  is_new_ = true;
}

void AxisVelocity::observe(const Measurement& measurement, double periods)
{
  double change = kLeastChange * measurement.variance;
  for (Filter& filter : filters_) {
    if (is_new_) {
      filter.covariance.diagonal() = measurement.variance * Eigen::Vector3d(1.0, kFirstVariance, kFirstVariance);
    }
    filter.predict(measurement, periods, change);
    filter.forget();
    filter.correct(0, 0.0, measurement.variance);
    filter.correct(1, measurement.velocity, kVelocityVariance * measurement.variance);
    change *= kStep;
  }
  is_new_ = false;
  measurements_ = kForgetting * measurements_ + 2.0;
  weigh();
}

/// Constant acceleration, disturbed by white noise. The state is seen from the new pose.
void AxisVelocity::Filter::predict(const Measurement& measurement, double periods, double change)
{
  const double t = periods;
  Eigen::Matrix3d transition;
  transition << 1.0, t, 0.5 * t * t, 0.0, 1.0, t, 0.0, 0.0, 1.0;
  Eigen::Matrix3d noise;
  noise << t * t * t * t * t / 20.0, t * t * t * t / 8.0, t * t * t / 6.0, t * t * t * t / 8.0, t * t * t / 3.0,
      t * t / 2.0, t * t * t / 6.0, t * t / 2.0, t;
  state = transition * state;
  state[0] -= measurement.displacement;
  covariance = transition * covariance * transition.transpose() + change * noise;
}

void AxisVelocity::Filter::correct(int component, double measured, double variance)
{
  const double innovation = measured - state[component];
  const double innovation_variance = covariance(component, component) + variance;
  const Eigen::Vector3d gain = covariance.col(component) / innovation_variance;
  state += innovation * gain;
  covariance -= innovation_variance * gain * gain.transpose();
  squares += innovation * innovation / innovation_variance;
  spread += std::log(innovation_variance);
}

void AxisVelocity::Filter::forget()
{
  squares *= kForgetting;
  spread *= kForgetting;
}

/// The filters' mean by their likelihood, given the noise's scale at which each is likeliest.
void AxisVelocity::weigh()
{
  constexpr double kNoNoise = 1e-12;
  std::array<double, kFilters> likelihood{};
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const double scale = std::max(filters_[i].squares / measurements_, kNoNoise);
    likelihood[i] = -0.5 * (measurements_ * std::log(scale) + filters_[i].spread);
  }
  const double most = *std::max_element(likelihood.begin(), likelihood.end());
  double sum = 0.0;
  mean_.setZero();
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const double weight = std::exp(likelihood[i] - most);
    mean_ += weight * filters_[i].state;
    sum += weight;
  }
  mean_ /= sum;
}

}  // namespace pcl_floam
