// The laws that the simulator's sweeps and poses obey.

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

SimulationOptions optionsFor(const std::string& world, std::uint64_t seed = 1)
{
  SimulationOptions options;
  options.world = world;
  options.seed = seed;
  options.start = 4.0;
  return options;
}

/// Exact place in the world of point \p i of a sweep.
Eigen::Vector3d worldPoint(const Sweep& sweep, std::size_t i)
{
  return sweep.world_T_end * sweep.exact_at_end[i].cast<double>();
}

bool same(const Sweep& a, const Sweep& b)
{
  return std::equal(a.cloud.begin(), a.cloud.end(), b.cloud.begin(), b.cloud.end(),
                    [](const PointXYZIRT& p, const PointXYZIRT& q) {
                      return p.x == q.x && p.y == q.y && p.z == q.z && p.intensity == q.intensity && p.ring == q.ring &&
                             p.time == q.time;
                    });
}

/// Distance to the nearest surface of a smooth corridor, which is 2.4 m wide and 2.7 m high.
double distanceToSmoothCorridor(const Eigen::Vector3d& p)
{
  const double to_wall = std::abs(std::abs(p.y()) - 1.2);
  return std::min({to_wall, std::abs(p.z()), std::abs(p.z() - 2.7)});
}

}  // namespace

class EveryWorld : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Simulation, EveryWorld,
                         testing::Values("warehouse", "room", "urban", "highway", "corridor", "tunnel", "handheld",
                                         "open-road", "town", "motorway", "car-park", "yard"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(EveryWorld, IsTheSameForTheSameSeedInAnyOrder)
{
  Simulation first(optionsFor(GetParam()));
  Simulation second(optionsFor(GetParam()));
  const Sweep a = first.sweep(3);
  (void)second.sweep(7);
  EXPECT_TRUE(same(a, second.sweep(3)));
  Simulation other(optionsFor(GetParam(), 2));
  EXPECT_FALSE(same(a, other.sweep(3)));
}

TEST_P(EveryWorld, SweepsFollowOneAnotherWithoutAGap)
{
  Simulation simulation(optionsFor(GetParam()));
  const Sweep a = simulation.sweep(5);
  const Sweep b = simulation.sweep(6);
  EXPECT_DOUBLE_EQ(a.end_time, b.start_time);
  EXPECT_TRUE(a.world_T_end.rotation == b.world_T_start.rotation);
  EXPECT_TRUE(a.world_T_end.translation == b.world_T_start.translation);
}

TEST_P(EveryWorld, MotionKeepsToItsBoundsAndIsSmooth)
{
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = makeWorld(GetParam(), {seed, false, 1, false});
    const MotionSpline& motion = world.sensor_motion;
    EXPECT_LE(motion.accelerationBound(), world.acceleration) << "seed " << seed;
    constexpr double kStep = 0.01;
    for (double t = 0.0; t + kStep < motion.duration(); t += kStep) {
      const Eigen::Vector3d jump = motion.acceleration(t + kStep) - motion.acceleration(t);
      // Between controls 0.1 s apart the acceleration changes linearly.
      ASSERT_LE(jump.norm(), 2.0 * world.acceleration * kStep / 0.1 + 1e-9) << "at " << t << " s, seed " << seed;
    }
  }
}

TEST_P(EveryWorld, MeasuredPointsAreTheExactOnesButForTheRangeNoise)
{
  Simulation simulation(optionsFor(GetParam()));
  const Sweep sweep = simulation.sweep(10);
  ASSERT_GT(sweep.cloud.size(), 5000U);
  double squares = 0.0;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const PointXYZIRT& point = sweep.cloud[i];
    const SE3 world_T_sensor = simulation.worldTSensor(sweep.start_time + static_cast<double>(point.time));
    const Eigen::Vector3d measured = point.getVector3fMap().cast<double>();
    const Eigen::Vector3d exact = world_T_sensor.inverse() * worldPoint(sweep, i);
    const Eigen::Vector3d error = measured - exact;
    const double along = error.dot(exact.normalized());
    // float32: the worlds' coordinates reach a kilometre, and the time 0.1 s.
    ASSERT_LT((error - along * exact.normalized()).norm(), 1e-3);
    squares += along * along;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(sweep.cloud.size())), 0.02, 0.001);
}

