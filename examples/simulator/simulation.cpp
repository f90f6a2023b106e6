#include "simulation.h"

#include "echo.h"
#include "ray_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

namespace pcl_floam::simulator {

namespace {

/// Streams of random numbers below this are the worlds' own; see Random.
constexpr std::uint64_t kSweepPurpose = 1000000;
constexpr std::uint64_t kUnitPurpose = 999999;

void check(bool ok, const char* message)
{
  if (!ok) {
    throw std::invalid_argument(message);
  }
}

SimulationOptions checked(const SimulationOptions& options)
{
  check(options.range_noise >= 0.0 && options.range_noise < 10.0, "the range noise must be from 0 to 10 m");
  check(options.dropout >= 0.0 && options.dropout <= 1.0, "the dropout must be a fraction from 0 to 1");
  check(options.field_of_view >= 0.0 && options.field_of_view <= 360.0,
        "the field of view must be from 0 to 360 degrees");
  check(options.gap_from <= options.gap_to, "the gap must not end before it begins");
  check(options.beam_divergence >= 0.0 && options.beam_divergence < 0.1, "the beam must be from 0 to 0.1 rad wide");
  check(options.path >= 1 && options.path < 1000, "the path must be from 1 to 999");
  check(!options.standing || std::isfinite(*options.standing), "the place to stand at must be finite");
  check(options.reach >= 0.0, "the reach must not be negative");
  check(options.carrier >= 0.0 && options.carrier <= 10.0, "the carrier must be from 0 to 10 m behind the sensor");
  check(options.start >= 0.0, "the start must not be negative");
  check(std::abs(options.nod) <= 1.0 && options.nod_rate >= 0.0 && options.nod_rate <= 10.0,
        "the sensor must nod by at most 57 degrees and 10 times a second");
  const Weather& weather = options.weather;
  check(weather.rain >= 0.0 && weather.rain <= 200.0, "the rain must be from 0 to 200 mm/h");
  check(weather.snow >= 0.0 && weather.snow <= 20.0, "the snow must be from 0 to 20 mm/h of water");
  check(weather.dust >= 0.0 && weather.dust <= 1.0, "the dust's extinction must be from 0 to 1 1/m");
  check(weather.stray >= 0.0 && weather.stray <= 1.0, "stray returns must be a part of the beams, from 0 to 1");
  check(!options.speed || (*options.speed >= 1.0 && *options.speed <= 60.0), "the speed must be from 1 to 60 m/s");
  check(options.rate >= 1.0 && options.rate <= 100.0, "the rate must be from 1 to 100 sweeps a second");
  return options;
}

WorldOptions worldOptions(const SimulationOptions& options)
{
  return {options.seed,   options.smooth, options.path,  options.truck,
          options.family, options.begin,  options.speed, options.trajectory};
}

/// Other ways through a world see other noise.
std::uint64_t sweepPurpose(const SimulationOptions& options, std::size_t number)
{
  return kSweepPurpose * static_cast<std::uint64_t>(options.path) + number;
}

Eigen::Vector3d directionOf(double azimuth, double elevation)
{
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

void resize(Sweep& sweep, std::size_t size)
{
  sweep.cloud.points.resize(size);
  sweep.exact_at_end.resize(size);
  sweep.moving.resize(size);
  sweep.ghost.resize(size);
}

/// The echo of the front of what carries the sensor, \p behind m behind it, if the beam meets it.
std::optional<Echo> carrierEcho(double behind, const Eigen::Vector3d& beam)
{
  constexpr double kHalfWidth = 1.25;  // m
  constexpr double kTop = 1.0;         // m above the sensor
  constexpr double kBottom = -1.5;     // m
  if (behind <= 0.0 || beam.x() >= 0.0) {
    return std::nullopt;
  }
  const double distance = -behind / beam.x();
  const Eigen::Vector3d place = distance * beam;
  if (std::abs(place.y()) > kHalfWidth || place.z() > kTop || place.z() < kBottom) {
    return std::nullopt;
  }
  RayHit hit;
  hit.distance = static_cast<float>(distance);
  hit.incidence_cosine = static_cast<float>(-beam.x());
  hit.reflectivity = 0.4F;
  hit.moving = true;
  return Echo{hit, false};
}

/// Intensity as Velodyne gives it: 0 to 255.
float intensityOf(const RayHit& hit, Random& random)
{
  const double brightness = hit.reflectivity * std::sqrt(static_cast<double>(hit.incidence_cosine));
  return static_cast<float>(std::clamp(255.0 * brightness + 3.0 * random.normal(), 0.0, 255.0));
}

}  // namespace

Eigen::Matrix3d RollPitchYaw::rotation() const
{
  BodyState turned = BodyState::Zero();
  turned.tail<3>() << yaw, pitch, roll;
  return poseOf(turned).rotation;
}

struct Simulation::WorldModel {
  explicit WorldModel(World made) : world(std::move(made)), scene(world.still)
  {
    for (const MovingObject& object : world.moving) {
      scene.addMoving(object.shape);
    }
  }

