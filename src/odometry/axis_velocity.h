/// \file axis_velocity.h
/// How quickly the sensor moves along or about one of its axes, from all scans so far.
#pragma once

#include <Eigen/Core>

#include <array>

namespace pcl_floam {

/// Kalman filters of displacement, velocity and acceleration, side by side.
///
/// The acceleration is taken to change at random, and each filter has its own idea of how much: a car swerves less than
/// a hand. How well each has foretold the measurements so far, the last few dozens above all, says what its estimate is
/// worth (multiple-model estimation: Magill 1965), so that there is nothing to set for a platform. All that matters is
/// how much the acceleration changes compared with the measurements' noise: how large both are is estimated, too.
class AxisVelocity {
public:
  /// What one scan says, in m or rad and periods.
  struct Measurement {
    double displacement;  ///< since the last scan's pose
    double velocity;      ///< within the sweep, at its middle
    double variance;      ///< of the pose, up to a constant factor; > 0
  };

  /// Begins anew.
  /// \param velocity roughly known
  void begin(double velocity);

  /// \param periods since the last scan, > 0
  void observe(const Measurement& measurement, double periods);

  [[nodiscard]] double velocity() const { return mean_[1]; }      ///< per period
  [[nodiscard]] double acceleration() const { return mean_[2]; }  ///< per period^2

private:
  /// One filter.
  struct Filter {
    /// Displacement from the last scan's pose to where the sensor really was, velocity, acceleration.
    Eigen::Vector3d state = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double squares = 0.0;  ///< of what was not foretold, in standard deviations
    double spread = 0.0;   ///< sum of the logarithms of these variances

    void predict(const Measurement& measurement, double periods, double change);
    void correct(int component, double measured, double variance);
    void forget();
  };

  void weigh();

  static constexpr int kFilters = 15;
  std::array<Filter, kFilters> filters_;
  double measurements_ = 0.0;  ///< as far as they are remembered
  bool is_new_ = true;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

}  // namespace pcl_floam
