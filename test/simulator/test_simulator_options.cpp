// What the options of the simulator do to its sweeps and worlds.

#include "simulation.h"
#include "support/constants.h"
#include "world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

using pcl_floam::test::kPi;

SimulationOptions optionsFor(const std::string& world)
{
  SimulationOptions options;
  options.world = world;
  options.sensor = "vlp16";
  options.start = 4.0;
  return options;
}

/// How far the measured points are from the exact ones, m, root mean square.
double rangeError(const Simulation& simulation, const Sweep& sweep)
{
  double squares = 0.0;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const SE3 world_T_sensor = simulation.worldTSensor(sweep.start_time + static_cast<double>(sweep.cloud[i].time));
    const Eigen::Vector3d exact = world_T_sensor.inverse() * (sweep.world_T_end * sweep.exact_at_end[i].cast<double>());
    const double error = exact.norm() - static_cast<double>(sweep.cloud[i].getVector3fMap().norm());
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(sweep.cloud.size()));
}

/// Share of the full turn, seen from above, in which a nearer return than \p range of a moving object lies.
double shareOfView(const Sweep& sweep, float range)
{
  std::array<bool, 360> seen{};
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    if (sweep.moving[i] != 0 && sweep.cloud[i].getVector3fMap().norm() < range) {
      const double degrees = std::atan2(sweep.cloud[i].y, sweep.cloud[i].x) * 180.0 / kPi;
      seen[static_cast<std::size_t>(degrees + 360.0) % 360] = true;
    }
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / 360.0;
}

bool sameSurfaces(const TriangleMesh& a, const TriangleMesh& b)
{
  return a.vertices == b.vertices && a.triangles == b.triangles && a.reflectivity == b.reflectivity;
}

}  // namespace

TEST(SimulatorOptions, RangeNoiseHasTheWantedDeviation)
{
  for (const double sigma : {0.0, 0.01, 0.05}) {
    SimulationOptions options = optionsFor("warehouse");
    options.range_noise = sigma;
    Simulation simulation(options);
    EXPECT_NEAR(rangeError(simulation, simulation.sweep(2)), sigma, 0.03 * sigma + 1e-4);
  }
}

TEST(SimulatorOptions, NothingIsSeenOutsideTheFieldOfView)
{
  SimulationOptions options = optionsFor("room");
  options.range_noise = 0.0;
  Simulation whole(options);
  options.field_of_view = 120.0;
  Simulation narrow(options);
  const Sweep sweep = narrow.sweep(0);
  for (const PointXYZIRT& point : sweep.cloud) {
    ASSERT_LE(std::abs(std::atan2(point.y, point.x)), 60.01 * kPi / 180.0);
  }
  const auto all = static_cast<double>(whole.sweep(0).cloud.size());
  EXPECT_NEAR(static_cast<double>(sweep.cloud.size()) / all, 1.0 / 3.0, 0.02);
}

TEST(SimulatorOptions, NothingReturnsInTheGap)
{
  SimulationOptions options = optionsFor("room");
  options.gap_from = 0.35;
  options.gap_to = 0.62;
  Simulation simulation(options);
  double last_before = 0.0;
  double first_after = 1.0;
  for (std::size_t number = 0; number < 8; ++number) {
    const Sweep sweep = simulation.sweep(number);
    for (const PointXYZIRT& point : sweep.cloud) {
      const double time = sweep.start_time + static_cast<double>(point.time);
      last_before = time < 0.5 ? std::max(last_before, time) : last_before;
      first_after = time > 0.5 ? std::min(first_after, time) : first_after;
    }
    EXPECT_EQ(sweep.cloud.empty(), number == 4 || number == 5) << "sweep " << number;
  }
  EXPECT_NEAR(last_before, 0.35, 1e-3);
  EXPECT_NEAR(first_after, 0.62, 1e-3);
}

TEST(SimulatorOptions, WideBeamsMeltNearAndFarAtEdgesOnly)
{
  SimulationOptions options = optionsFor("room");
  options.range_noise = 0.0;
  options.organized = true;
  Simulation sharp(options);
  options.beam_divergence = 0.003;
  Simulation wide(options);
  const Sweep a = sharp.sweep(0);
  const Sweep b = wide.sweep(0);
  std::size_t both = 0;
  std::size_t melted = 0;
  for (std::size_t i = 0; i < a.cloud.size(); ++i) {
    if (std::isfinite(a.cloud[i].x) && std::isfinite(b.cloud[i].x)) {
      const double change =
          static_cast<double>(b.cloud[i].getVector3fMap().norm() - a.cloud[i].getVector3fMap().norm());
      ASSERT_LT(std::abs(change), 0.76);
      ++both;
      melted += std::abs(change) > 0.03 ? 1 : 0;
    }
  }
  EXPECT_GT(melted, both / 1000);
  EXPECT_LT(melted, both / 10);
}

