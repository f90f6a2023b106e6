// The correction of a sensor's vertical angles.
#include "filters/vertical_correction.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_floam::test {
namespace {

double elevationOf(const Feature& f)
{
  return std::atan2(f.z, std::hypot(f.x, f.y)) * 180.0 / M_PI;
}

TEST(VerticalCorrection, RaisesElevationsAndChangesNothingElse)
{
  std::mt19937 random(8);
  FeatureSet before;
  for (int i = 0; i < 100; ++i) {
    Feature feature;
    feature.x = static_cast<float>(uniform(random, 40.0));
    feature.y = static_cast<float>(uniform(random, 40.0));
    feature.z = static_cast<float>(uniform(random, 3.0));
    (i % 2 == 0 ? before.edges : before.planes).push_back(feature);
  }
  for (const double degrees : {0.205, -3.0}) {
    FeatureSet after = before;
    correctVerticalAngle(degrees, after);
    for (const auto& [was, is] : {std::pair(&before.edges, &after.edges), std::pair(&before.planes, &after.planes)}) {
      ASSERT_EQ(is->size(), was->size());
      for (std::size_t i = 0; i < was->size(); ++i) {
        const Feature& a = (*was)[i];
        const Feature& b = (*is)[i];
        EXPECT_NEAR(elevationOf(b) - elevationOf(a), degrees, 1e-4);
        EXPECT_NEAR(std::hypot(b.x, b.y, b.z), std::hypot(a.x, a.y, a.z), 1e-4);
        EXPECT_NEAR(std::atan2(b.y, b.x), std::atan2(a.y, a.x), 1e-5);
      }
    }
  }
}

TEST(VerticalCorrection, NothingIsDoneByDefaultNorStraightAbove)
{
  FeatureSet features;
  features.edges.push_back({0.0F, 0.0F, 5.0F});
  features.planes.push_back({3.0F, 4.0F, 1.0F});
  const FeatureSet before = features;
  correctVerticalAngle(0.0, features);
  EXPECT_EQ(features.planes[0].z, before.planes[0].z);
  correctVerticalAngle(1.0, features);
  EXPECT_EQ(features.edges[0].z, 5.0F);
}

}  // namespace
}  // namespace pcl_floam::test
