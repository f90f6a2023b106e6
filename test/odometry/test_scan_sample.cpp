// The points of a scan by which the map is told what has gone.
#include "odometry/scan_sample.h"

#include <pcl_floam/common/point_types.h>
#include <pcl_floam/map/keyframe_voxel_map.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;

struct Pole {
  float range;
  float radius;
};

constexpr float kAzimuth = 0.3F;  // of the pole
constexpr float kWall = 60.0F;

/// A pole before a wall around the sensor.
Cloud scanOf(const Pole& pole, int lines, int columns)
{
  Cloud cloud;
  for (int column = 0; column < columns; ++column) {
    const float fraction = static_cast<float>(column) / static_cast<float>(columns - 1);
    const float azimuth = 3.14159F * (1.0F - 2.0F * fraction);
    const float range = std::abs(azimuth - kAzimuth) < pole.radius / pole.range ? pole.range : kWall;
    for (int line = 0; line < lines; ++line) {
      const float slope = -0.2F + 0.4F * static_cast<float>(line) / static_cast<float>(lines);
      cloud.push_back(PointXYZIRT(range * std::cos(azimuth), range * std::sin(azimuth), range * slope, 1.0F,
                                  static_cast<std::uint16_t>(line), 0.1F * fraction));
    }
  }
  return cloud;
}

std::vector<Eigen::Vector3f> sampleOf(const Cloud& cloud, double correction = 0.0,
                                      const SweepMotion& motion = SweepMotion())
{
  ScanLines lines;
  findScanLines(viewOf(cloud), {}, ScanLineSource::ring_field, lines);
  return undistortedSample(viewOf(cloud), lines, findScanTiming(viewOf(cloud), lines), {}, correction, motion);
}

TEST(ScanSample, HoldsWhatIsThin)
{
  const Cloud cloud = scanOf({20.0F, 0.05F}, 64, 1800);
  std::set<float> slopes;
  for (const Eigen::Vector3f& point : sampleOf(cloud)) {
    if (point.head<2>().norm() < 30.0F) {
      slopes.insert(std::round(1e4F * point.z() / point.head<2>().norm()));
    }
  }
  EXPECT_EQ(slopes.size(), 64U);
  EXPECT_LT(sampleOf(cloud).size(), 13000U);
}

TEST(ScanSample, OfTheVeryScanThatMadeTheMapSeesThroughNoneOfIt)
{
  for (const int lines : {16, 64, 128}) {
    for (const Pole& pole : {Pole{8.0F, 0.1F}, Pole{15.0F, 0.05F}, Pole{25.0F, 0.05F}, Pole{35.0F, 0.1F}}) {
      const Cloud cloud = scanOf(pole, lines, 1800);
      FeatureSet features;
      for (const PointXYZIRT& point : cloud) {
        if (std::hypot(point.x, point.y) < 50.0F) {
          Feature feature;
          feature.x = point.x;
          feature.y = point.y;
          feature.z = point.z;
          features.edges.push_back(feature);
        }
      }
      KeyframeVoxelMap map;
      map.insert(features, SE3());
      const std::size_t before = map.size(FeatureKind::edge);
      ASSERT_GT(before, 5U);
      map.forgetSeenThrough(sampleOf(cloud), SE3());
      EXPECT_EQ(map.size(FeatureKind::edge), before) << lines << " lines, pole at " << pole.range;
    }
  }
}

TEST(ScanSample, IsCorrectedAndUndistorted)
{
  const Cloud cloud = scanOf({20.0F, 1.0F}, 16, 100);  // few enough to be taken one and all
  const SweepMotion motion((Vector6() << 2.0, 0.3, 0.1, 0.05, 0.02, 0.4).finished(), 0.5);
  const double correction = 2.0;
  const auto points = sampleOf(cloud, correction, motion);
  ASSERT_EQ(points.size(), cloud.size());
  std::size_t n = 0;
  for (std::size_t line = 0; line < 16; ++line) {
    for (std::size_t column = 0; column < 100; ++column, ++n) {
      const Eigen::Vector3d measured = cloud[16 * column + line].getVector3fMap().cast<double>();
      const double across = measured.head<2>().norm();
      const double elevation = std::atan2(measured.z(), across) + correction * 3.14159265 / 180.0;
      const double range = measured.norm();
      const double scale = range * std::cos(elevation) / across;
      const Eigen::Vector3d raised(scale * measured.x(), scale * measured.y(), range * std::sin(elevation));
      const double time = static_cast<double>(column) / 99.0;
      ASSERT_LT((motion.at(time) * raised - points[n].cast<double>()).norm(), 1e-3) << line << ' ' << column;
    }
  }
}

TEST(ScanSample, LeavesOutWhatIsOutOfRange)
{
  Cloud cloud = scanOf({20.0F, 1.0F}, 16, 100);
  cloud[3].getVector3fMap() *= 0.001F;  // the robot itself
  cloud[40].getVector3fMap() *= 3.0F;
  EXPECT_EQ(sampleOf(cloud).size(), cloud.size() - 2);
  EXPECT_TRUE(undistortedSample(viewOf(cloud), {}, {}, {}, 0.0, SweepMotion()).empty());
}

}  // namespace
}  // namespace pcl_floam::test
