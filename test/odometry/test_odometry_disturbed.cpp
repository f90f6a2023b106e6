// What goes wrong with scans and their stamps: blind, missing, out of place, at random.
#include "support/moving_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

/// A scan of less points than the one before is not looked at with that one's.
TEST(OdometryDisturbed, PredictsOverScansOfNoOrFewPoints)
{
  for (const char* const sensor : {"auto", "solid-state"}) {
    OdometryParameters parameters = defaults();
    parameters.sensor = sensorModel(sensor);
    if (isByFeatures() && !parameters.sensor.has_scan_lines) {
      continue;
    }
    Odometry<PointXYZIRT> odometry(parameters);
    for (int k = 0; k < kScans; ++k) {
      Cloud scan = sweep(steadyPath, k);
      if (k == 3 || k == 5) {
        scan.resize(k == 3 ? 0 : 5);
        scan.points.shrink_to_fit();
      }
      const OdometryReport& report = odometry.track(scan);
      EXPECT_EQ(report.state == TrackingState::predicted, k == 3 || k == 5) << k << report.reason;
    }
  }
}

TEST(OdometryDisturbed, PredictsOverABlindScanAndTracksAgain)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    Cloud scan = sweep(steadyPath, k);
    const bool blind = k == 8 || k == 9;
    if (blind) {
      for (PointXYZIRT& point : scan) {
        point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
      }
      scan.is_dense = false;
    }
    const OdometryReport& report = odometry.track(scan);
    if (k > 0) {
      EXPECT_EQ(report.state, blind ? TrackingState::predicted : TrackingState::tracked) << "scan " << k;
    }
    EXPECT_EQ(report.reason.empty(), !blind);
    EXPECT_LT(error(report.world_T_sensor, steadyPath, k), 0.05) << "scan " << k;
  }
}

TEST(OdometryDisturbed, KeepsGoingOverMissingScans)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    const bool missing = k == 6 || k == 7 || k == 12;
    const OdometryReport& report = missing ? odometry.trackMissing() : odometry.track(sweep(steadyPath, k));
    EXPECT_EQ(report.state == TrackingState::predicted, missing) << "scan " << k;
    EXPECT_LT(error(odometry.getPose(), steadyPath, k), 0.05) << "scan " << k;
  }
}

TEST(OdometryDisturbed, StampsTellOfAGap)
{
  // Three sweeps were never delivered, and nobody said so: the stamps do.
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    if (k < 8 || k > 10) {
      EXPECT_NE(odometry.track(sweep(steadyPath, k), 100.0 + 0.1 * k).state, TrackingState::predicted);
      EXPECT_LT(error(odometry.getPose(), steadyPath, k), 0.05) << "scan " << k;
    }
  }
}

/// They fit a map here and there by chance, and must not enter it.
TEST(OdometryDisturbed, PointsAnywhereAreNoPose)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  std::mt19937 random(4);
  std::uniform_real_distribution<float> anywhere(-60.0F, 60.0F);
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    Cloud scan = sweep(steadyPath, k);
    const bool is_strange = k == 14;
    if (is_strange) {
      for (PointXYZIRT& point : scan) {
        point.getVector3fMap() = Eigen::Vector3f(anywhere(random), anywhere(random), anywhere(random));
      }
    }
    const std::size_t planes = odometry.map().size(FeatureKind::plane);
    const OdometryReport& report = odometry.track(scan);
    EXPECT_EQ(report.state == TrackingState::predicted, is_strange) << "scan " << k;
    EXPECT_LT(error(report.world_T_sensor, steadyPath, k), 0.05) << "scan " << k;
    EXPECT_TRUE(!is_strange || odometry.map().size(FeatureKind::plane) == planes);
  }
}

/// As of rain, sunlight and other lidars: one return in twenty, which each have a place of their own.
TEST(OdometryDisturbed, ReturnsAtAnyRangeAreNotTheScene)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any_range(1.0F, 60.0F);
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    Cloud scan = sweep(steadyPath, k);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (random() % 20 == 0) {
        scan[i].getVector3fMap() = any_range(random) * scan[i].getVector3fMap().normalized();
      }
    }
    const OdometryReport& report = odometry.track(scan);
    EXPECT_TRUE(k == 0 || report.state == TrackingState::tracked) << "scan " << k << report.reason;
    EXPECT_GT(report.isolated_returns, scan.size() / 30) << "most of them";
    EXPECT_LT(error(report.world_T_sensor, steadyPath, k), 0.05) << "scan " << k;
  }
}

/// Further from where it was expected than any motion tells of.
TEST(OdometryDisturbed, IsFoundAgainAfterAJump)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  const auto jumpingPath = [](double t) {
    return t <= 14.0 ? steadyPath(t) : steadyPath(t) * SE3(expSO3({0.0, 0.0, 0.2}), Eigen::Vector3d(-0.5, 0.8, 0.0));
  };
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    const OdometryReport& report = odometry.track(sweep(jumpingPath, k));
    EXPECT_LT(error(report.world_T_sensor, jumpingPath, k), k == 14 ? 0.2 : 0.1) << "scan " << k;
  }
}

