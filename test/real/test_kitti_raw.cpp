// Drives of the KITTI raw data set, where they are at hand.
#include <pcl_floam/evaluation/trajectory_metrics.h>
#include <pcl_floam/filters/scan_lines.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>
#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace pcl_floam::test {
namespace {

/// The folder of the environment variable PCL_FLOAM_DATA, else the one beside the sources.
std::filesystem::path dataFolder(const std::string& name)
{
  const char* given = std::getenv("PCL_FLOAM_DATA");
  return std::filesystem::path(given != nullptr ? given : PCL_FLOAM_DATA) / name;
}

#define SKIP_WITHOUT(folder)                                                                         \
  if (!std::filesystem::is_directory(folder)) {                                                      \
    GTEST_SKIP() << folder << " is not there; set PCL_FLOAM_DATA to the folder that holds the data"; \
  }

/// Poses at mid-sweep, with KITTI's vertical angle corrected.
OdometryParameters kittiParameters()
{
  OdometryParameters parameters;
  parameters.vertical_correction = 0.205;
  parameters.pose_instant = PoseInstant::middle;
  return parameters;
}

TEST(KittiRaw, Drive0001HasSixtyFourLinesByFileOrder)
{
  const auto folder = dataFolder("kitti_raw_0001");
  SKIP_WITHOUT(folder);
  const ScanSource source(folder);
  ASSERT_GT(source.size(), 0U);
  pcl::PCLPointCloud2 scan;
  ScanLines lines;
  for (std::size_t k = 0; k < source.size(); ++k) {
    source.read(k, scan);
    findScanLines(viewOf(scan), SensorModel(), ScanLineSource::automatic, lines);
    EXPECT_EQ(lines.source, ScanLineSource::file_order) << "scan " << k;
    EXPECT_EQ(lines.lines(), 64U) << "scan " << k;
    EXPECT_TRUE(lines.kitti_order);
    EXPECT_GT(lines.confidence, 0.95F);
  }
}

TEST(KittiRaw, Drive0001IsAsAccurateAsItsGroundTruth)
{
  const auto folder = dataFolder("kitti_raw_0001");
  SKIP_WITHOUT(folder);
  const ScanSource source(folder);
  std::vector<SE3> truth;
  for (const StampedPose& pose : readTrajectory(folder / "poses.txt", TrajectoryFormat::kitti)) {
    truth.push_back(pose.world_T_sensor);
  }
  ASSERT_EQ(source.size(), truth.size());
  OdometryPipeline odometry(kittiParameters());
  std::vector<SE3> estimate;
  pcl::PCLPointCloud2 scan;
  for (std::size_t k = 0; k < source.size(); ++k) {
    source.read(k, scan);
    odometry.track(viewOf(scan), source.stamp(k));
    EXPECT_EQ(odometry.report().state, k == 0 ? TrackingState::initialized : TrackingState::tracked) << "scan " << k;
    estimate.push_back(odometry.pose());
  }
  EXPECT_LE(absoluteTrajectoryError(estimate, truth).rms, 0.06);
  EXPECT_LE(fittingKittiMetric(estimate, truth).translation, 0.45);
}

TEST(KittiRaw, Drive0048IsTrackedSmoothly)
{
  const auto folder = dataFolder("kitti_raw_0048_pcd");
  SKIP_WITHOUT(folder);
  const ScanSource source(folder);
  ASSERT_EQ(source.size(), 22U);
  OdometryPipeline odometry(kittiParameters());
  std::vector<SE3> poses;
  pcl::PCLPointCloud2 scan;
  for (std::size_t k = 0; k < source.size(); ++k) {
    source.read(k, scan);
    odometry.track(viewOf(scan), source.stamp(k));
    EXPECT_EQ(odometry.report().state, k == 0 ? TrackingState::initialized : TrackingState::tracked) << "scan " << k;
    poses.push_back(odometry.pose());
  }
  EXPECT_GT(pathLength(poses), 5.0);
  for (std::size_t k = 2; k < poses.size(); ++k) {
    const SE3 before = poses[k - 2].inverse() * poses[k - 1];
    const SE3 after = poses[k - 1].inverse() * poses[k];
    EXPECT_LT((after.translation - before.translation).norm(), 0.3) << "scan " << k;
    EXPECT_LT(rotationAngle(before.rotation.transpose() * after.rotation), 0.03) << "scan " << k;
  }
}

}  // namespace
}  // namespace pcl_floam::test