TEST_P(EveryWorld, FirstPointsAreCarriedByTheMotion)
{
  Simulation simulation(optionsFor(GetParam()));
  const Sweep sweep = simulation.sweep(10);
  const SE3 motion = sweep.world_T_end.inverse() * sweep.world_T_start;
  // The sweep's first points were seen from its start: at its end they lie where the motion has carried them.
  const Eigen::Vector3d first = sweep.cloud.front().getVector3fMap().cast<double>();
  EXPECT_LT((motion * first - sweep.exact_at_end.front().cast<double>()).norm(), 0.15);
  EXPECT_GT((first - sweep.exact_at_end.front().cast<double>()).norm(), 0.0);
}

TEST(Simulation, PointsOfAMovingSensorLieOnTheWorldsSurfaces)
{
  SimulationOptions options = optionsFor("corridor");
  options.smooth = true;
  Simulation simulation(options);
  for (const std::size_t number : {0U, 100U, 400U}) {
    const Sweep sweep = simulation.sweep(number);
    for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
      ASSERT_LT(distanceToSmoothCorridor(worldPoint(sweep, i)), 5e-4);
    }
  }
}

TEST(Simulation, CorridorsDoorsAreItsOnlyStructure)
{
  Simulation simulation(optionsFor("corridor"));
  const Sweep sweep = simulation.sweep(100);
  std::size_t off_the_walls = 0;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const double distance = distanceToSmoothCorridor(worldPoint(sweep, i));
    EXPECT_LT(distance, 0.125);
    off_the_walls += distance > 0.01 ? 1 : 0;
  }
  EXPECT_GT(off_the_walls, sweep.cloud.size() / 200);
  EXPECT_LT(off_the_walls, sweep.cloud.size() / 3);
}

TEST(Simulation, HandheldTurnsAtUpTo120DegreesASecond)
{
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const MotionSpline motion = makeWorld("handheld", {seed, false, 1, false}).sensor_motion;
    double peak = 0.0;
    for (double t = 0.0; t < motion.duration(); t += 0.01) {
      peak = std::max(peak, rotationAngle((motion.pose(t).inverse() * motion.pose(t + 0.01)).rotation) / 0.01);
    }
    EXPECT_NEAR(peak * 180.0 / kPi, 120.0, 3.0) << "seed " << seed;
  }
}

TEST(Simulation, WorldsAreAsLongAndAsFastAsTheySay)
{
  struct Expectation {
    const char* world;
    double length, speed;  // m, m/s
  };
  constexpr std::array<Expectation, 5> kExpectations{{{"warehouse", 300.0, 2.0},
                                                      {"urban", 1000.0, 12.0},
                                                      {"highway", 1000.0, 25.0},
                                                      {"corridor", 125.0, 1.5},
                                                      {"car-park", 200.0, 3.0}}};
  for (const auto& [world, length, speed] : kExpectations) {
    const MotionSpline motion = makeWorld(world, {3, false, 1, false}).sensor_motion;
    double gone = 0.0;
    double fastest = 0.0;
    for (double t = 0.0; t < motion.duration(); t += 0.1) {
      gone += 0.1 * motion.velocity(t).norm();
      fastest = std::max(fastest, motion.velocity(t).norm());
    }
    EXPECT_GT(gone, length) << world;
    EXPECT_NEAR(fastest, speed, 0.05 * speed) << world;
  }
}

TEST(Simulation, UrbanReturnsToItsStart)
{
  const MotionSpline motion = makeWorld("urban", {1, false, 1, false}).sensor_motion;
  const Eigen::Vector3d apart = motion.pose(motion.duration()).translation - motion.pose(0.0).translation;
  EXPECT_LT(apart.norm(), 1.0);
}

