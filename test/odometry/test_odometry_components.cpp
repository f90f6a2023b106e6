// Objects of one's own in the odometry: factors, keyframes, points, map.
#include "support/constants.h"
#include "support/counting_map.h"
#include "support/moving_room.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr int kFewScans = 6;

/// The sensor is at a height in the world.
class Height : public PoseFactor {
public:
  Height(double height, double deviation) : height_(height), variance_(deviation * deviation) {}

  void addTo(const SE3& target_T_source, PoseEquations& equations) const override
  {
    Vector6 up;
    up << 0.0, 0.0, 1.0, 0.0, 0.0, 0.0;
    equations.add(target_T_source.translation.z() - height_, up, variance_);
  }

private:
  double height_;
  double variance_;
};

OdometryComponents withFactor(const PoseFactor::ConstPtr& factor)
{
  OdometryComponents components;
  components.factors = {factor};
  return components;
}

std::vector<OdometryReport> reportsOf(const OdometryComponents& components, const SE3& begin = {}, int threads = 1)
{
  OdometryParameters parameters = defaults();
  parameters.threads = threads;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  odometry.setComponents(components);
  odometry.reset(begin);
  std::vector<OdometryReport> reports;
  for (int k = 0; k < kFewScans; ++k) {
    reports.push_back(odometry.track(sweep(steadyPath, k)));
  }
  return reports;
}

TEST(OdometryComponents, AFactorThatIsSureDecides)
{
  for (const double turn : {0.0, 1.2}) {  // about x: the height is another direction of the scan
    const SE3 begin(expSO3(Eigen::Vector3d(turn, 0.0, 0.0)), Eigen::Vector3d(5.0, -3.0, 2.0));
    const auto reports = reportsOf(withFactor(std::make_shared<Height>(2.03, 1e-5)), begin);
    for (int k = 2; k < kFewScans; ++k) {
      EXPECT_NEAR(reports[k].world_T_sensor.translation.z(), 2.03, 1e-3) << turn << ' ' << k;
      EXPECT_LT(reports[k].covariance(2, 2), 1e-8) << turn << ' ' << k;
    }
  }
}

TEST(OdometryComponents, AFactorThatKnowsNothingChangesNothing)
{
  const auto with = reportsOf(withFactor(std::make_shared<Height>(2.0, 1e6)));
  const auto without = reportsOf({});
  for (int k = 0; k < kFewScans; ++k) {
    EXPECT_LT((with[k].world_T_sensor.translation - without[k].world_T_sensor.translation).norm(), 1e-6) << k;
  }
}

TEST(OdometryComponents, ThreadsChangeNothing)
{
  const OdometryComponents components = withFactor(std::make_shared<Height>(0.02, 0.01));
  const auto one = reportsOf(components);
  const auto three = reportsOf(components, {}, 3);
  for (int k = 0; k < kFewScans; ++k) {
    EXPECT_TRUE(sameBits(one[k].world_T_sensor, three[k].world_T_sensor)) << k;
  }
}

TEST(OdometryComponents, TheRuleChoosesKeyframes)
{
  std::atomic<int> asked{0};
  OdometryComponents components;
  components.is_keyframe = [&](const SE3& last, const SE3& pose) {
    ++asked;
    EXPECT_LT((pose.translation - last.translation).norm(), 10.0);
    return false;
  };
  reportsOf(components);
  EXPECT_GE(asked, kFewScans - 2);
}

TEST(OdometryComponents, AreRefusedIfNull)
{
  OdometryPipeline odometry(defaults());
  EXPECT_THROW(odometry.setComponents(withFactor(nullptr)), std::invalid_argument);
}

TEST(OdometryComponents, StayOverAResetAndAreCopied)
{
  Odometry<PointXYZIRT> odometry(defaults());
  odometry.setComponents(withFactor(std::make_shared<Height>(0.0, 1.0)));
  odometry.reset();
  EXPECT_EQ(odometry.getComponents().factors.size(), 1U);
  const Odometry<PointXYZIRT> copy = odometry;
  EXPECT_EQ(copy.getComponents().factors, odometry.getComponents().factors);
}

