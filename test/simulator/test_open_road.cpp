// The open road: how its drives begin, what stands beside it, and how its families differ.

#include "simulation.h"
#include "world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pcl_floam::simulator {

namespace {

WorldOptions roadOptions(Begin begin, std::uint64_t seed = 1, Family family = Family::test)
{
  WorldOptions options;
  options.seed = seed;
  options.family = family;
  options.begin = begin;
  options.speed = 25.0;
  return options;
}

double speedAt(const MotionSpline& motion, double t)
{
  return motion.velocity(t).head<2>().norm();
}

/// s until a speed is reached.
double timeOfSpeed(const MotionSpline& motion, double speed)
{
  double t = 0.0;
  while (t < motion.duration() && speedAt(motion, t) < speed) {
    t += 0.1;
  }
  return t;
}

SimulationOptions sweepOptions()
{
  SimulationOptions options;
  options.world = "open-road";
  options.family = Family::test;
  options.range_noise = 0.0;
  return options;
}

}  // namespace

TEST(OpenRoad, BeginsFromRest)
{
  const World world = makeWorld("open-road", roadOptions(Begin::rest));
  EXPECT_LT(speedAt(world.sensor_motion, 0.0), 0.01);
  // 2 m/s^2 up to 25 m/s, beside standing for a moment and the jerks that are rounded off.
  const double half = timeOfSpeed(world.sensor_motion, 12.0);
  EXPECT_NEAR(timeOfSpeed(world.sensor_motion, 22.0) - half, 5.0, 0.3);
  EXPECT_LT(half, 8.0);
}

TEST(OpenRoad, BeginsAtSpeed)
{
  const World world = makeWorld("open-road", roadOptions(Begin::speed));
  for (const double t : {0.0, 0.5, 5.0, 20.0}) {
    EXPECT_NEAR(speedAt(world.sensor_motion, t), 25.0, 0.5) << t;
  }
}

TEST(OpenRoad, IsLongerThan900Metres)
{
  for (const Family family : {Family::tune, Family::report, Family::test}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const MotionSpline motion = makeWorld("open-road", roadOptions(Begin::rest, seed, family)).sensor_motion;
      EXPECT_GT((motion.pose(motion.duration()).translation - motion.pose(0.0).translation).norm(), 900.0);
    }
  }
}

TEST(OpenRoad, SpeedIsDrawnWhereItIsNotGiven)
{
  std::vector<double> speeds;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    WorldOptions options = roadOptions(Begin::speed, seed);
    options.speed.reset();
    speeds.push_back(speedAt(makeWorld("open-road", options).sensor_motion, 1.0));
  }
  EXPECT_GT(*std::max_element(speeds.begin(), speeds.end()) - *std::min_element(speeds.begin(), speeds.end()), 0.5);
}

TEST(OpenRoad, GroundIsSeenFarAway)
{
  Simulation simulation(sweepOptions());
  const Sweep sweep = simulation.sweep(0);
  // The ring at -3 degrees meets level ground 36 m away.
  const auto far = std::count_if(sweep.cloud.begin(), sweep.cloud.end(), [](const PointXYZIRT& point) {
    return point.ring == 6 && point.getVector3fMap().norm() > 25.0F;
  });
  EXPECT_GT(far, 1000);
}

TEST(OpenRoad, LittleStandsOutOfTheGround)
{
  Simulation simulation(sweepOptions());
  const Sweep sweep = simulation.sweep(0);
  // Rings that look up meet what stands only.
  std::array<int, 16> returns{};
  for (const PointXYZIRT& point : sweep.cloud) {
    ++returns[point.ring];
  }
  for (std::size_t ring = 9; ring < 16; ++ring) {
    EXPECT_LT(returns[ring], 1800 / 4) << ring;
  }
}

TEST(OpenRoad, TrafficGoesBothWays)
{
  const World world = makeWorld("open-road", roadOptions(Begin::rest));
  const auto oncoming = std::count_if(world.moving.begin(), world.moving.end(),
                                      [](const MovingObject& object) { return object.motion.velocity(1.0).x() < 0.0; });
  EXPECT_GT(oncoming, 1);
  EXPECT_GT(static_cast<std::ptrdiff_t>(world.moving.size()) - oncoming, 1);
}

TEST(Families, NoSeedIsAnotherFamilysSeed)
{
  const auto firstHeight = [](Family family, std::uint64_t seed) {
    return makeWorld("open-road", roadOptions(Begin::rest, seed, family)).still.vertices[100];
  };
  std::vector<std::array<float, 3>> places;
  for (const Family family : {Family::tune, Family::report, Family::test}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      places.push_back(firstHeight(family, seed));
    }
  }
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
}

TEST(Families, SeeOtherNoise)
{
  Random tune = randomOf(Family::tune, 1, 7);
  Random usual(1, 7);
  Random report = randomOf(Family::report, 1, 7);
  EXPECT_EQ(tune.uniform(), usual.uniform());
  EXPECT_NE(randomOf(Family::tune, 1, 7).uniform(), report.uniform());
}

}  // namespace pcl_floam::simulator
