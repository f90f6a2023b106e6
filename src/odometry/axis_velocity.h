/// \file axis_velocity.h
/// How quickly the sensor moves along or about one of its axes, from all scans so far.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace pcl_floam {

/// Kalman filters of displacement, velocity and acceleration, side by side.
///
/// The acceleration is taken to change at random, and each filter has its own idea of how much: that of a car changes
/// less than that of a sensor in the hand. How well each has predicted the measurements so far, the last few dozens
/// above all, says what its estimate is worth (multiple-model estimation: Magill 1965), so that there is nothing to set
/// for a platform. Only the ratio of the acceleration's change to the measurements' noise matters: their common scale
/// is estimated, too.
class AxisVelocity {
public:
  /// What one scan says, in m or rad and periods.
  struct Measurement {
    double displacement;       ///< since the last scan's pose
    double velocity;           ///< per period, within the sweep, at its middle
    double variance;           ///< of the pose, > 0, up to a factor that all scans share
    double velocity_variance;  ///< of the velocity, > 0, up to the same factor
  };

  /// Begins anew.
  /// \param velocity per period, roughly known
  void begin(double velocity);

  /// \param periods since the last scan, > 0
  void observe(const Measurement& measurement, double periods);

  [[nodiscard]] double velocity() const { return mean_[1]; }      ///< per period
  [[nodiscard]] double acceleration() const { return mean_[2]; }  ///< per period^2

private:
  struct Filter {
    /// Displacement from the last scan's pose to where the sensor really was, velocity, acceleration.
    Eigen::Vector3d state = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double squared_innovations = 0.0;  ///< sum of them, over their variances
    double log_variances = 0.0;        ///< sum of the logarithms of the innovations' variances

    void predict(const Measurement& measurement, double periods, double noise_density);
    void correct(int component, double measured, double variance);
    void forget();
  };

  void weigh();

  static constexpr std::size_t kFilters = 15;
  std::array<Filter, kFilters> filters_;
  double measurements_ = 0.0;  ///< number of them, as far as they are remembered
  double log_variance_ = 0.0;  ///< mean logarithm of the poses' variances, as far as they are remembered
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

}  // namespace pcl_floam
