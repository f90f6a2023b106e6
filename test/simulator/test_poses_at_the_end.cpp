// Poses are registered at the middle of the sweep, and given out at its end.

#include "simulation.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace pcl_floam::simulator {

namespace {

/// Of the motion aside from scan to scan, in the sensor's axes, m, root mean square.
double errorAside(PoseInstant instant)
{
  constexpr int kScans = 120;
  constexpr int kFirst = 30;
  SimulationOptions options;
  options.world = "room";
  options.seed = 41;
  Simulation simulation(options);
  OdometryParameters parameters;
  parameters.engine = OdometryEngine::features;
  parameters.pose_instant = instant;
  Odometry<PointXYZIRT> odometry(parameters);
  SE3 last_estimate;
  SE3 last_truth;
  double squares = 0.0;
  for (int i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(static_cast<std::size_t>(i));
    const SE3 estimate = odometry.track(sweep.cloud, 0.1 * i).world_T_sensor;
    const SE3& truth = instant == PoseInstant::end ? sweep.world_T_end : sweep.world_T_middle;
    if (i >= kFirst) {
      const SE3 error = (last_truth.inverse() * truth).inverse() * (last_estimate.inverse() * estimate);
      squares += std::pow(error.translation.y(), 2) / (kScans - kFirst);
    }
    last_estimate = estimate;
    last_truth = truth;
  }
  return std::sqrt(squares);
}

}  // namespace

/// This sensor never moves aside, and that is learned: the sweep alone would tell it with twice the error of the poses.
TEST(PosesAtTheEnd, AreNearlyAsGoodAsThoseOfTheMiddle)
{
  const double ratio = errorAside(PoseInstant::end) / errorAside(PoseInstant::middle);
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_LT(ratio, 1.5);
}

}  // namespace pcl_floam::simulator
