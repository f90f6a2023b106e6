// A sensor that is swung by hand, half as fast again as it usually is in the simulated office, from the first scan on,
// and one that nods among shelves.

#include "simulator/test_world.h"
#include "support/constants.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace pcl_floam::simulator {

namespace {

using pcl_floam::test::kPi;

constexpr double kPeriod = 0.1;  // s

constexpr double kFaster = 1.5;

/// With fewer sweeps a second, taken for ten a second, all goes on faster, and accelerations grow with the square.
SimulationOptions fasterSwing(std::uint64_t seed, double start)
{
  SimulationOptions options = testWorld("handheld");
  options.seed = seed;
  options.rate = 1.0 / (kFaster * kPeriod);
  options.start = start;
  return options;
}

}  // namespace

struct Swing {
  int start;  ///< seconds into it where the first sweep is taken
};

class FastMotion : public testing::TestWithParam<Swing> {};

TEST_P(FastMotion, IsFollowedFromTheFirstScanOn)
{
  constexpr std::size_t kScans = 60;
  Simulation simulation(fasterSwing(21, GetParam().start));
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  SE3 first;
  SE3 last;
  SE3 last_but_one;
  double fastest_turn = 0.0;
  double acceleration = 0.0;
  double farthest = 0.0;
  double farthest_turned = 0.0;
  for (std::size_t i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(i);
    const SE3& truth = sweep.world_T_middle;
    if (i == 0) {
      first = last = last_but_one = truth;
    }
    const OdometryReport& report = odometry.track(sweep.cloud, kPeriod * static_cast<double>(i));
    ASSERT_TRUE(report.registration.hasConverged() || i == 0) << i << ": " << report.reason;
    const SE3 error = (first.inverse() * truth).inverse() * report.world_T_sensor;
    farthest = std::max(farthest, error.translation.norm());
    farthest_turned = std::max(farthest_turned, rotationAngle(error.rotation));
    fastest_turn = std::max(fastest_turn, rotationAngle(last.rotation.transpose() * truth.rotation) / kPeriod);
    if (i >= 2) {
      const Eigen::Vector3d change = truth.translation - 2.0 * last.translation + last_but_one.translation;
      acceleration = std::max(acceleration, change.norm() / (kPeriod * kPeriod));
    }
    last_but_one = last;
    last = truth;
  }
  EXPECT_GT(fastest_turn, 120.0 * kPi / 180.0);  // else nothing was shown
  EXPECT_GT(acceleration, 5.0);
  EXPECT_LT(farthest, 0.06);
  EXPECT_LT(farthest_turned, 0.011);
}

INSTANTIATE_TEST_SUITE_P(Starts, FastMotion, testing::Values(Swing{0}, Swing{10}, Swing{25}),
                         [](const auto& swing) { return std::to_string(swing.param.start); });

/// A constant velocity is off by several degrees from sweep to sweep, by which one shelf lies where the next one was.
class Nodding : public testing::TestWithParam<unsigned> {};

TEST_P(Nodding, IsFollowedAmongShelves)
{
  constexpr std::size_t kScans = 70;
  SimulationOptions options = testWorld("warehouse", "vlp16");
  options.seed = GetParam();
  options.realism = Realism::real;
  options.nod = 10.0 * kPi / 180.0;
  options.nod_rate = 2.0;
  Simulation simulation(options);
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  SE3 first;
  double farthest = 0.0;
  for (std::size_t i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(i);
    first = i == 0 ? sweep.world_T_middle : first;
    const OdometryReport& report = odometry.track(sweep.cloud, kPeriod * static_cast<double>(i));
    EXPECT_TRUE(i == 0 || report.registration.hasConverged()) << i << ": " << report.reason;
    const SE3 error = (first.inverse() * sweep.world_T_middle).inverse() * report.world_T_sensor;
    farthest = std::max(farthest, error.translation.norm());
  }
  EXPECT_LT(farthest, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Nodding, testing::Values(1U, 2U, 3U));

}  // namespace pcl_floam::simulator
