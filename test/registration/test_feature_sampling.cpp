// Which features are registered.
#include "registration/feature_sampling.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace pcl_floam::test {
namespace {

std::vector<Feature> randomFeatures(std::size_t count, double extent)
{
  std::mt19937 random(3);
  std::vector<Feature> features(count);
  for (Feature& f : features) {
    f.x = static_cast<float>(uniform(random, extent));
    f.y = static_cast<float>(uniform(random, extent));
    f.z = static_cast<float>(uniform(random, 0.1 * extent));
  }
  return features;
}

TEST(FeatureSampling, EvenlyTakesAllOrAsManyAsAskedFor)
{
  const std::vector<Feature> features = randomFeatures(1000, 10.0);
  EXPECT_EQ(evenly(features, 2000).size(), 1000U);
  EXPECT_EQ(evenly(features, 300).size(), 300U);
  EXPECT_EQ(evenly(features, 1).front().x, features.front().x);
  EXPECT_EQ(evenly(features, 500).back().x, features[998].x);
  EXPECT_TRUE(evenly({}, 10).empty());
}

TEST(FeatureSampling, ACrowdedCellIsThinnedAndAPoorOneIsNot)
{
  const std::vector<Feature> features = randomFeatures(3000, 20.0);
  const auto cellOf = [](const Feature& f) {
    return std::array<int, 3>{static_cast<int>(std::floor(f.x / 2.0F)), static_cast<int>(std::floor(f.y / 2.0F)),
                              static_cast<int>(std::floor(f.z / 2.0F))};
  };
  std::map<std::array<int, 3>, int> expected;
  for (const Feature& f : features) {
    expected[cellOf(f)] = std::min(3, expected[cellOf(f)] + 1);
  }
  std::map<std::array<int, 3>, int> taken;
  for (const Feature& f : atMostPerCell(features, 2.0F, 3)) {
    ++taken[cellOf(f)];
  }
  EXPECT_EQ(taken, expected);
}

TEST(FeatureSampling, AnyCoordinateHasACell)
{
  std::vector<Feature> features(4);
  features[0].x = 1e30F;
  features[1].x = -1e30F;
  features[2].x = std::numeric_limits<float>::max();  // together with the first
  EXPECT_EQ(atMostPerCell(features, 2.0F, 1).size(), 3U);
  features[3].x = std::numeric_limits<float>::quiet_NaN();  // together with the second
  EXPECT_EQ(atMostPerCell(features, 2.0F, 1).size(), 2U);
}

}  // namespace
}  // namespace pcl_floam::test
