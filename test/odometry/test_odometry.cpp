// The odometry on sweeps that a moving lidar takes of a furnished room.
#include "support/moving_room.h"
#include "support/random_motion.h"

#include <pcl_floam/common/core/thread_count.h>
#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace pcl_floam::test {
namespace {

TEST(Odometry, RecoversASteadyMotionFromItsFirstScan)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    const OdometryReport& report = odometry.track(sweep(steadyPath, k));
    EXPECT_EQ(report.state, k == 0 ? TrackingState::initialized : TrackingState::tracked) << report.reason;
    EXPECT_LT(error(report.world_T_sensor, steadyPath, k), 0.03) << "scan " << k;
    EXPECT_LT(angleError(report.world_T_sensor, steadyPath, k), 0.003) << "scan " << k;
    EXPECT_EQ(report.scan_lines, 32U);
    EXPECT_EQ(report.timing_source, ScanTimingSource::time_field);
  }
}

TEST(Odometry, RecoversAnAcceleratedMotion)
{
  // The paper's two stages undistort a sweep with the velocity of the last one, and lag behind an acceleration.
  const std::array<std::pair<CompensationMode, double>, 3> limits = {
      {{CompensationMode::two_stage, 0.07}, {CompensationMode::iterative, 0.03}, {CompensationMode::continuous, 0.03}}};
  for (const auto& [mode, limit] : limits) {
    OdometryParameters parameters = defaults();
    parameters.compensation = mode;
    Odometry<PointXYZIRT> odometry(parameters);
    for (int k = 0; k < kScans; ++k) {
      odometry.track(sweep(acceleratedPath, k));
      EXPECT_LT(error(odometry.getPose(), acceleratedPath, k), limit) << toString(mode) << ", scan " << k;
      EXPECT_LT(angleError(odometry.getPose(), acceleratedPath, k), 0.006) << toString(mode) << ", scan " << k;
    }
  }
}

/// A pose is registered at the middle of its sweep: what is given of its ends is known as well as the velocity is.
TEST(Odometry, TheEndsOfASweepAreLessSureThanItsMiddle)
{
  std::array<double, 3> variance{};
  for (const PoseInstant instant : {PoseInstant::start, PoseInstant::middle, PoseInstant::end}) {
    OdometryParameters parameters = defaults();
    parameters.pose_instant = instant;
    Odometry<PointXYZIRT> odometry(parameters);
    for (int k = 0; k < kScans; ++k) {
      odometry.track(sweep(acceleratedPath, k));
    }
    const Matrix6& covariance = odometry.report().covariance;
    EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12 * covariance.norm());
    variance[static_cast<std::size_t>(instant)] = covariance.trace();
  }
  EXPECT_GT(variance[static_cast<std::size_t>(PoseInstant::start)],
            1.01 * variance[static_cast<std::size_t>(PoseInstant::middle)]);
  EXPECT_GT(variance[static_cast<std::size_t>(PoseInstant::end)],
            1.01 * variance[static_cast<std::size_t>(PoseInstant::middle)]);
}

template <typename Poses>
Eigen::Vector3d meanOf(Poses begin, Poses end)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::for_each(begin, end, [&sum](const SE3& pose) { sum += pose.translation; });
  return sum / static_cast<double>(end - begin);
}

TEST(Odometry, StandsStillWhereTheSensorDoes)
{
  constexpr int kStops = 6;
  constexpr int kStarts = 45;
  const Path path = [](double t) {
    constexpr double kSlow = 0.2;
    return steadyPath(kSlow * (t < kStops ? t : std::max(double{kStops}, t + kStops - kStarts)));
  };
  Odometry<PointXYZIRT> odometry(defaults());
  std::vector<SE3> poses;
  for (int k = 0; k < kStarts + 4; ++k) {
    Cloud noisy = sweep(path, k);
    std::mt19937 random(static_cast<std::uint32_t>(k));
    for (PointXYZIRT& point : noisy) {
      point.getVector3fMap() *= 1.0F + static_cast<float>(uniform(random, 0.002));
    }
    const OdometryReport& report = odometry.track(noisy);
    ASSERT_LE(report.corrected_poses.size(), poses.size());
    std::copy(report.corrected_poses.begin(), report.corrected_poses.end(),
              poses.end() - static_cast<std::ptrdiff_t>(report.corrected_poses.size()));
    poses.push_back(report.world_T_sensor);
    EXPECT_LT(error(poses.back(), path, k), 0.05) << k;
    EXPECT_FALSE(report.at_rest && (k < kStops || k > kStarts)) << k;
    EXPECT_TRUE(report.at_rest || k != kStarts - 1);
  }
  // Among noise no pose is far from their mean, and that does not creep.
  const auto first = poses.begin() + kStops + 2;
  const auto middle = first + (poses.begin() + kStarts - first) / 2;
  const auto end = poses.begin() + kStarts;
  const Eigen::Vector3d mean = meanOf(first, end);
  double most = 0.0;
  std::for_each(first, end, [&](const SE3& pose) { most = std::max(most, (pose.translation - mean).norm()); });
  EXPECT_LT(most, 0.004);
  EXPECT_LT((meanOf(middle, end) - meanOf(first, middle)).norm(), 0.0015);
}

