// The odometry on scans without lines, or with few.
#include "support/moving_room.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace pcl_floam::test {
namespace {

TEST(Odometry, NeedsNoScanLines)
{
  std::mt19937 random(5);
  const Eigen::Matrix3d turn = expSO3({0.9, 0.5, 0.3});
  const auto scanAt = [&](int k) {
    pcl::PointCloud<pcl::PointXYZ> scan;
    for (const PointXYZIRT& point : sweep([](double t) { return steadyPath(std::floor(t)); }, k)) {
      pcl::PointXYZ turned;
      turned.getVector3fMap() = turn.cast<float>() * point.getVector3fMap();
      scan.push_back(turned);
    }
    std::shuffle(scan.begin(), scan.end(), random);
    return scan;
  };
  Odometry<pcl::PointXYZ> odometry;
  for (int k = 0; k < 8; ++k) {
    const OdometryReport& report = odometry.track(scanAt(k));
    EXPECT_EQ(report.scan_lines, 0U);
    EXPECT_EQ(report.state, k == 0 ? TrackingState::initialized : TrackingState::tracked) << report.reason;
    EXPECT_LT((odometry.getPose().translation - turn * steadyPath(k).translation).norm(), 0.05) << "scan " << k;
    EXPECT_EQ(report.engine, OdometryEngine::surfaces);
  }
  Odometry<pcl::PointXYZ> later;
  later.localizeIn(odometry.map(), SE3(Eigen::Matrix3d::Identity(), turn * steadyPath(6).translation));
  EXPECT_EQ(later.track(scanAt(5)).state, TrackingState::tracked);
  EXPECT_LT((later.getPose().translation - turn * steadyPath(5).translation).norm(), 0.05);
}

TEST(Odometry, ScanLinesOrSpaceAsIsAskedFor)
{
  OdometryParameters parameters = defaults();
  const auto track = [&](const Cloud& scan) { return Odometry<PointXYZIRT>(parameters).track(scan); };
  const Cloud lines = sweep(steadyPath, 0);
  Cloud none = lines;  // in a frame on its side, without rings and shuffled
  std::mt19937 random(5);
  std::shuffle(none.begin(), none.end(), random);
  for (PointXYZIRT& point : none) {
    point.getVector3fMap() = expSO3({0.9, 0.5, 0.3}).cast<float>() * point.getVector3fMap();
    point.ring = 0;
  }
  EXPECT_GT(track(lines).scan_lines, 0U);
  EXPECT_EQ(track(lines).scan_line_failure, ScanLineFailure::none);
  EXPECT_EQ(track(none).scan_lines, 0U);
  EXPECT_EQ(track(none).scan_line_failure, ScanLineFailure::no_line_structure);

  if (isByFeatures()) {
    EXPECT_EQ(track(none).state, TrackingState::not_started);
    EXPECT_EQ(track(none).reason, toString(ScanLineFailure::no_line_structure));
  }

  parameters.sensor = sensorModel("solid-state");
  if (isByFeatures()) {
    EXPECT_THROW(track(lines), std::invalid_argument);
    return;
  }
  const OdometryReport report = track(lines);
  EXPECT_EQ(report.state, TrackingState::initialized);
  EXPECT_EQ(report.scan_line_failure, ScanLineFailure::not_looked_for);
  EXPECT_EQ(report.scan_lines + report.edges, 0U);
}

/// Its rings hold its height by their own pattern: it is tracked only where it keeps that.
TEST(Odometry, ALidarOfFourLayersIsTrackedOnlyInThePlane)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  constexpr int kPastTheStart = 16;  // scans, of which the first twelve are provisional in any case
  Lidar layers;
  layers.rings = 4;
  layers.lowest = -3.0;
  layers.highest = 3.0;
  OdometryParameters planar = defaults();
  planar.registration.locked = kPlanarMotion;
  for (const bool is_planar : {false, true}) {
    Odometry<PointXYZIRT> odometry(is_planar ? planar : defaults());
    for (int k = 0; k < kPastTheStart; ++k) {
      auto cloud = toCloud(sweepRoom(Room(), layers, [k](double fraction) { return steadyPath(k + fraction); }));
      for (PointXYZIRT& point : cloud) {
        point.ring += 6;  // as of a lidar of more lines that returns none of the others
      }
      const OdometryReport& report = odometry.track(cloud);
      EXPECT_EQ(report.scan_line_failure, ScanLineFailure::none);
      EXPECT_TRUE(is_planar || k == 0 || !report.reason.empty()) << "scan " << k;
      EXPECT_EQ(report.state == TrackingState::tracked, is_planar && k > 0) << "scan " << k << ": " << report.reason;
      const SE3 truth = steadyPath(1.0).inverse() * steadyPath(k + 1.0);
      EXPECT_LT((report.world_T_sensor.translation - truth.translation).head<2>().norm(), 0.01) << "scan " << k;
    }
  }
}

