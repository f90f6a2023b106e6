// What the errors of real sensors do to the scans.

#include "sensor_errors.h"
#include "simulation.h"
#include "support/constants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pcl_floam::simulator {

namespace {

using pcl_floam::test::kPi;

constexpr double kDegree = kPi / 180.0;

SimulationOptions roomWith(const GivenErrors& errors)
{
  SimulationOptions options;
  options.world = "room";
  options.sensor = "vlp16";
  options.range_noise = 0.0;
  options.errors = errors;
  return options;
}

struct Difference {
  std::size_t ring;
  double range;               // m, measured less exact
  double elevation, azimuth;  // rad
  double exact_range;         // m
};

/// How the measured points differ from the exact ones, each seen from where the sensor was told to be.
std::vector<Difference> differences(const Simulation& simulation, const Sweep& sweep)
{
  std::vector<Difference> result;
  for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
    const SE3 sensor_T_world =
        simulation.worldTSensor(sweep.start_time + static_cast<double>(sweep.cloud[i].time)).inverse();
    const Eigen::Vector3d exact = sensor_T_world * (sweep.world_T_end * sweep.exact_at_end[i].cast<double>());
    const Eigen::Vector3d measured = sweep.cloud[i].getVector3fMap().cast<double>();
    result.push_back(
        {sweep.cloud[i].ring, measured.norm() - exact.norm(),
         std::asin(measured.z() / measured.norm()) - std::asin(exact.z() / exact.norm()),
         std::remainder(std::atan2(measured.y(), measured.x()) - std::atan2(exact.y(), exact.x()), 2.0 * kPi),
         exact.norm()});
  }
  return result;
}

std::vector<Difference> differencesOf(const SimulationOptions& options)
{
  Simulation simulation(options);
  return differences(simulation, simulation.sweep(3));
}

/// Checks that a ring's points all differ alike and that the rings differ among each other by about \p sigma.
void expectConstantByRing(const std::vector<Difference>& all, double Difference::*error, double sigma, double tolerance)
{
  std::array<std::vector<double>, 16> rings;
  for (const Difference& one : all) {
    rings[one.ring].push_back(one.*error);
  }
  double squares = 0.0;
  for (const std::vector<double>& ring : rings) {
    ASSERT_FALSE(ring.empty());
    const auto [low, high] = std::minmax_element(ring.begin(), ring.end());
    EXPECT_LT(*high - *low, tolerance);
    squares += *low * *low / 16.0;
  }
  EXPECT_GT(std::sqrt(squares), 0.5 * sigma);
  EXPECT_LT(std::sqrt(squares), 1.6 * sigma);
}

Sweep sweepOf(const SimulationOptions& options)
{
  return Simulation(options).sweep(0);
}

std::size_t ghosts(const Sweep& sweep)
{
  return static_cast<std::size_t>(std::count(sweep.ghost.begin(), sweep.ghost.end(), 1));
}

}  // namespace

TEST(SensorErrors, EachLaserHasItsRangeBias)
{
  expectConstantByRing(differencesOf(roomWith({{"range-bias", 0.05}})), &Difference::range, 0.05, 1e-4);
}

TEST(SensorErrors, EachLaserHasItsAngles)
{
  expectConstantByRing(differencesOf(roomWith({{"elevation-error", 0.5}})), &Difference::elevation, 0.5 * kDegree,
                       1e-4);
  expectConstantByRing(differencesOf(roomWith({{"azimuth-error", 0.5}})), &Difference::azimuth, 0.5 * kDegree, 1e-4);
}