TEST(Odometry, CompensationIsWorthIt)
{
  double worst[2] = {0.0, 0.0};
  for (const CompensationMode mode : {CompensationMode::none, CompensationMode::two_stage}) {
    OdometryParameters parameters = defaults();
    parameters.compensation = mode;
    Odometry<PointXYZIRT> odometry(parameters);
    for (int k = 0; k < kScans; ++k) {
      odometry.track(sweep(steadyPath, k));
      double& largest = worst[mode == CompensationMode::none ? 0 : 1];
      largest = std::max(largest, error(odometry.getPose(), steadyPath, k));
    }
  }
  EXPECT_GT(worst[0], 2.0 * worst[1]);
}

TEST(Odometry, PosesAreThoseOfTheNamedInstant)
{
  for (const PoseInstant instant : {PoseInstant::start, PoseInstant::middle, PoseInstant::end}) {
    OdometryParameters parameters = defaults();
    parameters.pose_instant = instant;
    Odometry<PointXYZIRT> odometry(parameters);
    for (int k = 0; k < kScans; ++k) {
      odometry.track(sweep(acceleratedPath, k));
      EXPECT_LT(error(odometry.getPose(), acceleratedPath, k, fractionOf(instant)), 0.05)
          << toString(instant) << ", scan " << k;
      EXPECT_NEAR(odometry.report().since_stamp, 0.1 * fractionOf(instant), 1e-3);
    }
    // The path is fast enough to tell the instants apart.
    EXPECT_GT(error(odometry.getPose(), acceleratedPath, kScans - 1, 1.0 - fractionOf(instant)),
              instant == PoseInstant::middle ? -1.0 : 0.2);
  }
}

TEST(Odometry, ItsMapHasTheScansIntensities)
{
  Odometry<PointXYZIRT> odometry(defaults());
  for (int k = 0; k < kScans; ++k) {
    Cloud scan = sweep(steadyPath, k);
    for (PointXYZIRT& point : scan) {
      point.intensity = 42.0F;
    }
    odometry.track(scan);
  }
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    const std::vector<float> intensities = odometry.map().intensities(kind);
    EXPECT_EQ(intensities, std::vector<float>(odometry.map().size(kind), 42.0F));
    EXPECT_FALSE(intensities.empty());
  }
}

TEST(Odometry, ResetStartsAnewAtAPose)
{
  Odometry<PointXYZIRT> odometry(defaults());
  Odometry<PointXYZIRT> fresh(defaults());
  for (int k = 0; k < 5; ++k) {
    odometry.track(sweep(acceleratedPath, k));
  }
  const SE3 initial = exp((Vector6() << 100.0, -50.0, 2.0, 0.1, 0.2, 1.0).finished());
  odometry.reset(initial);
  EXPECT_TRUE(sameBits(odometry.getPose(), initial));
  EXPECT_TRUE(odometry.map().empty());
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(odometry.track(sweep(steadyPath, k)).state, k == 0 ? TrackingState::initialized : TrackingState::tracked);
    EXPECT_LT(error(initial.inverse() * odometry.getPose(), steadyPath, k), 0.03);
  }
}

/// In UTM coordinates, say: the same drive at the map's origin and a thousand kilometres from it. Both begin with the
/// same heading and at a corner of a voxel; with other voxels the map keeps other points, and poses differ by 0.5 mm.
TEST(Odometry, IsAsPreciseFarFromTheOrigin)
{
  const Eigen::Matrix3d heading = expSO3(Eigen::Vector3d(0.0, 0.0, 0.7));
  const SE3 at_origin(heading, Eigen::Vector3d::Zero());
  const SE3 far_away(heading, Eigen::Vector3d(1e6, -1e6, 100.0));
  Odometry<PointXYZIRT> near(defaults());
  Odometry<PointXYZIRT> far(defaults());
  near.reset(at_origin);
  far.reset(far_away);
  for (int k = 0; k < kScans; ++k) {
    const Cloud scan = sweep(acceleratedPath, k);
    near.track(scan);
    ASSERT_TRUE(far.track(scan).state == TrackingState::tracked || k == 0) << "scan " << k;
    const Eigen::Vector3d difference = far.getPose().translation - far_away.translation - near.getPose().translation;
    EXPECT_LT(difference.norm(), 1e-5) << "scan " << k;
    EXPECT_LT(rotationAngle(near.getPose().rotation.transpose() * far.getPose().rotation), 1e-6) << "scan " << k;
  }
}

TEST(Odometry, ASensorAtRestStaysAtRest)
{
  Odometry<PointXYZIRT> odometry(defaults());
  const Cloud scan = sweep([](double) { return SE3(); }, 0);
  for (int k = 0; k < 5; ++k) {
    odometry.track(scan);
    EXPECT_EQ(odometry.report().engine, defaults().engine);
    EXPECT_LT(odometry.getPose().translation.norm(), 0.01);
    EXPECT_LT(rotationAngle(odometry.getPose().rotation), 1e-3);
    EXPECT_EQ(odometry.report().keyframe, k == 0);
  }
}

TEST(Odometry, NoThreadsAreAllProcessors)
{
  OdometryParameters parameters = defaults();
  parameters.threads = 0;
  EXPECT_EQ(OdometryPipeline(parameters).getParameters().threads, threadCount(0));
}

TEST(Odometry, SettingsOutOfRangeAreRefused)
{
  OdometryParameters parameters = defaults();
  parameters.threads = -1;
  EXPECT_THROW(OdometryPipeline{parameters}, std::invalid_argument);
  parameters = defaults();
  parameters.map.horizon = -1.0;
  EXPECT_THROW(OdometryPipeline{parameters}, std::invalid_argument);
  parameters = defaults();
  parameters.keyframe.translation = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(OdometryPipeline{parameters}, std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam::test
