// Real drives, which are not part of the repository: skipped, and saying so, where they are not there.
#include "real/real_data.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>
#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace pcl_floam::test {
namespace {

std::vector<SE3> trackAll(const ScanSource& scans, OdometryPipeline& odometry)
{
  constexpr std::size_t kTold = 20;  // by so many scans it has to be told how the sensor moves
  std::vector<SE3> poses;
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const OdometryReport& report = odometry.track(viewOf(scan), scans.stamp(i));
    if (i == 0 || i >= kTold || report.state != TrackingState::doubtful) {
      EXPECT_EQ(report.state, i == 0 ? TrackingState::initialized : TrackingState::tracked) << report.reason;
    }
    EXPECT_EQ(report.scan_line_source, ScanLineSource::file_order) << "scan " << i;
    EXPECT_GE(report.scan_lines, 64U) << "scan " << i;
    std::copy(report.corrected_poses.begin(), report.corrected_poses.end(),
              poses.end() - static_cast<std::ptrdiff_t>(report.corrected_poses.size()));
    poses.push_back(report.world_T_sensor);
  }
  return poses;
}

std::vector<SE3> truePoses(const std::filesystem::path& file)
{
  std::vector<SE3> poses;
  for (const StampedPose& pose : readTrajectory(file)) {
    poses.push_back(pose.world_T_sensor);
  }
  return poses;
}

TEST(KittiRaw0001, TrajectoryAgreesWithGroundTruth)
{
  const std::filesystem::path folder = dataFolder("kitti_raw_0001");
  SKIP_WITHOUT(folder);
  OdometryParameters parameters;
  parameters.vertical_correction = 0.205;
  parameters.pose_instant = PoseInstant::middle;  // as the ground truth
  OdometryPipeline odometry(parameters);
  const std::vector<SE3> poses = trackAll(ScanSource(folder / "velodyne"), odometry);
  const std::vector<SE3> truth = truePoses(folder / "poses.txt");

  ASSERT_EQ(poses.size(), truth.size());
  EXPECT_LT(absoluteTrajectoryError(poses, truth).rms, 0.06);
  EXPECT_LT(kittiMetric(poses, truth, lengthsFor(pathLength(truth)), 1).translation, 0.45);
  EXPECT_LT(kittiMetric(poses, truth, {100.0}, 1).translation, 0.45);
  EXPECT_EQ(odometry.report().timing_source, ScanTimingSource::clockwise);
}

/// KITTI's odometry benchmark undistorted its scans, and nothing in its files says so.
TEST(KittiOdometry01, TheScansAreFoundToBeCompensated)
{
  const std::filesystem::path folder = dataFolder("kitti_odom_01_ramp");
  SKIP_WITHOUT(folder);
  const auto pathWith = [&](CompensationMode mode) {
    OdometryParameters parameters;
    parameters.compensation = mode;
    OdometryPipeline odometry(parameters);
    std::vector<SE3> path = trackAll(ScanSource(folder / "velodyne"), odometry);
    EXPECT_EQ(odometry.report().timing_source == ScanTimingSource::none, mode != CompensationMode::none);
    return path;
  };
  const std::vector<SE3> told = pathWith(CompensationMode::none);
  const std::vector<SE3> found = pathWith(OdometryParameters().compensation);
  ASSERT_EQ(found.size(), told.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT((found[i].translation - told[i].translation).norm(), 0.05) << i;
  }
}

TEST(KittiRaw0001, CompensationPays)
{
  const std::filesystem::path folder = dataFolder("kitti_raw_0001");
  SKIP_WITHOUT(folder);
  const std::vector<SE3> truth = truePoses(folder / "poses.txt");
  const auto errorWith = [&](CompensationMode mode) {
    OdometryParameters parameters;
    parameters.vertical_correction = 0.205;
    parameters.pose_instant = PoseInstant::middle;
    parameters.compensation = mode;
    OdometryPipeline odometry(parameters);
    // By parts of the way: over all of it the truth is off by as much.
    return fittingKittiMetric(trackAll(ScanSource(folder / "velodyne"), odometry), truth).translation;
  };
  const double without = errorWith(CompensationMode::none);
  EXPECT_LT(errorWith(CompensationMode::two_stage), without);
  EXPECT_LT(errorWith(CompensationMode::iterative), without);
}

TEST(KittiRaw0001, TheDriveIsFoundToStartInMotionWithoutEdges)
{
  const std::filesystem::path folder = dataFolder("kitti_raw_0001");
  SKIP_WITHOUT(folder);
  OdometryParameters parameters;
  parameters.vertical_correction = 0.205;
  parameters.pose_instant = PoseInstant::middle;
  parameters.features.edges_per_sector = 0;
  OdometryPipeline odometry(parameters);
  const std::vector<SE3> poses = trackAll(ScanSource(folder / "velodyne"), odometry);
  EXPECT_LT(absoluteTrajectoryError(poses, truePoses(folder / "poses.txt")).rms, 0.15);
}

TEST(KittiRaw0048, PcdSequenceIsTrackedSmoothly)
{
  const std::filesystem::path folder = dataFolder("kitti_raw_0048_pcd");
  SKIP_WITHOUT(folder);
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  OdometryPipeline odometry(parameters);
  const std::vector<SE3> poses = trackAll(ScanSource(folder), odometry);

  ASSERT_EQ(poses.size(), 22U);
  for (std::size_t i = 2; i < poses.size(); ++i) {
    const SE3 before = poses[i - 2].inverse() * poses[i - 1];
    const SE3 after = poses[i - 1].inverse() * poses[i];
    // At 10 Hz 5 m/s^2 change the step by 5 cm; the rest is left for the estimate's own noise.
    EXPECT_LT((after.translation - before.translation).norm(), 0.1) << "scan " << i;
    // A car that drives over a kerb nods by about a degree.
    EXPECT_LT(rotationAngle(before.rotation.transpose() * after.rotation), 0.02) << "scan " << i;
  }
}

}  // namespace
}  // namespace pcl_floam::test
