// Stamps that are taken when a scan arrives, now sooner, now later.
#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>

namespace pcl_floam::simulator {

/// Scans tell how far a car has gone; that one came late must not.
TEST(StampsThatJitter, MoveNoPose)
{
  constexpr std::size_t kScans = 50;
  constexpr double kPeriod = 0.1;   // s
  constexpr double kJitter = 0.02;  // s, one standard deviation
  SimulationOptions options = testWorld("urban", "vlp16");
  options.seed = 3;
  options.start = 5.0;
  Simulation simulation(options);
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  std::mt19937 random(1);
  std::normal_distribution<double> late(0.0, kJitter);
  SE3 before;
  SE3 true_before;
  double way = 0.0;
  double farthest_off = 0.0;
  for (std::size_t i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(i);
    const OdometryReport& report = odometry.track(sweep.cloud, kPeriod * static_cast<double>(i) + late(random));
    const SE3 moved = before.inverse() * report.world_T_sensor;
    const SE3 truly = true_before.inverse() * sweep.world_T_middle;
    if (i > 15) {  // then it is known how much they do
      farthest_off = std::max(farthest_off, (moved.translation - truly.translation).norm());
      way += truly.translation.norm();
    }
    before = report.world_T_sensor;
    true_before = sweep.world_T_middle;
  }
  EXPECT_GT(way, 20.0) << "the car hardly moves";
  EXPECT_LT(farthest_off, 0.03);
}

}  // namespace pcl_floam::simulator