TEST(SimulatorOptions, OtherPathsGoThroughTheSameWorld)
{
  for (const std::string& name : worldNames()) {
    const World first = makeWorld(name, {7, false, 1, false});
    for (const int path : {2, 3}) {
      const World other = makeWorld(name, {7, false, path, false});
      EXPECT_TRUE(sameSurfaces(first.still, other.still)) << name;
      EXPECT_LE(other.sensor_motion.accelerationBound(), other.acceleration) << name << ' ' << path;
      double farthest = 0.0;
      for (double t = 0.0; t < std::min(first.sensor_motion.duration(), other.sensor_motion.duration()); t += 1.0) {
        const Eigen::Vector3d apart = first.sensor_motion.pose(t).translation - other.sensor_motion.pose(t).translation;
        farthest = std::max(farthest, apart.norm());
      }
      EXPECT_GT(farthest, 0.2) << name << ' ' << path;
    }
  }
}

TEST(SimulatorOptions, OtherPathsHaveOtherNoise)
{
  SimulationOptions options = optionsFor("room");
  const auto firstErrors = [&options] {
    Simulation simulation(options);
    const Sweep sweep = simulation.sweep(0);
    const SE3 sensor_T_world = simulation.worldTSensor(static_cast<double>(sweep.cloud[0].time)).inverse();
    return (sensor_T_world * (sweep.world_T_end * sweep.exact_at_end[0].cast<double>())).norm() -
           static_cast<double>(sweep.cloud[0].getVector3fMap().norm());
  };
  const double first = firstErrors();
  options.path = 2;
  EXPECT_GT(std::abs(firstErrors() - first), 1e-4);
}

TEST(SimulatorOptions, PathsOfARoomStayInIt)
{
  for (const int path : {1, 2, 3, 4}) {
    const MotionSpline warehouse = makeWorld("warehouse", {1, false, path, false}).sensor_motion;
    const MotionSpline corridor = makeWorld("corridor", {1, false, path, false}).sensor_motion;
    for (double t = 0.0; t < warehouse.duration(); t += 0.5) {
      const Eigen::Vector3d place = warehouse.pose(t).translation;
      ASSERT_LT(std::abs(place.x()), 26.0) << path;
      ASSERT_LT(std::abs(place.y()), 18.0) << path;
    }
    for (double t = 0.0; t < corridor.duration(); t += 0.5) {
      ASSERT_LT(std::abs(corridor.pose(t).translation.y()), 0.9) << path;
    }
  }
}

TEST(SimulatorOptions, TruckFillsAThirdOfTheView)
{
  for (const char* world : {"urban", "highway"}) {
    SimulationOptions options = optionsFor(world);
    Simulation without(options);
    options.truck = true;
    Simulation with(options);
    std::vector<double> shares;
    double usual = 0.0;
    for (std::size_t number = 0; number < 300; number += 20) {
      shares.push_back(shareOfView(with.sweep(number), 12.0F));
      usual = std::max(usual, shareOfView(without.sweep(number), 12.0F));
    }
    std::sort(shares.begin(), shares.end());
    EXPECT_GT(shares[shares.size() / 2], 0.3) << world;
    EXPECT_LT(usual, 0.3) << world;
  }
}

TEST(SimulatorOptions, TunnelIsTheSmoothCorridor)
{
  SimulationOptions options = optionsFor("tunnel");
  Simulation tunnel(options);
  options.world = "corridor";
  options.smooth = true;
  Simulation corridor(options);
  const Sweep a = tunnel.sweep(3);
  const Sweep b = corridor.sweep(3);
  ASSERT_EQ(a.cloud.size(), b.cloud.size());
  for (std::size_t i = 0; i < a.cloud.size(); ++i) {
    ASSERT_TRUE(a.cloud[i].getVector3fMap() == b.cloud[i].getVector3fMap());
  }
}

TEST(SimulatorOptions, RefusesWhatMakesNoSense)
{
  const auto refused = [](auto change) {
    SimulationOptions options = optionsFor("room");
    change(options);
    EXPECT_THROW(Simulation simulation(options), std::invalid_argument);
  };
  refused([](SimulationOptions& options) { options.field_of_view = -1.0; });
  refused([](SimulationOptions& options) { options.field_of_view = 361.0; });
  refused([](SimulationOptions& options) { options.gap_from = 1.0; });
  refused([](SimulationOptions& options) { options.beam_divergence = -0.1; });
  refused([](SimulationOptions& options) { options.path = 0; });
}

}  // namespace pcl_floam::simulator
