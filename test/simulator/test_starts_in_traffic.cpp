// The first scans of a drive, taken at 25 m/s among cars of about the same speed.

#include "simulation.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <string>

namespace pcl_floam::simulator {

struct Start {
  unsigned seed;
  double seconds;        // into the drive
  double dropout = 0.0;  // part of the returns that is missing
};

class StartsInTraffic : public testing::TestWithParam<Start> {};

INSTANTIATE_TEST_SUITE_P(Highway, StartsInTraffic,
                         testing::Values(Start{21, 25.3}, Start{21, 34.5}, Start{22, 0.0}, Start{22, 6.9},
                                         Start{22, 0.0, 0.3}),
                         [](const auto& parameter) {
                           return "Seed" + std::to_string(parameter.param.seed) + "At" +
                                  std::to_string(static_cast<int>(parameter.param.seconds)) +
                                  (parameter.param.dropout > 0.0 ? "WithReturnsMissing" : "");
                         });

TEST_P(StartsInTraffic, TheWorldIsWhatStands)
{
  SimulationOptions options;
  options.world = "highway";
  options.sensor = "hdl64";
  options.seed = GetParam().seed;
  options.start = GetParam().seconds;
  options.dropout = GetParam().dropout;
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  SE3 last_truth;
  SE3 last_estimate;
  for (std::size_t number = 0; number < 5; ++number) {
    const Sweep sweep = simulation.sweep(number);
    const SE3 estimate = odometry.track(sweep.cloud, 0.1 * static_cast<double>(number)).world_T_sensor;
    if (number > 0) {
      const SE3 true_motion = last_truth.inverse() * sweep.world_T_end;
      const SE3 motion = last_estimate.inverse() * estimate;
      EXPECT_GT(true_motion.translation.norm(), 2.0) << number;
      EXPECT_LT((motion.translation - true_motion.translation).norm(), 0.2) << number;
    }
    last_truth = sweep.world_T_end;
    last_estimate = estimate;
  }
}

}  // namespace pcl_floam::simulator
