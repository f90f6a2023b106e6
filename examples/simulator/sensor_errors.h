/// \file sensor_errors.h
/// What real lidars do wrong: how much in all, and what one unit of them does.
#pragma once

#include "lidar.h"
#include "random.h"
#include "ray_scene.h"
#include "smooth_noise.h"

#include <Eigen/Core>

#include <map>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

/// Errors beside the range noise. As it stands: those of an ideal sensor.
struct SensorErrors {
  double range_bias = 0.0;         ///< m, standard deviation from laser to laser
  double range_drift = 0.0;        ///< m, standard deviation from laser to laser of what warming up adds to the bias
  double elevation_error = 0.0;    ///< rad, standard deviation from laser to laser
  double azimuth_error = 0.0;      ///< rad, standard deviation from laser to laser
  double grazing_bias = 0.0;       ///< part of the footprint's depth by which slanting surfaces seem nearer
  double reflectivity_bias = 0.0;  ///< m that black seems farther than white
  double beam_divergence = 0.0;    ///< rad, width of the beam
  double range_step = 0.0;         ///< m between the ranges that can be told
  double time_jitter = 0.0;        ///< s, standard deviation of when a column is fired from when it is told to be
  double firing_phase = 0.0;       ///< part of a column by which turns begin at other angles than the one before
  double head_wander = 0.0;        ///< rad, standard deviation of the head's angle from what is told of it
  double sway = 0.0;               ///< rad, standard deviation of roll and pitch of what carries the sensor, slowly
  double glass = 0.0;  ///< part of the gloss of glass and paint that has effect: lost returns, mirror images
};

/// Which errors a sensor has.
enum class Realism {
  ideal,  ///< none
  real    ///< those of its kind, from publications
};

/// An error as an option.
struct SensorErrorOption {
  std::string name;
  double SensorErrors::*value;
  double unit;   ///< the option's unit in that of the value
  double limit;  ///< in the option's unit
  std::string help;
};

/// Every error's option.
[[nodiscard]] const std::vector<SensorErrorOption>& sensorErrorOptions();

/// Errors that are given by their options' names, in the options' units, in place of the usual ones.
using GivenErrors = std::map<std::string, double>;

/// The errors of a kind of sensor.
/// \param sensor one of \ref lidarNames
/// \throws std::invalid_argument for a name that is no option's or a value out of its range
[[nodiscard]] SensorErrors sensorErrors(Realism realism, const std::string& sensor, const GivenErrors& given = {});

/// One unit of a kind of sensor: its lasers' own errors.
class SensorUnit {
public:
  /// An ideal one.
  SensorUnit() = default;

  /// \param random tells which unit it is
  SensorUnit(const SensorErrors& errors, int lasers, Random random);

  [[nodiscard]] const SensorErrors& errors() const { return errors_; }

  /// rad by which the head has turned farther than it is told to have.
  [[nodiscard]] double headError(double time) const { return head_(time); }

  /// How what carries the sensor is tilted.
  [[nodiscard]] Eigen::Matrix3d tilt(double time) const;

  /// Where a laser really points that is thought to point at \p azimuth and \p elevation, rad.
  [[nodiscard]] Eigen::Vector3d beam(int laser, double azimuth, double elevation) const;

  /// What is told of a range, m, with noise already.
  /// \param time s since the sensor was switched on
  [[nodiscard]] double measured(double range, int laser, double time, const RayHit& hit) const;

private:
  struct Laser {
    double range_bias = 0.0, range_drift = 0.0, elevation = 0.0, azimuth = 0.0;
  };

  SensorErrors errors_;
  std::vector<Laser> lasers_;
  SmoothNoise head_, roll_, pitch_;
};

}  // namespace pcl_floam::simulator