  World world;
  RayScene scene;
};

/// One column: all lasers at once.
struct Simulation::Firing {
  int column;
  double phase;     // columns by which the turn begins later
  double fraction;  // of the sweep, in [0, 1)
  double time;      // s after the sweep's start
  SE3 world_T_sensor;
  SE3 end_T_sensor;
};

Simulation::Simulation(const SimulationOptions& options) : options_(checked(options))
{
  world_ = std::make_unique<WorldModel>(makeWorld(options_.world, worldOptions(options_)));
  lidar_ = lidar(options_.sensor.empty() ? world_->world.default_sensor : options_.sensor);
  if (lidar_.pattern != ScanPattern::flash) {
    // The lasers fire at a fixed rate: a faster head has fewer columns.
    lidar_.columns = static_cast<int>(std::lround(lidar_.columns * 10.0 / options_.rate));
  }
  GivenErrors given = options_.errors;
  if (options_.beam_divergence > 0.0) {
    given["beam-divergence"] = 1e3 * options_.beam_divergence;
  }
  unit_ = SensorUnit(sensorErrors(options_.realism, lidar_.name, given), lidar_.rings(),
                     randomOf(options_.family, options_.seed, kUnitPurpose));
  frame_R_sensor_ = options_.turned_frame.rotation().transpose();
  const double length = motion().duration() - options_.start;
  check(length * options_.rate >= 1.0, "the start lies beyond the end of the world's path");
  size_ = static_cast<std::size_t>(std::floor(length * options_.rate + 1e-9));
}

Simulation::~Simulation() = default;

const MotionSpline& Simulation::motion() const
{
  return world_->world.sensor_motion;
}

double Simulation::accelerationBound() const
{
  return world_->world.acceleration;
}

SE3 Simulation::sensorPose(double t) const
{
  const double started = std::clamp(options_.start + t, 0.0, 1.0);  // s
  const double risen = started * started * (3.0 - 2.0 * started);
  const RollPitchYaw nodding{
      0.0, risen * options_.nod * std::sin(2.0 * M_PI * options_.nod_rate * (options_.start + t)), 0.0};
  const SE3 body_T_sensor{nodding.rotation() * unit_.tilt(options_.start + t) * options_.mount.rotation(),
                          Eigen::Vector3d::Zero()};
  if (options_.standing) {
    const SE3 world_T_path = motion().pose(options_.start);
    return world_T_path * SE3{Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, *options_.standing, 0.0)} *
           body_T_sensor;
  }
  return motion().pose(options_.start + t) * body_T_sensor;
}

SE3 Simulation::worldTSensor(double t) const
{
  return sensorPose(t) * SE3{frame_R_sensor_.transpose(), Eigen::Vector3d::Zero()};
}

void Simulation::placeMovingObjects(double start_time, double end_time)
{
  const std::vector<MovingObject>& objects = world_->world.moving;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const MotionSpline& path = objects[i].motion;
    world_->scene.place(i, path.pose(options_.start + start_time), path.pose(options_.start + end_time));
  }
  world_->scene.commit();
}

bool Simulation::isBlind(double azimuth, double time) const
{
  const bool outside =
      options_.field_of_view < 360.0 && std::abs(azimuth) > 0.5 * options_.field_of_view * M_PI / 180.0;
  return outside || (time >= options_.gap_from && time < options_.gap_to);
}

