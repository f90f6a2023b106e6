// What an odometry is told from outside: a map made before, a pose, a motion.
#include "support/moving_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_floam::test {
namespace {

TEST(OdometryIsTold, LocalizesInAMapMadeBefore)
{
  Odometry<PointXYZIRT> mapping(defaults());
  for (int k = 0; k < kScans; ++k) {
    mapping.track(sweep(steadyPath, k));
  }
  const SE3 map_T_world = steadyPath(1.0).inverse();  // the map's origin is the end of the first sweep
  const auto otherPath = [](double t) {
    return SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, 0.4, 0.1)) * acceleratedPath(t + 3.0);
  };
  for (const MapUse use : {MapUse::frozen, MapUse::kept_current}) {
    Odometry<PointXYZIRT> odometry(defaults());
    const SE3 guess = map_T_world * otherPath(1.0) * exp((Vector6() << 0.5, -0.4, 0.2, 0.02, -0.03, 0.08).finished());
    odometry.localizeIn(mapping.map(), guess, use);
    for (int k = 0; k < kScans; ++k) {
      const OdometryReport& report = odometry.track(sweep(otherPath, k));
      EXPECT_EQ(report.state, TrackingState::tracked) << report.reason;
      EXPECT_EQ(report.keyframe && use == MapUse::frozen, false);
      const SE3 error = (map_T_world * otherPath(k + 1.0)).inverse() * report.world_T_sensor;
      EXPECT_LT(error.translation.norm(), k < 2 ? 0.3 : 0.05) << "scan " << k;
    }
    const bool same = odometry.map().size(FeatureKind::plane) == mapping.map().size(FeatureKind::plane);
    EXPECT_EQ(same, use == MapUse::frozen);
  }
}

/// Two of three returns come from where the map has nothing.
TEST(OdometryIsTold, APoseThatMostOfTheScanDoesNotBearOutIsDoubtful)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  Odometry<PointXYZIRT> mapping(defaults());
  for (int k = 0; k < kScans; ++k) {
    mapping.track(sweep(steadyPath, k));
  }
  const Cloud scan = sweep(steadyPath, 0);
  Cloud strange = scan;
  for (const float up : {20.0F, 40.0F}) {
    for (PointXYZIRT point : scan) {
      point.z += up;
      strange.push_back(point);
    }
  }
  for (const bool is_strange : {false, true}) {
    Odometry<PointXYZIRT> odometry(defaults());
    odometry.localizeIn(mapping.map(), SE3(), MapUse::frozen);
    const OdometryReport& report = odometry.track(is_strange ? strange : scan);
    EXPECT_EQ(report.state, is_strange ? TrackingState::doubtful : TrackingState::tracked) << report.explained;
    EXPECT_EQ(report.reason.empty(), !is_strange);
  }
}

/// What a scan brought into the map at a wrong pose would bear out the next ones.
TEST(OdometryIsTold, AMapOfAnotherRoomIsLeftAlone)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  Odometry<PointXYZIRT> mapping(defaults());
  for (int k = 0; k < kScans; ++k) {
    mapping.track(sweep(steadyPath, k));
  }
  Room other;
  other.walls = {{-40.0, -28.0, -1.2}, {45.0, 30.0, 9.0}};
  other.furniture = {{{6.0, 8.0, -1.2}, {12.0, 9.0, 4.0}}, {{-14.0, -9.0, -1.2}, {-11.0, 3.0, 5.0}}};
  Odometry<PointXYZIRT> odometry(defaults());
  odometry.localizeIn(mapping.map(), SE3(), MapUse::kept_current);
  constexpr int kLong = 40;  // an odometry's own map would take scans in again by then
  int registered = 0;
  for (int k = 0; k < kLong; ++k) {
    const auto there = [&](double fraction) { return steadyPath(k + fraction); };
    const OdometryReport& report = odometry.track(toCloud(sweepRoom(other, Lidar(), there)));
    EXPECT_NE(report.state, TrackingState::tracked) << "scan " << k << ' ' << report.explained;
    registered += report.registration.hasConverged() ? 1 : 0;
  }
  EXPECT_GT(registered, 0) << "else nothing could have entered";
  EXPECT_EQ(odometry.map().size(FeatureKind::plane), mapping.map().size(FeatureKind::plane));
}

