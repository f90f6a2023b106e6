// A smooth corridor, where nothing tells of the way along it.

#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

/// Once the map is more than the noise of a few scans no scan is called tracked, and most name the direction.
TEST(UnobservableDirection, IsReported)
{
  constexpr std::size_t kTunnelScans = 80;
  constexpr std::size_t kJudgedFrom = 15;
  SimulationOptions options = testWorld("tunnel");
  options.seed = 25;
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  std::size_t named = 0;
  for (std::size_t scan = 0; scan < kTunnelScans; ++scan) {
    const OdometryReport& report = odometry.track(simulation.sweep(scan).cloud, 0.1 * static_cast<double>(scan));
    const bool is_named = !report.registration.weak_directions.empty();
    named += is_named && scan >= kJudgedFrom ? 1 : 0;
    EXPECT_TRUE(scan < kJudgedFrom || report.state == TrackingState::doubtful) << scan;
    EXPECT_TRUE(!is_named || report.registration.covariance.trace() > 1e-4) << scan;
  }
  EXPECT_GT(named, (kTunnelScans - kJudgedFrom) * 4 / 5);
}

/// Far along its walls a dense lidar's columns lie as far apart as doors are wide, and move with the sensor: where ten
/// scans in a row are called tracked, it has not moved off by half a metre.
TEST(UnobservableDirection, IsNotHiddenByTheSensorsOwnColumns)
{
  constexpr double kSlip = 0.5;  // m
  constexpr std::size_t kSecond = 10;
  constexpr std::size_t kCorridorScans = 40;
  std::size_t judged = 0;
  for (const unsigned seed : {6U, 9U, 14U}) {
    SimulationOptions options = testWorld("corridor", "os64");
    options.seed = seed;
    Simulation simulation(options);
    OdometryParameters parameters;
    parameters.pose_instant = PoseInstant::middle;
    Odometry<PointXYZIRT> odometry(parameters);
    std::vector<SE3> truth;
    std::vector<SE3> tracked;  // without a doubt or a correction between them
    for (std::size_t scan = 0; scan < kCorridorScans; ++scan) {
      const Sweep sweep = simulation.sweep(scan);
      const OdometryReport& report = odometry.track(sweep.cloud, 0.1 * static_cast<double>(scan));
      truth.push_back(sweep.world_T_middle);
      if (report.state != TrackingState::tracked || !report.corrected_poses.empty()) {
        tracked.clear();
      }
      tracked.push_back(odometry.getPose());
      if (tracked.size() > kSecond) {
        ++judged;
        const SE3 moved = tracked[tracked.size() - 1 - kSecond].inverse() * tracked.back();
        const SE3 off = (truth[scan - kSecond].inverse() * truth[scan]).inverse() * moved;
        EXPECT_LT(off.translation.norm(), kSlip) << "seed " << seed << ", scan " << scan;
      }
    }
  }
  EXPECT_GT(judged, 0U) << "nothing was tracked for a second";
}

/// Between doors a corridor tells nothing, and noise must not either: neither that the sensor stands still, nor, by how
/// the directions of its walls vary from scan to scan, that it jumps.
TEST(UnobservableDirection, IsGoneThroughBetweenDoors)
{
  constexpr std::size_t kStarted = 50;
  constexpr std::size_t kCorridorScans = 200;
  constexpr double kFarthestOff = 0.2;  // m, over 22 m
  for (const unsigned seed : {2U, 4U}) {
    SimulationOptions options = testWorld("corridor");
    options.realism = Realism::real;
    options.seed = seed;
    Simulation simulation(options);
    OdometryParameters parameters;
    parameters.pose_instant = PoseInstant::middle;
    Odometry<PointXYZIRT> odometry(parameters);
    SE3 truth_there;
    SE3 there;
    for (std::size_t scan = 0; scan < kCorridorScans; ++scan) {
      const Sweep sweep = simulation.sweep(scan);
      odometry.track(sweep.cloud, 0.1 * static_cast<double>(scan));
      if (scan == kStarted) {
        truth_there = sweep.world_T_middle;
        there = odometry.getPose();
      } else if (scan > kStarted) {
        const SE3 off =
            (truth_there.inverse() * sweep.world_T_middle).inverse() * (there.inverse() * odometry.getPose());
        ASSERT_LT(off.translation.norm(), kFarthestOff) << "seed " << seed << ", scan " << scan;
      }
    }
  }
}

/// Wheels that are 2 cm off in each period tell of the way along; the scans tell of the rest.
TEST(UnobservableDirection, IsLeftToAHint)
{
  constexpr std::size_t kTunnelScans = 80;
  constexpr double kWheels = 0.02;   // m
  constexpr double kUnknown = 10.0;  // m and rad
  SimulationOptions options = testWorld("tunnel");
  options.seed = 26;
  Simulation simulation(options);
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, kWheels);
  SE3 first;
  SE3 last;
  double farthest = 0.0;
  for (std::size_t scan = 0; scan < kTunnelScans; ++scan) {
    const Sweep sweep = simulation.sweep(scan);
    if (scan > 0) {
      MotionHint hint;
      hint.last_T_now.translation.x() = (last.inverse() * sweep.world_T_middle).translation.x() + noise(random);
      hint.covariance.diagonal().setConstant(kUnknown * kUnknown);
      hint.covariance(0, 0) = kWheels * kWheels;
      odometry.setMotionHint(hint);
    } else {
      first = sweep.world_T_middle;
    }
    last = sweep.world_T_middle;
    odometry.track(sweep.cloud, 0.1 * static_cast<double>(scan));
    const SE3 error = (first.inverse() * last).inverse() * odometry.getPose();
    farthest = std::max(farthest, error.translation.norm());
  }
  RecordProperty("farthest_m", std::to_string(farthest));
  EXPECT_LT(farthest, 4.0 * kWheels * std::sqrt(static_cast<double>(kTunnelScans)));
}

/// Whatever motion the first scans were found with.
TEST(UnobservableDirection, IsLeftToAHintFromTheFirstScanOn)
{
  constexpr std::size_t kFirstScans = 20;
  constexpr double kWheels = 0.005;                 // m
  SimulationOptions options = testWorld("tunnel");  // from rest
  options.seed = 27;
  Simulation simulation(options);
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  std::vector<SE3> truth;
  std::vector<SE3> found;
  for (std::size_t scan = 0; scan < kFirstScans; ++scan) {
    const Sweep sweep = simulation.sweep(scan);
    if (scan > 0) {
      odometry.setMotionHint(
          {truth.back().inverse() * sweep.world_T_middle, kWheels * kWheels * Matrix6(Matrix6::Identity())});
    }
    truth.push_back(sweep.world_T_middle);
    const OdometryReport& report = odometry.track(sweep.cloud, 0.1 * static_cast<double>(scan));
    std::copy(report.corrected_poses.begin(), report.corrected_poses.end(),
              found.end() - static_cast<std::ptrdiff_t>(report.corrected_poses.size()));
    found.push_back(report.world_T_sensor);
  }
  for (std::size_t scan = 1; scan < kFirstScans; ++scan) {
    const SE3 motion = found[scan - 1].inverse() * found[scan];
    const SE3 error = (truth[scan - 1].inverse() * truth[scan]).inverse() * motion;
    EXPECT_LT(error.translation.norm(), 4.0 * kWheels) << scan;
  }
}

}  // namespace pcl_floam::simulator
