// A real lidar that stands still: skipped, and saying so, where its scans are not there.
#include "real/real_data.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace pcl_floam::test {
namespace {

TEST(Vlp16AtRest, StaysWhereItIs)
{
  const std::filesystem::path folder = dataFolder("vlp16_static");
  SKIP_WITHOUT(folder);
  const ScanSource scans(folder / "pcd");
  OdometryPipeline odometry;
  std::vector<SE3> poses;
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const OdometryReport& report = odometry.track(viewOf(scan), scans.stamp(i));
    std::copy(report.corrected_poses.begin(), report.corrected_poses.end(),
              poses.end() - static_cast<std::ptrdiff_t>(report.corrected_poses.size()));
    poses.push_back(report.world_T_sensor);
  }
  EXPECT_TRUE(odometry.report().at_rest);
  const RestMetric metric = restMetric(poses);
  EXPECT_LT(metric.wander, 0.005);
  EXPECT_LT(metric.jitter.translation.rms, 0.001);
}

}  // namespace
}  // namespace pcl_floam::test