TEST(SensorErrors, BiasDriftsAsTheSensorWarmsUp)
{
  const SensorUnit unit(sensorErrors(Realism::ideal, "vlp16", {{"range-drift", 0.1}}), 1, Random(1, 1));
  const RayHit hit{10.0F, 1.0F, 1.0F};
  const double begin = unit.measured(10.0, 0, 0.0, hit) - 10.0;
  const double middle = unit.measured(10.0, 0, 300.0, hit) - 10.0;
  const double late = unit.measured(10.0, 0, 6000.0, hit) - 10.0;
  EXPECT_EQ(begin, 0.0);
  EXPECT_GT(std::abs(middle), 0.0);
  EXPECT_GT(std::abs(late), std::abs(middle));
  EXPECT_NEAR(unit.measured(10.0, 0, 9000.0, hit) - 10.0, late, 1e-4);
}

TEST(SensorErrors, SlantingSurfacesSeemNearer)
{
  const SensorUnit unit(sensorErrors(Realism::ideal, "vlp16", {{"grazing-bias", 0.1}, {"beam-divergence", 3.0}}), 1,
                        Random(1, 1));
  const auto bias = [&unit](double range, double slant) {
    return unit.measured(range, 0, 0.0, {10.0F, static_cast<float>(std::cos(slant)), 1.0F}) - range;
  };
  EXPECT_NEAR(bias(10.0, 0.0), 0.0, 1e-6);
  // The footprint is 30 mm wide at 10 m; at 45 degrees it is as deep.
  EXPECT_NEAR(bias(10.0, 45.0 * kDegree), -0.003, 1e-5);
  EXPECT_NEAR(bias(20.0, 45.0 * kDegree), -0.006, 1e-5);
  EXPECT_NEAR(bias(50.0, 89.9 * kDegree), -0.2, 1e-6) << "never more than what was found";
}

TEST(SensorErrors, BlackSeemsFartherThanWhite)
{
  const SensorUnit unit(sensorErrors(Realism::ideal, "vlp16", {{"reflectivity-bias", 0.02}}), 1, Random(1, 1));
  EXPECT_NEAR(unit.measured(5.0, 0, 0.0, {5.0F, 1.0F, 1.0F}), 5.0, 1e-9);
  EXPECT_NEAR(unit.measured(5.0, 0, 0.0, {5.0F, 1.0F, 0.0F}), 5.02, 1e-9);
}

TEST(SensorErrors, RangesAreMultiplesOfTheStep)
{
  for (const PointXYZIRT& point : sweepOf(roomWith({{"range-step", 0.25}})).cloud) {
    const double steps = static_cast<double>(point.getVector3fMap().norm()) / 0.25;
    ASSERT_NEAR(steps, std::round(steps), 1e-4);
  }
}

TEST(SensorErrors, TimesThatAreOffShowInMotionOnly)
{
  const auto worst = [](const SimulationOptions& options) {
    double angle = 0.0;
    for (const Difference& one : differencesOf(options)) {
      angle = std::max(angle, std::abs(one.azimuth));
    }
    return angle;
  };
  SimulationOptions options = roomWith({{"time-jitter", 2.0}});
  options.world = "handheld";
  options.start = 4.0;
  EXPECT_GT(worst(options), 1e-3);
  options.standing = 0.0;
  EXPECT_LT(worst(options), 1e-4);
}

TEST(SensorErrors, ByTheirOwnClockLasersFireAtOtherAnglesInEachTurn)
{
  const auto firstAzimuth = [](Simulation& simulation, std::size_t number) {
    const PointXYZIRT point = simulation.sweep(number).cloud.front();
    return std::atan2(point.y, point.x);
  };
  SimulationOptions options = roomWith({});
  options.standing = 0.0;
  Simulation locked(options);
  EXPECT_EQ(firstAzimuth(locked, 1), firstAzimuth(locked, 2));
  options.errors["firing-phase"] = 1.0;
  Simulation free(options);
  const float step = static_cast<float>(2.0 * kPi / free.sensor().columns);
  EXPECT_NE(firstAzimuth(free, 1), firstAzimuth(free, 2));
  EXPECT_NEAR(firstAzimuth(free, 1), firstAzimuth(free, 2), step);
  for (const Difference& one : differencesOf(options)) {
    ASSERT_NEAR(one.azimuth, 0.0, 1e-5) << "the angle is told as it is";
  }
}

