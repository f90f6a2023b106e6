// A scan's returns as registration and map take them.
#include "filters/spatial_sampling.h"

#include <gtest/gtest.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <map>
#include <vector>

namespace pcl_floam {

/// A pattern's next pass over a place is another curve there, as that of another laser; what one pass drew is one.
TEST(ScanPoints, WithoutScanLinesPartsOfTheSweepAreTheLasers)
{
  constexpr std::size_t kPoints = 6400;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (std::size_t i = 0; i < kPoints; ++i) {
    cloud.emplace_back(5.0F + 0.001F * static_cast<float>(i), 1.0F, 0.0F);
  }
  const CloudView view = viewOf(cloud);
  const ScanLines none;
  const ScanTiming unknown;
  std::vector<ScanPoint> points;
  constexpr double kEach = 5e-4;  // m: no two are so near each other
  SpatialSampling().sample({view, none, unknown, 0.1, 200.0, 0.0}, kEach, points);
  ASSERT_EQ(points.size(), kPoints);
  std::map<std::uint32_t, std::size_t> curves;
  for (std::size_t i = 0; i < kPoints; ++i) {
    ++curves[points[i].laser];
    EXPECT_TRUE(i == 0 || points[i].laser >= points[i - 1].laser) << i;
  }
  EXPECT_EQ(curves.size(), 64U);
  for (const auto& curve : curves) {
    EXPECT_EQ(curve.second, kPoints / 64) << curve.first;
  }
}

}  // namespace pcl_floam
