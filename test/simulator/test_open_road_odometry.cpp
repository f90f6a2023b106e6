// Open roads, where the sensor's own rings are most of what it sees: neither taken for rest nor set in motion.

#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

struct Road {
  unsigned seed;
  Begin begin;
  std::string sensor;
};

class OpenRoadOdometry : public testing::TestWithParam<Road> {};

INSTANTIATE_TEST_SUITE_P(TestFamily, OpenRoadOdometry,
                         testing::Values(Road{1, Begin::rest, "vlp16"}, Road{2, Begin::rest, "vlp16"},
                                         Road{3, Begin::speed, "vlp16"}, Road{4, Begin::speed, "vlp16"},
                                         Road{1, Begin::speed, "hdl32"}, Road{2, Begin::rest, "hdl32"}),
                         [](const auto& road) {
                           return road.param.sensor + (road.param.begin == Begin::rest ? "Rest" : "Speed") +
                                  std::to_string(road.param.seed);
                         });

TEST_P(OpenRoadOdometry, IsFollowed)
{
  constexpr std::size_t kScans = 90;
  constexpr std::size_t kSettled = 15;
  SimulationOptions options = testWorld("open-road", GetParam().sensor);
  options.seed = GetParam().seed;
  options.begin = GetParam().begin;
  Simulation simulation(options);
  OdometryParameters parameters;
  Odometry<PointXYZIRT> odometry(parameters);
  SE3 last_truth;
  SE3 last_estimate;
  double way = 0.0;
  double error = 0.0;
  for (std::size_t number = 0; number < kScans; ++number) {
    const Sweep sweep = simulation.sweep(number);
    const OdometryReport& report = odometry.track(sweep.cloud, 0.1 * static_cast<double>(number));
    // Until it is settled how the sensor began to move poses are said to be provisional, and are corrected afterwards.
    if (number > kSettled && !report.provisional && report.corrected_poses.empty()) {
      const SE3 step = last_truth.inverse() * sweep.world_T_end;
      way += step.translation.norm();
      error += (last_estimate.inverse() * report.world_T_sensor * step.inverse()).translation.norm();
    }
    last_truth = sweep.world_T_end;
    last_estimate = report.world_T_sensor;
  }
  EXPECT_FALSE(odometry.report().provisional);
  EXPECT_GT(way, 10.0);
  // A standard deviation of some centimetres each scan; a road that is lost is off by all of the way.
  EXPECT_LT(error, 0.15 * static_cast<double>(kScans - kSettled));
}

}  // namespace pcl_floam::simulator
