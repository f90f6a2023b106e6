// Lidars whose head does not turn: their views, and the odometry that follows them without being told.

#include "simulator/test_world.h"
#include "support/constants.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace pcl_floam::simulator {

using pcl_floam::test::kPi;

/// A sensor and what its data sheet says of it.
struct SolidStateView {
  const char* sensor;
  double left, right, below, above;  ///< degrees, of the view
  std::size_t points;                ///< in a tenth of a second
};

class SolidState : public testing::TestWithParam<SolidStateView> {
protected:
  static SimulationOptions options()
  {
    SimulationOptions options = testWorld("room", GetParam().sensor);
    options.start = 3.0;
    options.range_noise = 0.0;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(All, SolidState,
                         testing::Values(SolidStateView{"mid360", 180.0, -180.0, -7.0, 52.0, 20000},
                                         SolidStateView{"avia", 35.2, -35.2, -38.6, 38.6, 24000},
                                         SolidStateView{"hap", 60.0, -60.0, -12.5, 12.5, 45300},
                                         SolidStateView{"flash", 60.0, -60.0, -30.0, 30.0, 7200}),
                         [](const auto& view) { return std::string(view.param.sensor); });

TEST_P(SolidState, FillsTheViewOfItsDataSheet)
{
  Simulation simulation(options());
  const Sweep sweep = simulation.sweep(0);
  EXPECT_LE(sweep.cloud.size(), GetParam().points);
  EXPECT_GT(sweep.cloud.size(), GetParam().points / 2);
  double left = -180.0;
  double right = 180.0;
  double below = 90.0;
  double above = -90.0;
  for (const PointXYZIRT& point : sweep.cloud) {
    const double azimuth = std::atan2(point.y, point.x) * 180.0 / kPi;
    const double elevation = std::atan2(point.z, std::hypot(point.x, point.y)) * 180.0 / kPi;
    left = std::max(left, azimuth);
    right = std::min(right, azimuth);
    below = std::min(below, elevation);
    above = std::max(above, elevation);
  }
  constexpr double kPart = 2.0;  // degrees that may go unseen at an edge
  EXPECT_NEAR(left, GetParam().left, kPart);
  EXPECT_NEAR(right, GetParam().right, kPart);
  EXPECT_NEAR(below, GetParam().below, kPart);
  EXPECT_NEAR(above, GetParam().above, kPart);
}

/// In other directions than the sweep before, but for pixels.
TEST_P(SolidState, DoesNotRepeatItsDirections)
{
  SimulationOptions standing = options();
  standing.standing = 0.0;
  Simulation simulation(standing);
  const Sweep first = simulation.sweep(0);
  const Sweep second = simulation.sweep(1);
  std::size_t repeated = 0;
  const std::size_t count = std::min(first.cloud.size(), second.cloud.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f apart = first.cloud[i].getVector3fMap() - second.cloud[i].getVector3fMap();
    repeated += apart.norm() < 1e-3F ? 1U : 0U;
  }
  const bool flash = simulation.sensor().pattern == ScanPattern::flash;
  EXPECT_EQ(repeated > count / 2, flash) << repeated << " of " << count;
}

TEST_P(SolidState, PointsAreCarriedByTheMotion)
{
  Simulation simulation(options());
  const Sweep sweep = simulation.sweep(0);
  for (std::size_t i = 0; i < sweep.cloud.size(); i += 101) {
    const SE3 world_T_sensor = simulation.worldTSensor(sweep.start_time + static_cast<double>(sweep.cloud[i].time));
    const Eigen::Vector3d place = world_T_sensor * sweep.cloud[i].getVector3fMap().cast<double>();
    EXPECT_LT((place - sweep.world_T_end * sweep.exact_at_end[i].cast<double>()).norm(), 1e-3);
  }
}

/// Follows the first scans of a simulation.
/// \param check takes the place in the simulation, the report, and how far off its pose is
template <typename Check>
void follow(const SimulationOptions& options, std::size_t scans, const Check& check)
{
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  SE3 world_T_first;
  for (std::size_t i = 0; i < scans; ++i) {
    const Sweep sweep = simulation.sweep(i);
    world_T_first = i == 0 ? sweep.world_T_end : world_T_first;
    const OdometryReport& report = odometry.track(sweep.cloud, sweep.start_time);
    const SE3 error = (world_T_first.inverse() * sweep.world_T_end).inverse() * report.world_T_sensor;
    check(i, report, error.translation.norm());
  }
}

/// The driver's numbers of the lasers are no scan lines.
TEST(SolidStateOdometry, IsFollowedWithoutBeingTold)
{
  for (const char* sensor : {"mid360", "avia", "hap"}) {
    SimulationOptions options = testWorld("room", sensor);
    options.seed = 5;
    follow(options, 30, [&](std::size_t i, const OdometryReport& report, double error) {
      EXPECT_EQ(report.engine, OdometryEngine::surfaces) << sensor;
      EXPECT_EQ(report.state, i == 0 ? TrackingState::initialized : TrackingState::tracked) << sensor << report.reason;
      EXPECT_LT(error, 0.05) << sensor << ", scan " << i;
    });
  }
}

/// Its door frames are few of the points, and what two sweeps show of them is less than their noise: until more has
/// been seen, any motion along it explains these about as well.
TEST(SolidStateOdometry, FindsItsWayAlongACorridorFromRest)
{
  SimulationOptions options = testWorld("corridor", "avia");
  for (const unsigned seed : {1U, 2U}) {
    options.seed = seed;
    double last = HUGE_VAL;  // m
    follow(options, 40, [&](std::size_t, const OdometryReport&, double error) { last = error; });
    EXPECT_LT(last, 0.1) << seed;
  }
}

/// Smooth walls tell nothing of the way, so that one does not move is as good as anything, and better than to run off.
TEST(SolidStateOdometry, StandsStillWhereNothingTellsThatItMoves)
{
  SimulationOptions options = testWorld("tunnel", "hap");
  for (const unsigned seed : {1U, 2U}) {
    options.seed = seed;
    follow(options, 40, [&](std::size_t i, const OdometryReport& report, double) {
      EXPECT_FALSE(report.state == TrackingState::tracked && !report.provisional) << seed << ", scan " << i;
      EXPECT_LT(report.world_T_sensor.translation.norm(), 1.0) << seed << ", scan " << i;
    });
  }
}

}  // namespace pcl_floam::simulator
