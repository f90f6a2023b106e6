// The correction of a sensor's vertical angles.
#include "support/constants.h"
#include "support/random_motion.h"

#include <pcl_floam/filters/vertical_correction.h>

#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_floam::test {
namespace {

double elevationOf(const Feature& f)
{
  return std::atan2(f.z, std::hypot(f.x, f.y)) * 180.0 / kPi;
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

TEST(VerticalCorrection, AsAFilterItKeepsOrderFieldsAndWhatIsNotFinite)
{
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZINormal>>();
  for (const float x : {10.0F, std::numeric_limits<float>::quiet_NaN(), 4.0F}) {
    pcl::PointXYZINormal point;
    point.x = x;
    point.y = 3.0F;
    point.z = -1.0F;
    point.intensity = 2.0F * x;
    point.normal_z = 1.0F;
    cloud->push_back(point);
  }
  VerticalCorrection<pcl::PointXYZINormal> correction;
  correction.setInputCloud(cloud);
  correction.setAngle(0.5);
  pcl::PointCloud<pcl::PointXYZINormal> corrected;
  correction.filter(corrected);
  ASSERT_EQ(corrected.size(), 3U);
  EXPECT_TRUE(std::isnan(corrected[1].x));
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    const auto& before = (*cloud)[i];
    const auto& after = corrected[i];
    EXPECT_EQ(after.intensity, before.intensity);
    EXPECT_NEAR(after.getVector3fMap().norm(), before.getVector3fMap().norm(), 1e-4);
    const double rise =
        std::atan2(after.z, std::hypot(after.x, after.y)) - std::atan2(before.z, std::hypot(before.x, before.y));
    EXPECT_NEAR(rise * 180.0 / kPi, 0.5, 1e-4);
    // The normal turns with its point: their product stays.
    EXPECT_NEAR(after.getVector3fMap().dot(after.getNormalVector3fMap()),
                before.getVector3fMap().dot(before.getNormalVector3fMap()), 1e-4);
    EXPECT_LT(after.normal_z, 1.0F);
  }
  correction.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{2}));
  correction.filter(corrected);
  ASSERT_EQ(corrected.size(), 1U);
  EXPECT_EQ(corrected[0].intensity, 8.0F);
  correction.setIndices(pcl::make_shared<pcl::Indices>(pcl::Indices{3}));
  EXPECT_THROW(correction.filter(corrected), std::invalid_argument);
  EXPECT_THROW(correction.setAngle(std::nan("")), std::invalid_argument);
}

TEST(VerticalCorrection, ThreadsGiveTheSameBits)
{
  std::mt19937 random(4);
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 20001; ++i) {
    pcl::PointXYZ point;
    point.getVector3fMap() = randomVector(random, 50.0).cast<float>();
    cloud->push_back(point);
  }
  VerticalCorrection<pcl::PointXYZ> correction;
  correction.setInputCloud(cloud);
  correction.setAngle(0.5);
  EXPECT_EQ(correction.getNumberOfThreads(), 1);
  pcl::PointCloud<pcl::PointXYZ> once;
  correction.filter(once);
  correction.setNumberOfThreads(3);
  EXPECT_EQ(correction.getNumberOfThreads(), 3);
  pcl::PointCloud<pcl::PointXYZ> shared;
  correction.filter(shared);
  ASSERT_EQ(shared.size(), once.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(shared[i].getVector3fMap(), once[i].getVector3fMap());
  }
}

}  // namespace
}  // namespace pcl_floam::test