TEST(OdometryIsTold, AMapToLocalizeInMustHoldSomething)
{
  Odometry<PointXYZIRT> odometry(defaults());
  EXPECT_THROW(odometry.localizeIn(KeyframeVoxelMap(), SE3()), std::invalid_argument);
}

MotionHint wheelsOf(const Path& path, int k)
{
  constexpr double kSigma = 1e-3;
  return {path(k - 0.5).inverse() * path(k + 0.5), kSigma * kSigma * Matrix6(Matrix6::Identity())};
}

/// Above its last beams rings are all that moves with the sensor between four bare walls.
class Shaft {
public:
  Shaft()
  {
    shaft_.walls = {{-1.5, -2.8, -0.3}, {1.5, 2.8, 60.0}};
    shaft_.furniture.clear();
    for (double z = 0.0; z < 10.0; z += 3.2) {
      shaft_.furniture.push_back({{-1.5, 2.6, z}, {1.5, 2.8, z + 0.25}});
      shaft_.furniture.push_back({{-1.5, -0.5, z + 1.0}, {-1.3, 0.2, z + 1.5}});
    }
    lidar_.rings = 16;
    lidar_.lowest = -15.0;
  }

  static SE3 up(double t)
  {
    return SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.0, 0.08 * std::max(0.0, t - 5.0)));
  }

  Cloud sweep(int k)
  {
    std::normal_distribution<double> noise(0.0, 0.01);  // m
    std::vector<Return> returns = sweepRoom(shaft_, lidar_, [&](double fraction) { return up(k + fraction); });
    for (Return& r : returns) {
      r.point *= 1.0 + noise(random_) / r.point.norm();
    }
    return toCloud(returns);
  }

private:
  Room shaft_;
  Lidar lidar_;
  std::mt19937 random_ = std::mt19937(1);
};

TEST(OdometryIsTold, NothingOfTheWayUpAShaft)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  constexpr int kManyScans = 60;
  Shaft shaft;
  Odometry<PointXYZIRT> odometry(defaults());
  int said = 0;
  for (int k = 0; k < kManyScans; ++k) {
    const OdometryReport& report = odometry.track(shaft.sweep(k));
    const bool is_said_to_be_right = report.state == TrackingState::tracked && !report.provisional;
    said += is_said_to_be_right ? 1 : 0;
    EXPECT_FALSE(is_said_to_be_right && error(report.world_T_sensor, Shaft::up, k) > 0.3) << "scan " << k;
  }
  EXPECT_GT(said, 0) << "near the floor";
}

TEST(OdometryIsTold, OfTheWayUpAShaftByAHint)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  constexpr int kManyScans = 60;
  constexpr int kStart = 15;
  Shaft shaft;
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kManyScans; ++k) {
    if (k > 0) {
      odometry.setMotionHint(wheelsOf(Shaft::up, k));
    }
    const OdometryReport& report = odometry.track(shaft.sweep(k));
    EXPECT_LT(error(report.world_T_sensor, Shaft::up, k), 0.1) << "scan " << k;
    EXPECT_TRUE(k < kStart || report.state == TrackingState::tracked) << k << ": " << report.reason;
  }
}

TEST(OdometryIsTold, AHintTakesItOverScansThatAreMissing)
{
  double without = 0.0;
  for (const bool told : {false, true}) {
    Odometry<PointXYZIRT> odometry(defaults());
    for (int k = 0; k < kScans; ++k) {
      const bool missing = k >= 8 && k < 12;
      if (told && k > 0) {
        odometry.setMotionHint(wheelsOf(acceleratedPath, k));
      }
      const OdometryReport& report = missing ? odometry.trackMissing() : odometry.track(sweep(acceleratedPath, k));
      EXPECT_EQ(report.state == TrackingState::predicted, missing) << "scan " << k;
      const double off = error(report.world_T_sensor, acceleratedPath, k);
      without = told || k != 11 ? without : off;
      // By features the first sweep afterwards is undistorted with the mean motion of all that time.
      EXPECT_TRUE(!told || off < (k == 12 ? 0.07 : 0.04)) << "scan " << k << ": " << off;
    }
  }
  EXPECT_GT(without, 0.1) << "else nothing was shown";
  Odometry<PointXYZIRT> odometry(defaults());
  EXPECT_THROW(odometry.setMotionHint({SE3(), Matrix6::Zero()}), std::invalid_argument);
}

