#include "sensor_errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace pcl_floam::simulator {

namespace {

constexpr double kDegree = M_PI / 180.0;  // rad
constexpr double kWarmUp = 600.0;         // s until a sensor has nearly reached the temperature it stays at
constexpr double kGrazingLimit = 0.2;     // m, greatest bias with incidence that Laconte et al. found

/// What spinning lidars have in common.
///
/// Biases of range and angles, and their drift while warming up: C. Glennie and D. Lichti, "Static Calibration and
/// Analysis of the Velodyne HDL-64E S2 for High Accuracy Mobile Scanning", Remote Sensing 2 (2010); C. Glennie,
/// A. Kusari and A. Facchin, "Calibration and Stability Analysis of the VLP-16 Laser Scanner", ISPRS Archives XL-3/W4
/// (2016). Bias with incidence, up to 20 cm: J. Laconte, S.-P. Deschenes, M. Labussiere and F. Pomerleau, "Lidar
/// Measurement Bias Estimation via Return Waveform Modelling in a Context of 3D Mapping", ICRA 2019.
SensorErrors spinning()
{
  SensorErrors errors;
  errors.range_bias = 0.01;
  errors.range_drift = 0.003;
  errors.elevation_error = 0.07 * kDegree;
  errors.azimuth_error = 0.07 * kDegree;
  errors.grazing_bias = 0.1;
  errors.reflectivity_bias = 0.01;
  errors.glass = 1.0;
  // Suspensions of cars give by a degree for some 0.2 g (T. Gillespie, "Fundamentals of Vehicle Dynamics", 1992):
  // people who shift their weight, and gusts, tilt them by hundredths.
  errors.sway = 0.02 * kDegree;
  return errors;
}

/// By the makers' data sheets: width of the beam and the steps that ranges are told in. Velodyne's packets hold 1.33 ms
/// of firings (VLP-16: 24 of 55.3 us) and one time stamp, which drivers long gave to all of them: as evenly spread over
/// a packet, 0.38 ms; Ouster stamps each column.
SensorErrors realErrors(std::string_view sensor)
{
  SensorErrors errors = spinning();
  const bool ouster = sensor.substr(0, 2) == "os";
  if (lidar(sensor).pattern != ScanPattern::turning) {
    // Livox's data sheets: 2 cm of range noise, 0.1 to 0.15 degrees of angle, beams of 0.03 to 0.28 degrees.
    errors.range_step = 0.001;
    errors.beam_divergence = 0.003;
    errors.elevation_error = errors.azimuth_error = 0.07 * kDegree;
    return errors;
  }
  errors.range_step = ouster ? 0.001 : 0.002;
  errors.time_jitter = ouster ? 0.0 : 3.8e-4;
  // Velodyne's lasers fire by their own clock, whatever the head's angle, which is told in steps of 0.01 degrees and
  // taken to grow evenly between the two of a packet; Ouster's encoder fires them.
  errors.firing_phase = ouster ? 0.0 : 1.0;
  errors.head_wander = (ouster ? 0.005 : 0.012) * kDegree;
  errors.beam_divergence = sensor == "hdl64" ? 0.002 : (sensor == "hdl32" ? 0.0028 : 0.003);
  // On even roads the rings of KITTI's HDL-64 lie so far, root mean square, off the surface through all of them. The
  // 0.2 degrees that it needs in the mean (J.-E. Deschaud, "IMLS-SLAM", ICRA 2018) is common to its lasers.
  errors.elevation_error = (sensor == "hdl64" ? 0.055 : 0.07) * kDegree;
  return errors;
}

}  // namespace