TEST(Simulation, NothingRunsIntoTheSensor)
{
  for (const std::string& name : worldNames()) {
    const World world = makeWorld(name, {1, false, 1, false});
    for (const MovingObject& object : world.moving) {
      for (double t = 0.0; t < world.sensor_motion.duration(); t += 0.5) {
        const Eigen::Vector3d apart = object.motion.pose(t).translation - world.sensor_motion.pose(t).translation;
        ASSERT_GT(apart.head<2>().norm(), 0.4) << name << " at " << t << " s";
      }
    }
  }
}

TEST(Simulation, MovingObjectsAreSeenWhereThereAreAny)
{
  for (const char* world : {"warehouse", "room", "urban", "highway", "car-park"}) {
    Simulation simulation(optionsFor(world));
    std::size_t moving = 0;
    for (std::size_t number = 0; number < 200; number += 20) {
      const Sweep sweep = simulation.sweep(number);
      moving += static_cast<std::size_t>(std::count(sweep.moving.begin(), sweep.moving.end(), 1));
    }
    EXPECT_GT(moving, 50U) << world;
  }
}

TEST(Simulation, DropoutLosesItsShareOfTheReturns)
{
  SimulationOptions options = optionsFor("warehouse");
  Simulation whole(options);
  options.dropout = 0.3;
  Simulation thinned(options);
  const auto all = static_cast<double>(whole.sweep(0).cloud.size());
  EXPECT_NEAR(static_cast<double>(thinned.sweep(0).cloud.size()) / all, 0.7, 0.02);
}

TEST(Simulation, HeadsTurnBothWays)
{
  SimulationOptions options = optionsFor("room");
  for (const HeadRotation rotation : {HeadRotation::clockwise, HeadRotation::counterclockwise}) {
    options.rotation = rotation;
    Simulation simulation(options);
    const double sense = rotation == HeadRotation::clockwise ? -1.0 : 1.0;
    for (const PointXYZIRT& point : simulation.sweep(0).cloud) {
      // Looks forward at the middle of the sweep.
      const double expected = sense * 2.0 * kPi * (static_cast<double>(point.time) / 0.1 - 0.5);
      const double azimuth = std::atan2(point.y, point.x);
      ASSERT_NEAR(std::remainder(azimuth - expected, 2.0 * kPi), 0.0, 1e-4);
    }
  }
}

TEST(Simulation, OrganizedCloudsHaveOneRowPerRing)
{
  SimulationOptions options = optionsFor("room");
  options.sensor = "os64";
  options.organized = true;
  options.dropout = 0.1;
  Simulation simulation(options);
  const Sweep sweep = simulation.sweep(0);
  EXPECT_EQ(sweep.cloud.height, 64U);
  EXPECT_EQ(sweep.cloud.width, 1024U);
  EXPECT_FALSE(sweep.cloud.is_dense);
  for (std::uint32_t row = 0; row < 64; ++row) {
    for (std::uint32_t column = 0; column < 1024; column += 100) {
      ASSERT_EQ(sweep.cloud.at(column, row).ring, row);
    }
  }
}

TEST(Simulation, RefusesWhatMakesNoSense)
{
  const auto refused = [](auto change) {
    SimulationOptions options;
    change(options);
    EXPECT_THROW(Simulation simulation(options), std::invalid_argument);
  };
  refused([](SimulationOptions& options) { options.world = "moon"; });
  refused([](SimulationOptions& options) { options.sensor = "sonar"; });
  refused([](SimulationOptions& options) { options.range_noise = -0.1; });
  refused([](SimulationOptions& options) { options.dropout = 1.5; });
  refused([](SimulationOptions& options) { options.rate = 0.0; });
  refused([](SimulationOptions& options) { options.start = 1e6; });
}

}  // namespace pcl_floam::simulator