/// Carried away while nobody looked: `world_T_sensor` of the sweeps that follow.
SE3 elsewhere(double t)
{
  return steadyPath(4.0) * SE3(expSO3({0.0, 0.0, 1.2}), Eigen::Vector3d(0.2, 0.5, 0.1)) *
         exp(Vector6(t * Vector6::Unit(0) * 0.2));
}

/// In the map, whose origin is the end of the first sweep.
SE3 elsewhereInMap(int k)
{
  return steadyPath(1.0).inverse() * elsewhere(k + 1.0);
}

TEST(OdometryIsTold, APoseThatIsSetKeepsTheMap)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    odometry.track(sweep(steadyPath, k));
  }
  const std::size_t points = odometry.map().size(FeatureKind::plane);
  odometry.setPose(elsewhereInMap(0) * exp((Vector6() << 0.4, -0.3, 0.1, 0.02, -0.02, 0.08).finished()));
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(odometry.track(sweep(elsewhere, k)).state, TrackingState::tracked);
    const SE3 off = elsewhereInMap(k).inverse() * odometry.getPose();
    EXPECT_LT(off.translation.norm(), k < 2 ? 0.15 : 0.05) << "scan " << k;
  }
  EXPECT_GE(odometry.map().size(FeatureKind::plane), points);
  SE3 nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(odometry.setPose(nowhere), std::invalid_argument);
}

TEST(OdometryIsTold, APoseHoldsOverScansThatTellNothing)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    odometry.track(sweep(steadyPath, k));
  }
  odometry.setPose(elsewhereInMap(0));
  odometry.setMotionHint(wheelsOf(steadyPath, kScans));  // of a way that counts no more
  EXPECT_EQ(odometry.trackMissing().state, TrackingState::predicted);
  EXPECT_LT((odometry.getPose().translation - elsewhereInMap(0).translation).norm(), 0.01);
  Cloud nowhere = sweep(elsewhere, 1);
  for (PointXYZIRT& point : nowhere) {
    point.x += 1000.0F;
  }
  EXPECT_EQ(odometry.track(nowhere).state, TrackingState::predicted);
  for (int k = 1; k < 6; ++k) {
    EXPECT_EQ(odometry.track(sweep(elsewhere, k)).state, TrackingState::tracked) << k;
    EXPECT_LT((odometry.getPose().translation - elsewhereInMap(k).translation).norm(), k < 3 ? 0.15 : 0.05) << k;
  }
}

/// Whatever the start is at: nothing known, one scan, motions that are followed, all decided.
TEST(OdometryIsTold, APoseCanBeSetAtAnyTime)
{
  const SE3 offset(expSO3({0.0, 0.0, 2.0}), Eigen::Vector3d(30.0, -20.0, 1.0));
  for (const int scans : {0, 1}) {  // the pose is the first scan's
    Odometry<PointXYZIRT> odometry(defaults());
    for (int k = 0; k < 6; ++k) {
      if (k == scans) {
        odometry.setPose(offset);
      }
      const OdometryReport& report = odometry.track(sweep(steadyPath, k));
      EXPECT_EQ(report.state, k == 0 ? TrackingState::initialized : TrackingState::tracked);
      EXPECT_TRUE(report.reason.empty()) << report.reason;
      EXPECT_TRUE(k < scans || error(offset.inverse() * odometry.getPose(), steadyPath, k) < 0.05) << scans << ' ' << k;
    }
  }
  for (const int scans : {3, 8, 12, 15}) {  // it is where the map has the sensor
    Odometry<PointXYZIRT> odometry(defaults());
    for (int k = 0; k < scans; ++k) {
      odometry.track(sweep(steadyPath, k));
    }
    odometry.setPose(elsewhereInMap(0));
    for (int k = 0; k < 12; ++k) {
      const OdometryReport& report = odometry.track(sweep(elsewhere, k));
      EXPECT_EQ(report.state, TrackingState::tracked);
      EXPECT_TRUE(report.corrected_poses.empty()) << scans << ' ' << k;
      EXPECT_LT((odometry.getPose().translation - elsewhereInMap(k).translation).norm(), k < 2 ? 0.15 : 0.05)
          << scans << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
