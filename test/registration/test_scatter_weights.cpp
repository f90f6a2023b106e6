// Planes weighed by how well the map's points lie on them.
#include "registration/correspondences.h"

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

/// Planes of given variances, all linked, with weight 2.
std::vector<Correspondence> planesOf(const std::vector<double>& variances)
{
  std::vector<Correspondence> planes(variances.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    planes[i].factor.variance = variances[i];
    planes[i].weight = 2.0;
  }
  return planes;
}

const std::vector<double> kTwos(5, 2.0);
constexpr double kSquared = kPlaneScatter * kPlaneScatter;

TEST(ScatterWeights, SoManyTimesTheUsualScatterCountsHalf)
{
  const double half = kSquared * 1e-4;
  auto planes = planesOf({1e-4, 1e-4, 0.0, half, 1.0});  // their median is (1 cm)^2
  weighByScatter(kTwos, planes);
  EXPECT_DOUBLE_EQ(planes[2].weight, 2.0);
  EXPECT_DOUBLE_EQ(planes[3].weight, 1.0);
  EXPECT_NEAR(planes[4].weight, 2.0 * half, 1e-5);
  EXPECT_DOUBLE_EQ(planes[0].weight, 2.0 * kSquared / (kSquared + 1.0));
}

TEST(ScatterWeights, DependOnProportionsOnly)
{
  auto planes = planesOf({1e-4, 2e-4, 3e-4, 4e-4, 5e-4});
  auto larger = planesOf({1e-2, 2e-2, 3e-2, 4e-2, 5e-2});
  weighByScatter(kTwos, planes);
  weighByScatter(kTwos, larger);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_NEAR(planes[i].weight, larger[i].weight, 1e-12);
  }
}

TEST(ScatterWeights, AreTheSameWhenTakenTwice)
{
  auto planes = planesOf({1e-4, 2e-4, 3e-4, 4e-4, 5e-4});
  weighByScatter(kTwos, planes);
  auto again = planes;
  weighByScatter(kTwos, again);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_DOUBLE_EQ(planes[i].weight, again[i].weight);
  }
}

TEST(ScatterWeights, AMillimetreIsNoScatter)
{
  auto planes = planesOf({0.0, 1e-17, 1e-17, 1e-6, 1.0});  // a map without noise, but for rounding
  weighByScatter(kTwos, planes);
  EXPECT_NEAR(planes[0].weight, 2.0, 1e-9);
  EXPECT_GT(planes[3].weight, 1.5);
  EXPECT_LT(planes[4].weight, 1e-4);
}

TEST(ScatterWeights, WhatIsNotLinkedStaysOutAndHasNoSay)
{
  auto planes = planesOf({1e-4, 1e-4, 1e-4, 1.0, 1.0});
  planes[3].weight = planes[4].weight = 0.0;
  weighByScatter(kTwos, planes);
  EXPECT_DOUBLE_EQ(planes[0].weight, 2.0 * kSquared / (kSquared + 1.0));
  EXPECT_DOUBLE_EQ(planes[3].weight, 0.0);
}

}  // namespace
}  // namespace pcl_floam::test