const std::vector<SensorErrorOption>& sensorErrorOptions()
{
  static const std::vector<SensorErrorOption> options{
      {"range-bias", &SensorErrors::range_bias, 1.0, 1.0,
       "Each laser's own error of range, standard deviation in metres"},
      {"range-drift", &SensorErrors::range_drift, 1.0, 1.0,
       "What warming up adds to it in some ten minutes, standard deviation in metres"},
      {"elevation-error", &SensorErrors::elevation_error, kDegree, 5.0,
       "Each laser's own error of its vertical angle, standard deviation in degrees"},
      {"azimuth-error", &SensorErrors::azimuth_error, kDegree, 5.0,
       "Each laser's own error of its horizontal angle, standard deviation in degrees"},
      {"grazing-bias", &SensorErrors::grazing_bias, 1.0, 1.0,
       "Slanting surfaces seem nearer by this part of the footprint's depth, up to 0.2 m; needs a wide beam"},
      {"reflectivity-bias", &SensorErrors::reflectivity_bias, 1.0, 1.0, "Metres that black seems farther than white"},
      {"beam-divergence", &SensorErrors::beam_divergence, 1e-3, 100.0,
       "Width of the beam in mrad (VLP-16: 3): at depth edges returns lie between near and far"},
      {"range-step", &SensorErrors::range_step, 1.0, 1.0, "Ranges are multiples of so many metres"},
      {"time-jitter", &SensorErrors::time_jitter, 1e-3, 10.0, "Error of the columns' times, standard deviation in ms"},
      {"firing-phase", &SensorErrors::firing_phase, 1.0, 1.0,
       "Part of a column, 0 to 1, by which turns begin at another angle than the one before"},
      {"head-wander", &SensorErrors::head_wander, kDegree, 1.0,
       "The head's angle is told wrong, standard deviation in degrees, by other amounts from turn to turn"},
      {"sway", &SensorErrors::sway, kDegree, 5.0,
       "What carries the sensor sways on its springs, standard deviation of roll and pitch in degrees"},
      {"glass", &SensorErrors::glass, 1.0, 1.0,
       "Part, 0 to 1, of the gloss of panes and paint that has effect: returns are lost, and mirror images seen"}};
  return options;
}

SensorErrors sensorErrors(Realism realism, const std::string& sensor, const GivenErrors& given)
{
  SensorErrors errors = realism == Realism::real ? realErrors(sensor) : SensorErrors();
  for (const auto& [name, value] : given) {
    const auto& options = sensorErrorOptions();
    const auto option =
        std::find_if(options.begin(), options.end(), [&name = name](const auto& one) { return one.name == name; });
    if (option == options.end()) {
      throw std::invalid_argument("unknown error of sensors '" + name + "'");
    }
    if (!(value >= 0.0 && value <= option->limit)) {
      throw std::invalid_argument("the " + name + " must be from 0 to " + std::to_string(option->limit));
    }
    errors.*(option->value) = value * option->unit;
  }
  return errors;
}

SensorUnit::SensorUnit(const SensorErrors& errors, int lasers, Random random) : errors_(errors)
{
  for (int i = 0; i < lasers; ++i) {
    Laser laser;
    laser.range_bias = errors.range_bias * random.normal();
    laser.range_drift = errors.range_drift * random.normal();
    laser.elevation = errors.elevation_error * random.normal();
    laser.azimuth = errors.azimuth_error * random.normal();
    lasers_.push_back(laser);
  }
  // A motor's control lets its speed wander over a few turns; a carrier at rest settles over tens of seconds.
  head_ = SmoothNoise(random, errors.head_wander, 0.5, 8.0, 9);
  roll_ = SmoothNoise(random, errors.sway, 0.01, 0.1);
  pitch_ = SmoothNoise(random, errors.sway, 0.01, 0.1);
}

Eigen::Matrix3d SensorUnit::tilt(double time) const
{
  return (Eigen::AngleAxisd(pitch_(time), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_(time), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d SensorUnit::beam(int laser, double azimuth, double elevation) const
{
  if (!lasers_.empty()) {
    azimuth += lasers_[static_cast<std::size_t>(laser)].azimuth;
    elevation += lasers_[static_cast<std::size_t>(laser)].elevation;
  }
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

double SensorUnit::measured(double range, int laser, double time, const RayHit& hit) const
{
  if (!lasers_.empty()) {
    const Laser& own = lasers_[static_cast<std::size_t>(laser)];
    range += own.range_bias + own.range_drift * (1.0 - std::exp(-time / kWarmUp));
  }
  const double cosine = std::max(static_cast<double>(hit.incidence_cosine), 1e-3);
  const double footprint = range * errors_.beam_divergence * std::sqrt(1.0 - std::min(1.0, cosine * cosine)) / cosine;
  range -= std::min(errors_.grazing_bias * footprint, kGrazingLimit);
  range += errors_.reflectivity_bias * (1.0 - static_cast<double>(hit.reflectivity));
  return errors_.range_step > 0.0 ? errors_.range_step * std::round(range / errors_.range_step) : range;
}

}  // namespace pcl_floam::simulator
