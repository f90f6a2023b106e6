// Rain, snow and dust; sensors that are mounted askew; frames that are turned.

#include "simulation.h"
#include "support/constants.h"
#include "weather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pcl_floam::simulator {

namespace {

using pcl_floam::test::kPi;

SimulationOptions tunnel()
{
  SimulationOptions options;
  options.world = "tunnel";
  options.sensor = "vlp16";
  options.range_noise = 0.0;
  options.start = 4.0;
  return options;
}

double shareOfGhosts(const Sweep& sweep)
{
  return static_cast<double>(std::count(sweep.ghost.begin(), sweep.ghost.end(), 1)) /
         static_cast<double>(sweep.cloud.size());
}

Sweep sweepIn(const Weather& weather)
{
  SimulationOptions options = tunnel();
  options.weather = weather;
  return Simulation(options).sweep(0);
}

/// m from the walls, floor and ceiling of a tunnel that is 2.4 m wide and 2.7 m high; the farthest point of a sweep.
double farthestFromWalls(const Simulation& simulation, const Sweep& sweep)
{
  double farthest = 0.0;
  for (const PointXYZIRT& point : sweep.cloud) {
    const SE3 world_T_sensor = simulation.worldTSensor(sweep.start_time + static_cast<double>(point.time));
    const Eigen::Vector3d p = world_T_sensor * point.getVector3fMap().cast<double>();
    const double off = std::min({std::abs(std::abs(p.y()) - 1.2), std::abs(p.z()), std::abs(p.z() - 2.7)});
    farthest = std::max(farthest, off);
  }
  return farthest;
}

}  // namespace

TEST(Mounts, TheCarrierIsSeenAtItsPlace)
{
  SimulationOptions options = tunnel();
  options.carrier = 0.8;
  const Sweep sweep = Simulation(options).sweep(0);
  std::size_t seen = 0;
  for (const PointXYZIRT& point : sweep.cloud) {
    seen += std::abs(point.x + 0.8F) < 1e-3F ? 1 : 0;
    ASSERT_FALSE(point.x < -0.81F && std::abs(point.y) < std::abs(point.x)) << "hidden by it";
  }
  EXPECT_GT(seen, 1000U);
}

TEST(Mounts, NothingBeyondTheReachIsToldOf)
{
  SimulationOptions options = tunnel();
  options.reach = 5.0;
  const Sweep sweep = Simulation(options).sweep(0);
  EXPECT_GT(sweep.cloud.size(), 1000U);
  for (const PointXYZIRT& point : sweep.cloud) {
    ASSERT_LE(point.getVector3fMap().norm(), 5.001F);
  }
  options.reach = -1.0;
  EXPECT_THROW(Simulation{options}, std::invalid_argument);
}

TEST(Weather, HeavyRainDimsAsTheRadioUnionSays)
{
  // 1.076 * 25^0.67 = 9.3 dB/km: over 100 m there and back 1.86 dB.
  EXPECT_NEAR(Weather({25.0, 0.0, 0.0}).transmission(100.0), std::pow(10.0, -0.186), 0.005);
  EXPECT_EQ(Weather().transmission(100.0), 1.0);
}

/// Of beams that see nothing, too.
TEST(Weather, StrayLightReturnsFromAnywhere)
{
  Weather weather;
  weather.stray = 0.05;
  const Sweep sweep = sweepIn(weather);
  EXPECT_NEAR(shareOfGhosts(sweep), 0.05, 0.02);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    sum += sweep.ghost[i] * static_cast<double>(sweep.cloud[i].getVector3fMap().norm());
    count += sweep.ghost[i];
  }
  EXPECT_NEAR(sum / count, 50.0, 5.0);
}

TEST(Weather, DropsFlakesAndDustReturnNearTheSensor)
{
  const Sweep clear = sweepIn({});
  EXPECT_EQ(shareOfGhosts(clear), 0.0);
  double before = 0.0;
  for (const Weather& weather : {Weather{10.0, 0.0, 0.0}, Weather{0.0, 3.0, 0.0}, Weather{0.0, 0.0, 0.1}}) {
    const Sweep sweep = sweepIn(weather);
    EXPECT_GT(shareOfGhosts(sweep), before) << "rain, snow and dust, ever more";
    before = shareOfGhosts(sweep);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
      sum += sweep.ghost[i] * static_cast<double>(sweep.cloud[i].getVector3fMap().norm());
      count += sweep.ghost[i];
    }
    EXPECT_LT(sum / count, 8.0);
  }
}