/// The same scan may come twice, with its time, and a time may be missing or stand still.
TEST(OdometryDisturbed, StampsMayStandStillOrBeMissing)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    std::optional<double> stamp = 100.0 + 0.1 * k;
    switch (k % 8) {
      case 5: *stamp -= 0.1; break;
      case 7: stamp.reset(); break;
      default: break;
    }
    const Cloud scan = sweep(acceleratedPath, k);
    EXPECT_NE(odometry.track(scan, stamp).state, TrackingState::predicted);
    EXPECT_LT(error(odometry.getPose(), acceleratedPath, k), 0.05) << "scan " << k;
  }
}

/// As by a hand or a sack, while it is carried on: what covers it must not become the world.
TEST(OdometryDisturbed, ACoveredSensorIsNotTrackedWrongly)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  constexpr int kLong = 40;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);  // m
  for (const double nearness : {0.6, 1.0}) {
    Odometry<PointXYZIRT> odometry(defaults());
    for (int k = 0; k < kLong; ++k) {
      Cloud scan = sweep(steadyPath, k);
      const bool is_covered = k >= 15 && k < 27;
      for (PointXYZIRT& point : scan) {
        const double azimuth = std::atan2(static_cast<double>(point.y), static_cast<double>(point.x));
        const double range = point.getVector3fMap().cast<double>().norm();
        const double cover = nearness + 0.1 * std::sin(2.0 * azimuth) + 0.05 * std::sin(5.0 * azimuth + 1.0);
        point.getVector3fMap() *= static_cast<float>(((is_covered ? cover : range) + noise(random)) / range);
      }
      const OdometryReport& report = odometry.track(scan);
      EXPECT_TRUE(k == 0 || k >= 15 || report.state == TrackingState::tracked) << "scan " << k << ' ' << report.reason;
      EXPECT_TRUE(report.state != TrackingState::tracked || error(report.world_T_sensor, steadyPath, k) < 0.3)
          << "scan " << k;
    }
  }
}

/// With its stamp; as if it had not come.
TEST(OdometryDisturbed, AScanThatComesTwiceTellsNothingMore)
{
  Odometry<PointXYZIRT> once(defaults());
  Odometry<PointXYZIRT> twice(defaults());
  std::vector<SE3> given;  // to all that came
  for (int k = 0; k < kScans; ++k) {
    const double stamp = 100.0 + 0.1 * k;
    const Cloud scan = sweep(acceleratedPath, k);
    const OdometryReport& expected = once.track(scan, stamp);
    const OdometryReport report = twice.track(scan, stamp);
    EXPECT_EQ(report.state, expected.state) << "scan " << k << ' ' << report.reason;
    EXPECT_TRUE(sameBits(report.world_T_sensor, expected.world_T_sensor)) << "scan " << k;
    EXPECT_EQ(report.covariance, expected.covariance) << "scan " << k;
    ASSERT_EQ(report.corrected_poses.empty(), expected.corrected_poses.empty()) << "scan " << k;
    const std::vector<SE3>& corrected = report.corrected_poses;
    std::copy(corrected.begin(), corrected.end(), given.end() - static_cast<std::ptrdiff_t>(corrected.size()));
    given.push_back(report.world_T_sensor);
    if (k % 3 != 1) {
      const OdometryReport& again = twice.track(scan, stamp);
      EXPECT_EQ(again.state, expected.state) << "scan " << k;
      EXPECT_TRUE(sameBits(again.world_T_sensor, expected.world_T_sensor)) << "scan " << k;
      EXPECT_FALSE(again.keyframe || again.reason.empty() || !again.corrected_poses.empty()) << "scan " << k;
      given.push_back(again.world_T_sensor);
      EXPECT_LT((given.back().translation - given[given.size() - 2].translation).norm(), 1e-9);
    }
  }
  for (std::size_t i = 0, k = 0; k < kScans; ++i, ++k) {
    i += k > 0 && (k - 1) % 3 != 1 ? 1 : 0;
    EXPECT_LT(error(given[i], acceleratedPath, static_cast<int>(k)), 0.05) << "scan " << k;
  }
}

TEST(OdometryDisturbed, StartsWithTheFirstUsableScan)
{
  Odometry<PointXYZIRT> odometry(defaults());
  EXPECT_EQ(odometry.track(Cloud()).state, TrackingState::not_started);
  EXPECT_EQ(odometry.trackMissing().state, TrackingState::not_started);
  Cloud blank = sweep(steadyPath, 0);
  for (PointXYZIRT& point : blank) {
    point.x = point.y = point.z = 0.0F;
  }
  EXPECT_EQ(odometry.track(blank).state, TrackingState::not_started);
  EXPECT_FALSE(odometry.report().reason.empty());
  EXPECT_TRUE(sameBits(odometry.getPose(), SE3()));
  EXPECT_TRUE(odometry.map().empty());
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(odometry.track(sweep(steadyPath, k)).state, k == 0 ? TrackingState::initialized : TrackingState::tracked);
    EXPECT_LT(error(odometry.getPose(), steadyPath, k), 0.03);
  }
}

TEST(OdometryDisturbed, ASecondBlindScanDoesNotHarmTheStart)
{
  Odometry<PointXYZIRT> odometry(defaults());
  odometry.track(sweep(steadyPath, 0));
  EXPECT_EQ(odometry.trackMissing().state, TrackingState::predicted);
  for (int k = 2; k < 10; ++k) {
    EXPECT_EQ(odometry.track(sweep(steadyPath, k)).state, TrackingState::tracked);
    EXPECT_LT(error(odometry.getPose(), steadyPath, k), 0.05) << "scan " << k;
  }
}

}  // namespace
}  // namespace pcl_floam::test
