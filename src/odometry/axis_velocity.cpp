#include "odometry/axis_velocity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Variance of the acceleration's change within one period, over that of a usual pose: of the first filter, and by how
/// much it grows from one filter to the next.
constexpr double kLeastAxisChange = 1e-8;
constexpr double kStep = 10.0;

/// Velocity and acceleration to begin with are as good as ten poses' noise.
constexpr double kFirstVariance = 100.0;

constexpr double kAxisForgetting = 0.97;  // about 30 scans of memory; on the same recordings 0.95 and 0.99 did as well

}  // namespace

void AxisVelocity::begin(double velocity)
{
  filters_ = {};
  for (Filter& filter : filters_) {
    filter.state[1] = velocity;
  }
  mean_ = {0.0, velocity, 0.0};
  measurements_ = 0.0;
}

void AxisVelocity::observe(const Measurement& measurement, double periods)
{
  // A poorly known pose does not mean that the sensor moves otherwise: the noise is that of usual poses.
  const double log_variance = std::log(measurement.variance);
  const bool is_first = !(measurements_ > 0.0);
  log_variance_ = is_first ? log_variance : kAxisForgetting * log_variance_ + (1.0 - kAxisForgetting) * log_variance;
  double noise_density = kLeastAxisChange * std::exp(log_variance_);
  for (Filter& filter : filters_) {
    if (is_first) {
      filter.covariance.diagonal() = measurement.variance * Eigen::Vector3d(1.0, kFirstVariance, kFirstVariance);
    }
    filter.predict(measurement, periods, noise_density);
    filter.forget();
    filter.correct(0, 0.0, measurement.variance);
    filter.correct(1, measurement.velocity, measurement.velocity_variance);
    noise_density *= kStep;
  }
  measurements_ = kAxisForgetting * measurements_ + 2.0;
  weigh();
}

/// Constant acceleration, disturbed by white noise (the Wiener process acceleration model, Bar-Shalom et al. 2001). The
/// state is seen from the new pose.
void AxisVelocity::Filter::predict(const Measurement& measurement, double periods, double noise_density)
{
  const double t = periods;
  Eigen::Matrix3d transition;
  transition << 1.0, t, 0.5 * t * t, 0.0, 1.0, t, 0.0, 0.0, 1.0;
  Eigen::Matrix3d noise;
  noise << t * t * t * t * t / 20.0, t * t * t * t / 8.0, t * t * t / 6.0, t * t * t * t / 8.0, t * t * t / 3.0,
      t * t / 2.0, t * t * t / 6.0, t * t / 2.0, t;
  state = transition * state;
  state[0] -= measurement.displacement;
  covariance = transition * covariance * transition.transpose() + noise_density * noise;
}

void AxisVelocity::Filter::correct(int component, double measured, double variance)
{
  const double innovation = measured - state[component];
  const double innovation_variance = covariance(component, component) + variance;
  const Eigen::Vector3d gain = covariance.col(component) / innovation_variance;
  state += innovation * gain;
  const Eigen::Matrix3d left = covariance - innovation_variance * gain * gain.transpose();
  covariance = 0.5 * (left + left.transpose());
  squared_innovations += innovation * innovation / innovation_variance;
  log_variances += std::log(innovation_variance);
}

void AxisVelocity::Filter::forget()
{
  squared_innovations *= kAxisForgetting;
  log_variances *= kAxisForgetting;
}

/// The filters' mean by their likelihood, given the noise's scale at which each is likeliest.
void AxisVelocity::weigh()
{
  constexpr double kNoNoise = 1e-12;
  std::array<double, kFilters> likelihood{};
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const double scale = std::max(filters_[i].squared_innovations / measurements_, kNoNoise);
    likelihood[i] = -0.5 * (measurements_ * std::log(scale) + filters_[i].log_variances);
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
