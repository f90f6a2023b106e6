// Drives of which nine in ten returns are missing, from the first scan on, or all for a second.

#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace pcl_floam::simulator {

struct SparseDrive {
  std::string world;
  std::string sensor;
  double error;  ///< m, at most
  bool tells;    ///< what is left of a scan tells of all directions
};

class MissingReturns : public testing::TestWithParam<SparseDrive> {};

TEST_P(MissingReturns, NineInTenLoseNothing)
{
  constexpr std::size_t kScans = 60;
  constexpr double kPeriod = 0.1;  // s
  SimulationOptions options = testWorld(GetParam().world, GetParam().sensor);
  options.seed = 21;
  options.dropout = 0.9;
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  SE3 world_T_first;
  SE3 error;
  double way = 0.0;
  for (std::size_t i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(i);
    if (i == 0) {
      world_T_first = sweep.world_T_end;
    }
    const OdometryReport& report = odometry.track(sweep.cloud, kPeriod * static_cast<double>(i));
    const bool is_open = !GetParam().tells || report.provisional;  // so few returns leave other first motions likely
    const bool may_doubt = is_open && report.state == TrackingState::doubtful;
    EXPECT_TRUE(may_doubt || report.state == (i == 0 ? TrackingState::initialized : TrackingState::tracked)) << i;
    const SE3 first_T_sensor = world_T_first.inverse() * sweep.world_T_end;
    error = first_T_sensor.inverse() * report.world_T_sensor;
    way = first_T_sensor.translation.norm();
  }
  RecordProperty("error", std::to_string(error.translation.norm()));
  EXPECT_LT(error.translation.norm(), GetParam().error) << "after " << way << " m";
}

INSTANTIATE_TEST_SUITE_P(Worlds, MissingReturns,
                         testing::Values(SparseDrive{"warehouse", "vlp16", 0.03, true},
                                         SparseDrive{"room", "vlp16", 0.03, true},
                                         SparseDrive{"urban", "hdl64", 0.15, false},
                                         SparseDrive{"highway", "hdl64", 0.5, false}),
                         [](const auto& drive) { return drive.param.world; });

/// Swung by hand, a sensor turns by anything while it sees nothing.
TEST(SecondWithoutReturns, IsPredictedOverAndThePoseFoundAgain)
{
  constexpr std::size_t kScans = 50;
  constexpr double kPeriod = 0.1;  // s
  SimulationOptions options = testWorld("handheld");
  options.seed = 21;
  options.start = 3.0;
  options.gap_from = 2.0;
  options.gap_to = 3.0;
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  SE3 world_T_first;
  int predicted = 0;
  double wrongly_predicted = 0.0;
  for (std::size_t i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(i);
    if (i == 0) {
      world_T_first = sweep.world_T_end;
    }
    const OdometryReport& report = odometry.track(sweep.cloud, kPeriod * static_cast<double>(i));
    const SE3 error = (world_T_first.inverse() * sweep.world_T_end).inverse() * report.world_T_sensor;
    if (report.state == TrackingState::predicted) {
      ++predicted;
      wrongly_predicted = std::max(wrongly_predicted, rotationAngle(error.rotation));
    } else {
      EXPECT_LT(error.translation.norm(), 0.05) << i;
      EXPECT_LT(rotationAngle(error.rotation), 0.02) << i;
    }
  }
  EXPECT_GE(predicted, 9);
  EXPECT_LE(predicted, 11);
  EXPECT_GT(wrongly_predicted, 1.0) << "rad; else there was nothing to find";
}

}  // namespace pcl_floam::simulator