TEST(Weather, DustHidesWhatIsFarAway)
{
  const auto far = [](const Sweep& sweep) {
    return std::count_if(sweep.cloud.begin(), sweep.cloud.end(),
                         [](const PointXYZIRT& point) { return point.getVector3fMap().norm() > 20.0F; });
  };
  EXPECT_LT(5 * far(sweepIn({0.0, 0.0, 0.1})), far(sweepIn({})));
}

TEST(Mounts, TiltedSensorsSeeTheSameWorld)
{
  for (const RollPitchYaw& mount : {RollPitchYaw{kPi, 0.0, 0.0}, RollPitchYaw{0.3, -0.4, 2.0}}) {
    SimulationOptions options = tunnel();
    const SE3 upright = Simulation(options).worldTSensor(1.0);
    options.mount = mount;
    Simulation simulation(options);
    const SE3 tilted = simulation.worldTSensor(1.0);
    EXPECT_LT((tilted.rotation - upright.rotation * mount.rotation()).norm(), 1e-12);
    EXPECT_LT((tilted.translation - upright.translation).norm(), 1e-12);
    EXPECT_LT(farthestFromWalls(simulation, simulation.sweep(2)), 1e-3);
  }
}

TEST(Mounts, NodAsFarAndAsOftenAsAsked)
{
  SimulationOptions options = tunnel();
  const Simulation level(options);
  options.nod = 0.3;
  options.nod_rate = 2.0;
  Simulation nodding(options);
  const auto nodAt = [&](double t) {
    const Eigen::Matrix3d turn = level.worldTSensor(t).rotation.transpose() * nodding.worldTSensor(t).rotation;
    return std::atan2(turn(0, 2), turn(0, 0));
  };
  EXPECT_NEAR(nodAt(0.0), 0.0, 1e-12) << "it rests at first";
  EXPECT_NEAR(nodAt(1.125), 0.3, 1e-9);
  EXPECT_NEAR(nodAt(1.375), -0.3, 1e-9);
  EXPECT_LT(farthestFromWalls(nodding, nodding.sweep(12)), 1e-3);
  options.nod = 2.0;
  EXPECT_THROW(Simulation{options}, std::invalid_argument);
}

TEST(TurnedFrames, TurnPointsAndPosesAndLeaveTheWorld)
{
  SimulationOptions options = tunnel();
  Simulation plain(options);
  options.turned_frame.roll = kPi / 2.0;
  Simulation turned(options);
  const Sweep a = plain.sweep(2);
  const Sweep b = turned.sweep(2);
  ASSERT_EQ(a.cloud.size(), b.cloud.size());
  for (std::size_t i = 0; i < a.cloud.size(); ++i) {
    // A frame that is rolled by 90 degrees to the right has z where y was, and y where -z was.
    ASSERT_NEAR(b.cloud[i].x, a.cloud[i].x, 1e-4);
    ASSERT_NEAR(b.cloud[i].y, a.cloud[i].z, 1e-4);
    ASSERT_NEAR(b.cloud[i].z, -a.cloud[i].y, 1e-4);
    ASSERT_EQ(b.cloud[i].ring, a.cloud[i].ring);
    const Eigen::Vector3d in_a = a.world_T_end * a.exact_at_end[i].cast<double>();
    const Eigen::Vector3d in_b = b.world_T_end * b.exact_at_end[i].cast<double>();
    ASSERT_LT((in_a - in_b).norm(), 1e-3);
  }
  EXPECT_LT(farthestFromWalls(turned, b), 1e-3);
}

TEST(Weather, RefusesWhatMakesNoSense)
{
  for (const Weather& weather : {Weather{-1.0, 0.0, 0.0}, Weather{0.0, 100.0, 0.0}, Weather{0.0, 0.0, 2.0}}) {
    SimulationOptions options = tunnel();
    options.weather = weather;
    EXPECT_THROW(Simulation simulation(options), std::invalid_argument);
  }
}

}  // namespace pcl_floam::simulator