void Simulation::fire(const Firing& firing, Random& random, Sweep& sweep) const
{
  const double time = sweep.start_time + firing.time;
  const EchoModel model(lidar_, unit_.errors(), options_.weather);
  for (int ring = 0; ring < lidar_.rings(); ++ring) {
    const auto [azimuth, elevation] =
        lidar_.direction(ring, firing.column + firing.phase, options_.start + time, options_.rotation);
    const bool blind = isBlind(azimuth, time);
    const Eigen::Vector3d told = directionOf(azimuth, elevation);
    const Eigen::Vector3d beam = unit_.beam(ring, azimuth + unit_.headError(options_.start + time), elevation);
    const Pulse pulse{firing.world_T_sensor, beam, firing.fraction};
    std::optional<Echo> echo = blind ? std::nullopt : carrierEcho(options_.carrier, beam);
    if (!echo && !blind) {
      echo = model.echo(world_->scene, pulse, random);
    }
    const bool near = echo && (options_.reach == 0.0 || static_cast<double>(echo->hit.distance) <= options_.reach);
    const bool seen = near && !random.chance(options_.dropout);
    if (!seen && !options_.organized) {
      continue;
    }
    const double exact = seen ? echo->hit.distance : std::numeric_limits<double>::quiet_NaN();
    const double noisy = exact + options_.range_noise * random.normal();
    const double range = seen ? unit_.measured(noisy, ring, options_.start + time, echo->hit) : noisy;
    const Eigen::Vector3f point = (frame_R_sensor_ * (range * told)).cast<float>();
    const float intensity = seen ? intensityOf(echo->hit, random) : 0.0F;
    const std::size_t place = options_.organized ? static_cast<std::size_t>(ring * lidar_.columns + firing.column)
                                                 : sweep.cloud.points.size();
    if (!options_.organized) {
      resize(sweep, place + 1);
    }
    sweep.cloud.points[place] = PointXYZIRT(point.x(), point.y(), point.z(), intensity,
                                            static_cast<std::uint16_t>(ring), static_cast<float>(firing.time));
    sweep.exact_at_end[place] = (firing.end_T_sensor * (exact * beam)).cast<float>();
    sweep.moving[place] = seen && echo->hit.moving ? 1 : 0;
    sweep.ghost[place] = seen && echo->ghost ? 1 : 0;
  }
}

Sweep Simulation::sweep(std::size_t number)
{
  const double duration = 1.0 / options_.rate;
  Sweep sweep;
  sweep.number = number;
  sweep.start_time = static_cast<double>(number) / options_.rate;
  sweep.end_time = static_cast<double>(number + 1) / options_.rate;
  sweep.world_T_start = worldTSensor(sweep.start_time);
  sweep.world_T_middle = worldTSensor(sweep.start_time + 0.5 * duration);
  sweep.world_T_end = worldTSensor(sweep.end_time);
  placeMovingObjects(sweep.start_time, sweep.end_time);
  const auto all = static_cast<std::size_t>(lidar_.rings() * lidar_.columns);
  sweep.cloud.points.reserve(all);
  if (options_.organized) {
    resize(sweep, all);
  }
  Random random = randomOf(options_.family, options_.seed, sweepPurpose(options_, number));
  const bool turns = lidar_.pattern == ScanPattern::turning;
  const double phase =
      turns && unit_.errors().firing_phase > 0.0 ? unit_.errors().firing_phase * random.uniform() : 0.0;
  const SE3 end_T_world = sweep.world_T_end.inverse();
  for (int column = 0; column < lidar_.columns; ++column) {
    // A flash is one instant, the middle of the sweep.
    const double fraction = lidar_.pattern == ScanPattern::flash ? 0.5 : (column + phase) / lidar_.columns;
    // Where the sensor was when it really fired; what is told is the time when it should have.
    const double jitter = unit_.errors().time_jitter > 0.0 ? unit_.errors().time_jitter * random.normal() : 0.0;
    const SE3 pose = sensorPose(sweep.start_time + fraction * duration + jitter);
    fire({column, phase, fraction, fraction * duration, pose, end_T_world * pose}, random, sweep);
  }
  sweep.cloud.height = options_.organized ? static_cast<std::uint32_t>(lidar_.rings()) : 1;
  sweep.cloud.width = static_cast<std::uint32_t>(sweep.cloud.points.size()) / sweep.cloud.height;
  sweep.cloud.is_dense = !options_.organized;
  return sweep;
}

}  // namespace pcl_floam::simulator