/// As every eighth point of a file of 32 lines leaves them: each line is there somewhere, and no two neighbours side by
/// side.
TEST(Odometry, AScanOfFourLinesInEachDirectionIsTracked)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    Cloud thinned;
    for (const PointXYZIRT& point : sweep(steadyPath, k)) {
      const auto part = static_cast<int>(2.0 * (4.0 + std::atan2(point.y, point.x)));
      if (point.ring % 8 == part % 8) {
        thinned.push_back(point);
      }
    }
    const OdometryReport& report = odometry.track(thinned);
    EXPECT_EQ(report.state, k == 0 ? TrackingState::initialized : TrackingState::tracked) << report.reason;
    const SE3 truth = steadyPath(1.0).inverse() * steadyPath(k + 1.0);
    EXPECT_LT((report.world_T_sensor.translation - truth.translation).norm(), 0.01) << "scan " << k;
  }
}

/// Few points are not few lines.
TEST(Odometry, AScanOfFewPointsHasItsLines)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  std::mt19937 random(3);
  for (const unsigned one_in : {2U, 8U, 32U}) {
    Odometry<PointXYZIRT> odometry(defaults());
    Cloud thinned;
    for (const PointXYZIRT& point : sweep(steadyPath, 0)) {
      if (random() % one_in == 0) {
        thinned.push_back(point);
      }
    }
    EXPECT_EQ(odometry.track(thinned).scan_line_failure, ScanLineFailure::none) << one_in;
  }
}

/// Of height, roll and pitch it tells nothing, whatever fits: it is tracked only where these are kept.
TEST(Odometry, ALidarOfASingleLayerIsTrackedOnlyInThePlane)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  constexpr int kPastTheStart = 20;  // scans
  Lidar layer;
  layer.rings = 2;  // of which one is left out
  layer.lowest = 0.0;
  const auto levelPath = [](double k) {
    return SE3(expSO3(Eigen::Vector3d(0.0, 0.0, 0.03 * k)), Eigen::Vector3d(0.04 * k, 0.01 * k, 0.0));
  };
  constexpr DegreesOfFreedom kFree = {};
  constexpr DegreesOfFreedom kHeight = {false, false, true, false, false, false};
  for (const DegreesOfFreedom& locked : {kFree, kHeight, kPlanarMotion}) {
    OdometryParameters parameters = defaults();
    parameters.registration.locked = locked;
    Odometry<pcl::PointXYZ> odometry(parameters);
    for (int k = 0; k < kPastTheStart; ++k) {
      pcl::PointCloud<pcl::PointXYZ> cloud;
      for (const PointXYZIRT& point : toCloud(sweepRoom(Room(), layer, [&](double) { return levelPath(k); }))) {
        if (point.ring == 0) {
          cloud.emplace_back(point.x, point.y, point.z);
        }
      }
      const OdometryReport& report = odometry.track(cloud);
      EXPECT_EQ(report.scan_line_failure, ScanLineFailure::single_layer);
      if (locked == kPlanarMotion) {
        EXPECT_EQ(report.state, k == 0 ? TrackingState::initialized : TrackingState::tracked) << report.reason;
        EXPECT_LT((report.world_T_sensor.translation - levelPath(k).translation).norm(), 0.01) << "scan " << k;
      } else {
        EXPECT_NE(report.state, TrackingState::tracked) << "scan " << k;
      }
    }
    EXPECT_EQ(odometry.report().reason.find("single layer") != std::string::npos, locked == kHeight);
  }
}

}  // namespace
}  // namespace pcl_floam::test