TEST(SensorErrors, AHeadThatWandersTurnsAllPointsAlike)
{
  SimulationOptions options = roomWith({{"head-wander", 0.2}});
  options.standing = 0.0;
  double worst = 0.0;
  for (std::size_t number = 0; number < 5; ++number) {
    Simulation simulation(options);
    const std::vector<Difference> found = differences(simulation, simulation.sweep(number));
    worst = std::max(worst, std::abs(found.front().azimuth));
    EXPECT_NEAR(found.front().azimuth, found[16].azimuth, 1e-4);
  }
  EXPECT_GT(worst, 0.05 * kDegree);
  EXPECT_LT(worst, 0.7 * kDegree);
}

TEST(SensorErrors, WhatSwaysTiltsTheSensorAndItsTruth)
{
  SimulationOptions options = roomWith({{"sway", 0.5}});
  options.standing = 0.0;
  const Simulation simulation(options);
  const SE3 moved = simulation.worldTSensor(0.0).inverse() * simulation.worldTSensor(20.0);
  EXPECT_LT(moved.translation.norm(), 1e-9);
  const double angle = Eigen::AngleAxisd(moved.rotation).angle();
  EXPECT_GT(angle, 0.05 * kDegree);
  EXPECT_LT(angle, 3.0 * kDegree);
}

TEST(SensorErrors, OnSlantingGroundAWideBeamErrsLittle)
{
  SimulationOptions options = roomWith({{"beam-divergence", 3.0}});
  options.world = "tunnel";
  for (const Difference& one : differencesOf(options)) {
    if (one.exact_range < 8.0) {
      ASSERT_LT(std::abs(one.range), 0.05);
    }
  }
}

TEST(SensorErrors, GlassLosesReturnsAndShowsMirrorImages)
{
  SimulationOptions options = roomWith({});
  const Sweep dull = sweepOf(options);
  options.errors["glass"] = 1.0;
  const Sweep glossy = sweepOf(options);
  EXPECT_EQ(ghosts(dull), 0U);
  EXPECT_GT(ghosts(glossy), 5U);
  EXPECT_LT(ghosts(glossy), glossy.cloud.size() / 20);
  EXPECT_LT(glossy.cloud.size() - ghosts(glossy), dull.cloud.size());
}

TEST(SensorErrors, RealSensorsHaveTheErrorsOfTheirKind)
{
  const SensorErrors real = sensorErrors(Realism::real, "vlp16");
  const SensorErrors ideal = sensorErrors(Realism::ideal, "vlp16");
  for (const SensorErrorOption& option : sensorErrorOptions()) {
    EXPECT_GT(real.*option.value, 0.0) << option.name;
    EXPECT_EQ(ideal.*option.value, 0.0) << option.name;
    EXPECT_EQ(sensorErrors(Realism::real, "vlp16", {{option.name, 0.0}}).*option.value, 0.0) << option.name;
  }
  EXPECT_LT(sensorErrors(Realism::real, "os64").range_step, real.range_step);
}

TEST(SensorErrors, UnitsOfOneKindDiffer)
{
  SimulationOptions options = roomWith({});
  options.realism = Realism::real;
  const auto firstRange = [&options] { return differencesOf(options).front().range; };
  const double one = firstRange();
  options.seed = 2;
  EXPECT_NE(firstRange(), one);
}

TEST(SensorErrors, RefusesWhatMakesNoSense)
{
  EXPECT_THROW((void)sensorErrors(Realism::ideal, "vlp16", {{"mood", 1.0}}), std::invalid_argument);
  EXPECT_THROW((void)sensorErrors(Realism::ideal, "vlp16", {{"range-bias", -0.1}}), std::invalid_argument);
  EXPECT_THROW((void)sensorErrors(Realism::ideal, "vlp16", {{"glass", 1.5}}), std::invalid_argument);
}

}  // namespace pcl_floam::simulator
