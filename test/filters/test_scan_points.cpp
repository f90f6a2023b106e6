// A scan's returns as registration and map take them.
#include "filters/spatial_sampling.h"
#include "support/listed_returns.h"

#include <gtest/gtest.h>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <map>
#include <random>
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
  const std::vector<ScanPoint> points = test::listed({view, none, unknown, 0.1, 200.0, 0.0});
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

/// By the whole scan, though no more of it is looked at than it takes to tell.
TEST(SpatialSampling, FillsAsManyCubesAsAreWanted)
{
  constexpr double kPerRoot = 12.0;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> within(-20.0F, 20.0F);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  while (cloud.size() < 5000) {
    cloud.emplace_back(within(random), within(random), within(random));
  }
  const CloudView view = viewOf(cloud);
  const ScanLines none;
  const ScanTiming unknown;
  const ScanReturns returns{view, none, unknown, 0.1, 200.0, 0.0};
  const double count = static_cast<double>(test::listed(returns).size());
  SpatialSampling sampling;
  const double side = sampling.sideFor(returns, kPerRoot);
  const auto filled = [&](double of_side) {
    std::vector<ScanPoint> firsts;
    sampling.sample(returns, of_side, firsts);
    return static_cast<double>(firsts.size());
  };
  EXPECT_NEAR(filled(side), kPerRoot * std::sqrt(count), 0.02 * filled(side));
  EXPECT_GT(filled(0.9 * side), kPerRoot * std::sqrt(count));
  EXPECT_LT(filled(1.1 * side), kPerRoot * std::sqrt(count));
}

}  // namespace pcl_floam
