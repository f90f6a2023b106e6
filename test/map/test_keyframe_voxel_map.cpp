// The map of keyframes, and when a scan becomes one.
#include "support/constants.h"
#include "support/random_motion.h"

#include <pcl_floam/map/core/keyframe_policy.h>
#include <pcl_floam/map/keyframe_voxel_map.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pcl_floam::test {
namespace {

FeatureSet randomFeatures(unsigned seed, int count = 300)
{
  std::mt19937 random(seed);
  FeatureSet features;
  for (int i = 0; i < count; ++i) {
    Feature feature;
    feature.x = static_cast<float>(uniform(random, 20.0));
    feature.y = static_cast<float>(uniform(random, 20.0));
    feature.z = static_cast<float>(uniform(random, 3.0));
    (i % 3 == 0 ? features.edges : features.planes).push_back(feature);
  }
  return features;
}

TEST(KeyframeVoxelMap, HoldsFeaturesInTheWorld)
{
  const SE3 pose = exp((Vector6() << 10.0, -5.0, 1.0, 0.1, 0.2, 2.0).finished());
  const FeatureSet features = randomFeatures(1);
  KeyframeVoxelMap map;
  EXPECT_TRUE(map.empty());
  map.insert(features, pose);
  const auto expectNear = [&](const std::vector<Feature>& of_kind, FeatureKind kind) {
    for (const Feature& feature : of_kind) {
      Neighbors neighbors;
      map.search(kind).nearest(pose * Eigen::Vector3d(feature.x, feature.y, feature.z), 1, 0.5, neighbors);
      ASSERT_EQ(neighbors.count, 1);
    }
  };
  expectNear(features.edges, FeatureKind::edge);
  expectNear(features.planes, FeatureKind::plane);
  EXPECT_LE(map.size(FeatureKind::edge), features.edges.size());
  EXPECT_GT(map.size(FeatureKind::plane), map.size(FeatureKind::edge));
}

TEST(KeyframeVoxelMap, BothSearchesGiveTheSameNeighbours)
{
  MapParameters parameters;
  KeyframeVoxelMap voxels(parameters);
  parameters.search = SearchMethod::kdtree;
  KeyframeVoxelMap tree(parameters);
  for (unsigned seed = 1; seed < 4; ++seed) {
    const SE3 pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(seed, 0.0, 0.0));
    voxels.insert(randomFeatures(seed, 3000), pose);
    tree.insert(randomFeatures(seed, 3000), pose);
  }
  std::mt19937 random(9);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3d query(uniform(random, 20.0), uniform(random, 20.0), uniform(random, 3.0));
    for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
      Neighbors a;
      Neighbors b;
      voxels.search(kind).nearest(query, 5, 2.0, a);
      tree.search(kind).nearest(query, 5, 2.0, b);
      ASSERT_EQ(a.count, b.count);
      for (int i = 0; i < a.count; ++i) {
        EXPECT_LT((a[i].offset - b[i].offset).norm(), 1e-5F);
      }
    }
  }
}

TEST(KeyframeVoxelMap, ForgetsBeyondTheHorizon)
{
  MapParameters parameters;
  parameters.horizon = 50.0;
  KeyframeVoxelMap map(parameters);
  for (int k = 0; k < 30; ++k) {
    const SE3 pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(10.0 * k, 0.0, 0.0));
    map.insert(randomFeatures(static_cast<unsigned>(k)), pose);
    for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
      for (const Eigen::Vector3d& point : map.points(kind)) {
        EXPECT_LT((point - pose.translation).norm(), 1.1 * 50.0 + 2.0);
      }
    }
  }
  EXPECT_FALSE(map.empty());
  map.crop(Eigen::Vector3d(0.0, 0.0, 1e4));
  EXPECT_TRUE(map.empty());
}

TEST(KeyframeVoxelMap, CopiesAreIndependent)
{
  for (const SearchMethod search : {SearchMethod::voxel, SearchMethod::kdtree}) {
    MapParameters parameters;
    parameters.search = search;
    KeyframeVoxelMap map(parameters);
    map.insert(randomFeatures(1), SE3());
    KeyframeVoxelMap copy(map);
    KeyframeVoxelMap assigned;
    assigned = map;
    const auto before = map.points(FeatureKind::plane);
    map.insert(randomFeatures(2), SE3());
    EXPECT_EQ(copy.points(FeatureKind::plane), before);
    EXPECT_EQ(assigned.points(FeatureKind::plane), before);
    EXPECT_NE(map.points(FeatureKind::plane), before);
    copy.clear();
    EXPECT_TRUE(copy.empty());
    EXPECT_FALSE(assigned.empty());
    Neighbors neighbors;
    copy.search(FeatureKind::plane).nearest(before.front(), 1, 1.0, neighbors);
    EXPECT_EQ(neighbors.count, 0);
    assigned.search(FeatureKind::plane).nearest(before.front(), 1, 1.0, neighbors);
    EXPECT_EQ(neighbors.count, 1);
  }
}