TEST(OdometryComponents, WhatTheEngineHasNoUseForIsRefused)
{
  if (!isByFeatures()) {
    GTEST_SKIP() << "of the engine 'features'";
  }
  OdometryPipeline odometry(defaults());
  OdometryComponents components;
  components.map = std::make_shared<VoxelPyramid>(1.0);
  EXPECT_THROW(odometry.setComponents(components), std::invalid_argument);
}

TEST(OdometryComponents, AMapOfOnesOwnServesAsTheOdometrysDoes)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  const auto counts = std::make_shared<CountingMap::Counts>();
  OdometryComponents components;
  components.map = std::make_shared<CountingMap>(counts);
  const auto own = reportsOf(components);
  const auto usual = reportsOf({});
  for (int k = 0; k < kFewScans; ++k) {
    EXPECT_TRUE(sameBits(own[k].world_T_sensor, usual[k].world_T_sensor)) << k;
  }
  EXPECT_GT(counts->places, 0);
}

TEST(OdometryComponents, PointsOfOnesOwnChoiceAreRegistered)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  OdometryComponents components;
  std::size_t chosen = 0;
  components.select_points = [&](const std::vector<ScanPoint>& points, std::vector<ScanPoint>& registered) {
    EXPECT_TRUE(registered.empty());
    for (std::size_t i = 0; i < points.size(); i += 3) {
      registered.push_back(points[i]);
    }
    chosen = registered.size();
  };
  const auto reports = reportsOf(components);
  const RegistrationReport& last = reports.back().registration;
  EXPECT_EQ(reports.back().state, TrackingState::tracked);
  EXPECT_GT(chosen, 100U);
  const std::size_t edges = reports.back().edges;
  EXPECT_LE(
      static_cast<std::size_t>(last.edge_correspondences + last.plane_correspondences + last.point_correspondences),
      chosen + edges);
}

/// From anywhere above it: it tells nothing of the way along it.
Cloud endlessFloor()
{
  Cloud cloud;
  for (int ring = 0; ring < 16; ++ring) {
    const float down = static_cast<float>(-0.05 - 0.02 * ring);
    for (int i = 0; i < 600; ++i) {
      const float azimuth = static_cast<float>(2.0 * kPi * i / 600.0);
      const float range = 1.7F / std::sin(-down);
      PointXYZIRT point;
      point.x = range * std::cos(down) * std::cos(azimuth);
      point.y = range * std::cos(down) * std::sin(azimuth);
      point.z = -1.7F;
      point.ring = static_cast<std::uint16_t>(ring);
      point.time = 0.1F * static_cast<float>(i) / 600.0F;
      cloud.push_back(point);
    }
  }
  return cloud;
}

TEST(OdometryComponents, AFactorTellsWhatScansDoNot)
{
  if (isByFeatures()) {
    GTEST_SKIP() << "of the engine 'surfaces'";
  }
  class Place : public PoseFactor {
  public:
    void addTo(const SE3& target_T_source, PoseEquations& equations) const override
    {
      for (int axis = 0; axis < 2; ++axis) {
        Vector6 along = Vector6::Zero();
        along[axis] = 1.0;
        equations.add(target_T_source.translation[axis] - place[axis], along, 1e-4);
      }
    }
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
  };
  const auto factor = std::make_shared<Place>();
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  odometry.setComponents(withFactor(factor));
  constexpr double kStep = 0.4;  // m a scan, along x
  const Cloud floor = endlessFloor();
  for (int k = 0; k < 20; ++k) {
    factor->place.x() = kStep * k;
    const OdometryReport& report = odometry.track(floor);
    if (k > 0) {
      EXPECT_NEAR(report.world_T_sensor.translation.x(), kStep * k, 0.05) << k;
    }
    if (k > 12) {
      EXPECT_EQ(report.state, TrackingState::tracked) << report.reason;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
