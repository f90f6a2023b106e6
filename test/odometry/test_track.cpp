// The surface engine's odometry on real drives; skipped, and saying so, where they are not there.
#include "odometry/track.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>
#include <pcl_floam/filters/sensor_model.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace pcl_floam {
namespace {

std::filesystem::path dataFolder(const std::string& name)
{
  const char* given = std::getenv("PCL_FLOAM_DATA");
  return std::filesystem::path(given != nullptr ? given : PCL_FLOAM_DEFAULT_DATA) / name;
}

std::vector<SE3> trackAll(const std::filesystem::path& folder, std::size_t most, int threads)
{
  const ScanSource scans(folder);
  Track track(threads);
  std::vector<SE3> poses;
  pcl::PCLPointCloud2 scan;
  ScanLines lines;
  std::vector<ScanPoint> points;
  for (std::size_t i = 0; i < std::min(scans.size(), most); ++i) {
    scans.read(i, scan);
    const CloudView view = viewOf(scan);
    findScanLines(view, SensorModel(), ScanLineSource::automatic, lines);
    const ScanTiming timing = findScanTiming(view, lines);
    collectPoints(view, lines, timing, 0.5, 120.0, points);
    const RegistrationReport report = track.step({&points, 1.0, timing.valid() ? 1.0 : 0.0});
    EXPECT_TRUE(i == 0 || report.hasConverged()) << "scan " << i;
    poses.push_back(track.pose());
  }
  return poses;
}

}  // namespace

TEST(Track, FollowsARealCar)
{
  const std::filesystem::path folder = dataFolder("kitti_raw_0001");
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "SKIPPED: no real data at " << folder;
  }
  const std::vector<SE3> poses = trackAll(folder / "velodyne", 60, 1);
  std::vector<SE3> truth;
  for (const StampedPose& pose : readTrajectory(folder / "poses.txt")) {
    truth.push_back(pose.world_T_sensor);
  }
  truth.resize(poses.size());
  // The floor of the truth is 0.055 m; the sensor's vertical angle is left as it is.
  EXPECT_LT(absoluteTrajectoryError(poses, truth).rms, 0.15);
}

TEST(Track, ARealSensorAtRestStaysThere)
{
  const std::filesystem::path folder = dataFolder("vlp16_static");
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "SKIPPED: no real data at " << folder;
  }
  for (const SE3& pose : trackAll(folder / "pcd", 80, 1)) {
    EXPECT_LT(pose.translation.norm(), 0.02);
  }
}

TEST(Track, ThreadsGiveTheSameBits)
{
  const std::filesystem::path folder = dataFolder("kitti_raw_0001");
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "SKIPPED: no real data at " << folder;
  }
  const std::vector<SE3> one = trackAll(folder / "velodyne", 6, 1);
  const std::vector<SE3> three = trackAll(folder / "velodyne", 6, 3);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].translation, three[i].translation);
    EXPECT_EQ(one[i].rotation, three[i].rotation);
  }
}

TEST(Track, AnEmptySweepIsToldAndChangesNothing)
{
  Track track;
  const std::vector<ScanPoint> nothing;
  EXPECT_EQ(track.step({&nothing, 1.0, 1.0}).termination, Termination::too_few_features);
  EXPECT_EQ(track.map(), nullptr);
}

}  // namespace pcl_floam
