// A lorry that keeps beside the sensor and fills a third of its view must not draw the pose along.
#include "simulator/test_world.h"
#include "support/constants.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

namespace pcl_floam::simulator {
namespace {

struct Outcome {
  double heading_error = 0.0;   ///< degrees, at the end
  double position_error = 0.0;  ///< m, at the end
  double turn = 0.0;            ///< degrees, from the first scan to the last
};

/// A city from standstill on, around the first corner.
Outcome driveThroughTown()
{
  constexpr double kDegrees = 180.0 / test::kPi;
  constexpr std::size_t kScans = 180;
  SimulationOptions options = testWorld("urban", "hdl64");
  options.seed = 21;
  options.truck = true;
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  Outcome outcome;
  SE3 first_T_world;
  for (std::size_t number = 0; number < kScans; ++number) {
    const Sweep sweep = simulation.sweep(number);
    if (number == 0) {
      first_T_world = sweep.world_T_end.inverse();
    }
    const OdometryReport& report = odometry.track(sweep.cloud, sweep.end_time);
    const SE3 true_motion = first_T_world * sweep.world_T_end;
    const SE3 error = true_motion.inverse() * report.world_T_sensor;
    outcome.heading_error = kDegrees * log(error)[5];
    outcome.position_error = error.translation.norm();
    outcome.turn = kDegrees * std::abs(log(true_motion)[5]);
  }
  return outcome;
}

}  // namespace

TEST(LorryBeside, DoesNotTurnTheSensorBackInACorner)
{
  const Outcome outcome = driveThroughTown();
  EXPECT_GT(outcome.turn, 60.0);
  EXPECT_LT(std::abs(outcome.heading_error), 0.3);
  EXPECT_LT(outcome.position_error, 0.2);
  RecordProperty("heading_error", std::to_string(outcome.heading_error));
  RecordProperty("position_error", std::to_string(outcome.position_error));
}

}  // namespace pcl_floam::simulator