TEST(KeyframeVoxelMap, SameInsertionsSamePointsInTheSameOrder)
{
  KeyframeVoxelMap a;
  KeyframeVoxelMap b;
  for (unsigned seed = 1; seed < 5; ++seed) {
    a.insert(randomFeatures(seed), SE3());
  }
  for (unsigned seed = 1; seed < 5; ++seed) {
    b.insert(randomFeatures(seed), SE3());
  }
  EXPECT_EQ(a.points(FeatureKind::edge), b.points(FeatureKind::edge));
  EXPECT_EQ(a.points(FeatureKind::plane), b.points(FeatureKind::plane));
}

/// For every number of threads.
TEST(KeyframeVoxelMap, APointsIntensityIsTheMeanOfWhatFellIntoItsVoxel)
{
  for (const int threads : {1, 2}) {
    KeyframeVoxelMap map;
    for (const float intensity : {10.0F, 20.0F, 60.0F}) {
      FeatureSet features;
      for (int i = 0; i < 30; ++i) {
        Feature feature;
        feature.x = 0.5F + static_cast<float>(i);
        feature.y = feature.z = 0.05F;
        feature.intensity = intensity + static_cast<float>(i);
        features.planes.push_back(feature);
      }
      map.insert(features, SE3(), threads);
    }
    const std::vector<Eigen::Vector3d> points = map.points(FeatureKind::plane);
    const std::vector<float> intensities = map.intensities(FeatureKind::plane);
    ASSERT_EQ(points.size(), 30U);
    ASSERT_EQ(intensities.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(intensities[i], 30.0 + points[i].x() - 0.5, 1e-4);
    }
    EXPECT_TRUE(map.intensities(FeatureKind::edge).empty());
    EXPECT_THROW(map.insertPoints(FeatureKind::edge, points, {1.0F}), std::invalid_argument);
  }
}

TEST(KeyframeVoxelMap, PointsComeBackFromItsCloud)
{
  KeyframeVoxelMap map;
  map.insert(randomFeatures(1), SE3());
  const auto points = map.points(FeatureKind::edge);
  const auto cloud = map.cloud(FeatureKind::edge);
  ASSERT_EQ(cloud->size(), points.size());
  KeyframeVoxelMap loaded;
  loaded.insertPoints(FeatureKind::edge, points);
  EXPECT_EQ(loaded.size(FeatureKind::edge), points.size());
  EXPECT_EQ(loaded.size(FeatureKind::plane), 0U);
}

TEST(KeyframeVoxelMap, TakesAndGivesCloudsOfAnyPointType)
{
  pcl::PointCloud<pcl::PointXYZI> scan;
  for (int i = 0; i < 20; ++i) {
    pcl::PointXYZI point;
    point.x = static_cast<float>(i);
    point.intensity = 3.0F * static_cast<float>(i);
    scan.push_back(point);
  }
  scan[7].y = std::numeric_limits<float>::quiet_NaN();
  const SE3 world_T_sensor(expSO3(Eigen::Vector3d(0.0, 0.0, kPi / 2.0)), Eigen::Vector3d(0.0, 0.0, 5.0));
  KeyframeVoxelMap map;
  map.addPointCloud(scan, FeatureKind::plane, world_T_sensor);
  EXPECT_EQ(map.size(FeatureKind::edge), 0U);
  const auto cloud = map.cloud<pcl::PointXYZI>(FeatureKind::plane);
  ASSERT_EQ(cloud->size(), 19U);
  for (const pcl::PointXYZI& point : *cloud) {
    EXPECT_NEAR(point.x, 0.0, 1e-4);
    EXPECT_NEAR(point.z, 5.0, 1e-4);
    EXPECT_NEAR(point.intensity, 3.0 * point.y, 1e-3);
  }
}

TEST(KeyframeVoxelMap, SettingsOutOfRangeAreRefused)
{
  MapParameters parameters;
  parameters.voxel_size = 0.0;
  EXPECT_THROW(KeyframeVoxelMap{parameters}, std::invalid_argument);
  parameters = {};
  parameters.horizon = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(KeyframeVoxelMap{parameters}, std::invalid_argument);
  parameters = {};
  parameters.see_through_range = -1.0;
  EXPECT_THROW(KeyframeVoxelMap{parameters}, std::invalid_argument);
}

/// Half a metre, or a tenth of a radian.
TEST(KeyframePolicy, TakesAScanAfterEitherThreshold)
{
  KeyframePolicy policy;
  policy.translation = 0.5;
  const SE3 last = exp((Vector6() << 5.0, 1.0, 0.0, 0.3, 0.0, 1.0).finished());
  const auto after = [&](double way, double turn) {
    return policy.isKeyframe(last, last * SE3(expSO3(Eigen::Vector3d(0.0, turn, 0.0)), Eigen::Vector3d(0.0, way, 0.0)));
  };
  EXPECT_FALSE(after(0.0, 0.0));
  EXPECT_FALSE(after(0.49, 0.09));
  EXPECT_TRUE(after(0.51, 0.0));
  EXPECT_TRUE(after(0.0, 0.11));
  EXPECT_TRUE(after(-0.51, -0.11));
}

}  // namespace
}  // namespace pcl_floam::test
