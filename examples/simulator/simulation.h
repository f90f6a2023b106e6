/// \file simulation.h
/// A lidar's sweeps through a simulated world, with exact poses.
#pragma once

#include "lidar.h"
#include "motion_spline.h"
#include "sensor_errors.h"
#include "weather.h"
#include "world.h"

#include <pcl_floam/common/point_types.h>
#include <pcl_floam/common/se3.h>

#include <pcl/point_cloud.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

/// A rotation Rz(yaw) Ry(pitch) Rx(roll); rad.
struct RollPitchYaw {
  double roll = 0.0, pitch = 0.0, yaw = 0.0;

  [[nodiscard]] Eigen::Matrix3d rotation() const;
};

/// What is simulated. The same options give the same sweeps on every run.
struct SimulationOptions {
  std::string world = "warehouse";
  std::string sensor;         ///< empty: the world's usual one
  std::uint64_t seed = 1;     ///< of the world and of the noise
  double range_noise = 0.02;  ///< m, standard deviation
  double dropout = 0.0;       ///< fraction of the returns lost at random, beside those too weak to be seen
  double rate = 10.0;         ///< sweeps a second
  double start = 0.0;         ///< s into the world's motion where sweep 0 begins: a start in motion
  /// Instead of moving, the sensor stands so many m to the left of where the path is at the start.
  std::optional<double> standing;
  HeadRotation rotation = HeadRotation::clockwise;
  double reach = 0.0;    ///< m, nothing farther away is told of; 0: all that is seen
  double carrier = 0.0;  ///< m behind the sensor, the upright front of what carries it; 0: nothing of that is seen
  /// Two numbers, s after the start of sweep 0: nothing returns from the one to the other. Equal: no gap.
  double gap_from = 0.0, gap_to = 0.0;
  double field_of_view = 360.0;  ///< degrees about the forward direction; what lies outside is never seen
  /// rad; the beam's width. At depth edges a part of the returns then lies between the near and the far surface.
  double beam_divergence = 0.0;
  Realism realism = Realism::ideal;
  GivenErrors errors;  ///< in place of what \ref realism says of them
  Weather weather;
  RollPitchYaw mount;         ///< how the sensor is mounted on what carries it: tilted, upside down
  double nod = 0.0;           ///< rad: what carries it nods so far up and down, from the first second on ...
  double nod_rate = 1.0;      ///< ... so often a second
  RollPitchYaw turned_frame;  ///< of the frame that points and poses are given in, against the sensor's own
  bool smooth = false;        ///< see WorldOptions::smooth
  int path = 1;               ///< see WorldOptions::path
  bool truck = false;         ///< see WorldOptions::truck
  Family family = Family::tune;
  Begin begin = Begin::rest;    ///< see WorldOptions::begin
  std::optional<double> speed;  ///< m/s, see WorldOptions::speed
  TrajectoryPart trajectory;    ///< see WorldOptions::trajectory
  bool organized = false;       ///< clouds of rings x columns with NaN where there is no return
};

/// One turn of the head, or what a lidar without one sees in as long.
///
/// Points are in the sensor's frame *at their own time*, as a real sensor gives them: x forward, y left, z up, m. They
/// come in firing order, column by column, and within a column by ring; an organised cloud has one row per ring. Rings
/// of lidars whose head does not turn are lasers, of a flash rows of pixels.
struct Sweep {
  std::size_t number = 0;
  double start_time = 0.0;  ///< s; the sweep covers start_time to end_time
  double end_time = 0.0;    ///< s
  pcl::PointCloud<PointXYZIRT> cloud;
  /// For each point of \ref cloud: where it would lie, without range noise, had it been measured at the sweep's end.
  std::vector<Eigen::Vector3f> exact_at_end;
  /// For each point of \ref cloud: 1 if it lies on a moving object.
  std::vector<std::uint8_t> moving;
  /// For each point of \ref cloud: 1 if no surface is there: mirror images, rain, snow, dust, stray light.
  std::vector<std::uint8_t> ghost;
  SE3 world_T_start, world_T_middle, world_T_end;  ///< the sensor's exact poses
};

/// A world, a sensor in it, and the sweeps it takes back to back.
///
/// Any sweep can be asked for in any order. Not to be used by two threads at once.
class Simulation {
public:
  /// \throws std::invalid_argument if an option is out of its range or names something unknown
  explicit Simulation(const SimulationOptions& options);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Number of whole sweeps until the world's motion ends.
  [[nodiscard]] std::size_t size() const { return size_; }

  [[nodiscard]] const Lidar& sensor() const { return lidar_; }

  /// Simulates sweep \p number.
  [[nodiscard]] Sweep sweep(std::size_t number);

  /// The errors that the sensor has.
  [[nodiscard]] const SensorErrors& errors() const { return unit_.errors(); }

  /// The exact pose \p t seconds after the start of sweep 0 of the frame that points are given in.
  [[nodiscard]] SE3 worldTSensor(double t) const;

  /// The sensor's motion; sweep 0 begins \ref startTime seconds into it.
  [[nodiscard]] const MotionSpline& motion() const;
  [[nodiscard]] double startTime() const { return options_.start; }

  /// Bound on the sensor's acceleration that the world declares, m/s^2.
  [[nodiscard]] double accelerationBound() const;

private:
  struct WorldModel;
  struct Firing;

  void placeMovingObjects(double start_time, double end_time);
  void fire(const Firing& firing, Random& random, Sweep& sweep) const;
  [[nodiscard]] bool isBlind(double azimuth, double time) const;
  [[nodiscard]] SE3 sensorPose(double t) const;

  SimulationOptions options_;
  std::unique_ptr<WorldModel> world_;
  Lidar lidar_;
  SensorUnit unit_;
  Eigen::Matrix3d frame_R_sensor_ = Eigen::Matrix3d::Identity();
  std::size_t size_ = 0;
};

}  // namespace pcl_floam::simulator
