// Nearest neighbours among voxels, against brute force and against the KD-tree.
#include "map/kdtree_search.h"
#include "map/voxel_layer.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace pcl_floam::test {
namespace {

const Eigen::Vector3d kNear = Eigen::Vector3d::Zero();
const Eigen::Vector3d kFar(1e6, -1e6, 1e4);  // 1000 km away

Eigen::Vector3d randomPoint(std::mt19937& random, const Eigen::Vector3d& center, double limit)
{
  return center + Eigen::Vector3d(uniform(random, limit), uniform(random, limit), uniform(random, limit));
}

void insert(VoxelLayer& layer, const Eigen::Vector3d& point)
{
  layer.insertEach(&point, 1);
}

VoxelLayer filledLayer(const Eigen::Vector3d& center, int points = 4000, double limit = 5.0, double voxel = 0.2)
{
  std::mt19937 random(1);
  VoxelLayer layer(voxel);
  for (int i = 0; i < points; ++i) {
    insert(layer, randomPoint(random, center, limit));
  }
  return layer;
}

std::vector<double> bruteForce(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& query, double radius)
{
  std::vector<double> distances;
  for (const Eigen::Vector3d& point : points) {
    if ((point - query).norm() <= radius) {
      distances.push_back((point - query).norm());
    }
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

void expectBruteForce(const NeighborSearch& search, const std::vector<Eigen::Vector3d>& points,
                      const Eigen::Vector3d& center, double limit)
{
  std::mt19937 random(2);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3d query = randomPoint(random, center, limit);
    for (const double radius : {0.3, 1.0, 40.0}) {
      const auto expected = bruteForce(points, query, radius);
      for (const int k : {1, 5, kMaxNeighbors}) {
        Neighbors neighbors;
        search.nearest(query, k, radius, neighbors);
        ASSERT_EQ(neighbors.count, std::min(static_cast<int>(expected.size()), k));
        for (int i = 0; i < neighbors.count; ++i) {
          EXPECT_NEAR(neighbors[i].offset.norm(), expected[static_cast<std::size_t>(i)], 1e-5);
          EXPECT_NEAR(neighbors[i].squared_distance, neighbors[i].offset.squaredNorm(), 1e-4);
        }
      }
    }
  }
}

TEST(VoxelLayer, NeighboursAreThoseOfBruteForceNearAndFarFromTheOrigin)
{
  for (const Eigen::Vector3d& center : {kNear, kFar}) {
    const VoxelLayer layer = filledLayer(center);
    expectBruteForce(layer, layer.points(), center, 6.0);
  }
}

TEST(VoxelLayer, NeighboursOfAManyBlockLayer)
{
  // So many blocks that the search goes from block to block instead of over all.
  const VoxelLayer layer = filledLayer(kNear, 30000, 20.0);
  const auto points = layer.points();
  std::mt19937 random(3);
  for (int n = 0; n < 50; ++n) {
    const Eigen::Vector3d query = randomPoint(random, kNear, 20.0);
    Neighbors neighbors;
    layer.nearest(query, 5, 3.0, neighbors);
    const auto expected = bruteForce(points, query, 3.0);
    ASSERT_EQ(neighbors.count, 5);
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(neighbors[i].offset.norm(), expected[static_cast<std::size_t>(i)], 1e-5);
    }
  }
}

TEST(VoxelLayer, NeighboursOfManySparseBlocks)
{
  // One point in each block, and no near ones: the search comes through hundreds of blocks before it has its twenty.
  std::mt19937 random(7);
  VoxelLayer layer(0.2);
  for (int x = -12; x < 12; ++x) {
    for (int y = -12; y < 12; ++y) {
      for (int z = -12; z < 12; ++z) {
        insert(layer, Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5) + randomPoint(random, kNear, 0.4));
      }
    }
  }
  const auto points = layer.points();
  for (int n = 0; n < 20; ++n) {
    const Eigen::Vector3d query = randomPoint(random, kNear, 6.0);
    const auto expected = bruteForce(points, query, 5.0);
    Neighbors neighbors;
    layer.nearest(query, kMaxNeighbors, 5.0, neighbors);
    ASSERT_EQ(neighbors.count, kMaxNeighbors);
    for (int i = 0; i < neighbors.count; ++i) {
      EXPECT_NEAR(neighbors[i].offset.norm(), expected[static_cast<std::size_t>(i)], 1e-5);
    }
  }
}

TEST(VoxelLayer, ManyPointsAtOnceAsOneByOne)
{
  std::mt19937 random(8);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1003; ++i) {
    points.push_back(randomPoint(random, kFar, 3.0));
  }
  points[500].x() = std::numeric_limits<double>::quiet_NaN();
  VoxelLayer one_by_one(0.2);
  for (const Eigen::Vector3d& point : points) {
    insert(one_by_one, point);
  }
  VoxelLayer at_once(0.2);
  at_once.insertEach(points.data(), points.size());
  EXPECT_EQ(at_once.points(), one_by_one.points());
  EXPECT_EQ(at_once.size(), one_by_one.size());
  for (const int threads : {2, 3, 7}) {
    VoxelLayer shared(0.2);
    shared.insertEach(points.data(), points.size(), threads);
    EXPECT_EQ(shared.points(), one_by_one.points()) << threads;
    EXPECT_EQ(shared.size(), one_by_one.size()) << threads;
  }
}

TEST(KdTreeSearch, AgreesWithTheVoxels)
{
  for (const Eigen::Vector3d& center : {kNear, kFar}) {
    const VoxelLayer layer = filledLayer(center);
    const KdTreeSearch tree(layer.points());
    expectBruteForce(tree, layer.points(), center, 6.0);
    std::mt19937 random(4);
    for (int n = 0; n < 100; ++n) {
      const Eigen::Vector3d query = randomPoint(random, center, 5.0);
      Neighbors by_voxels;
      Neighbors by_tree;
      layer.nearest(query, 5, 1.0, by_voxels);
      tree.nearest(query, 5, 1.0, by_tree);
      ASSERT_EQ(by_voxels.count, by_tree.count);
      for (int i = 0; i < by_tree.count; ++i) {
        EXPECT_LT((by_voxels[i].offset - by_tree[i].offset).norm(), 1e-5F);
      }
    }
  }
}

TEST(VoxelLayer, OnePointPerVoxelItsMean)
{
  VoxelLayer layer(0.5);
  insert(layer, {0.1, 0.1, 0.1});
  insert(layer, {0.3, 0.2, 0.1});
  insert(layer, {-0.1, 0.1, 0.1});
  ASSERT_EQ(layer.size(), 2U);
  auto points = layer.points();
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  EXPECT_LT((points[0] - Eigen::Vector3d(-0.1, 0.1, 0.1)).norm(), 1e-6);
  EXPECT_LT((points[1] - Eigen::Vector3d(0.2, 0.15, 0.1)).norm(), 1e-6);
}

TEST(VoxelLayer, VoxelsAreWhereTheyShouldBeFarFromTheOrigin)
{
  for (const Eigen::Vector3d& center : {kNear, kFar}) {
    VoxelLayer layer(0.25);
    for (int x = -8; x < 8; ++x) {
      for (int y = -8; y < 8; ++y) {
        insert(layer, center + 0.25 * Eigen::Vector3d(x + 0.5, y + 0.5, 0.5));
        insert(layer, center + 0.25 * Eigen::Vector3d(x + 0.7, y + 0.3, 0.9));
      }
    }
    EXPECT_EQ(layer.size(), 256U);
    EXPECT_EQ(layer.points().size(), 256U);
  }
}

TEST(VoxelLayer, CropForgetsWhatIsFar)
{
  for (const Eigen::Vector3d& center : {kNear, kFar}) {
    VoxelLayer layer = filledLayer(center, 4000, 10.0);
    const auto before = layer.points();
    layer.crop(center, 6.0);
    const double block = 0.5 * std::sqrt(3.0) * 0.8;  // whole blocks are kept or forgotten
    const auto after = layer.points();
    EXPECT_EQ(layer.size(), after.size());
    for (const Eigen::Vector3d& point : after) {
      EXPECT_LT((point - center).norm(), 6.0 + block);
    }
    const auto inside = [&](const Eigen::Vector3d& point) { return (point - center).norm() < 6.0 - block; };
    EXPECT_EQ(std::count_if(before.begin(), before.end(), inside), std::count_if(after.begin(), after.end(), inside));
    EXPECT_LT(after.size(), before.size());
    expectBruteForce(layer, after, center, 6.0);
  }
}

/// Places of blocks that were forgotten serve others: nobody finds these where the old ones were.
TEST(VoxelLayer, WhatIsForgottenMakesRoomForOthers)
{
  const Eigen::Vector3d elsewhere(60.0, 0.0, 0.0);
  VoxelLayer layer = filledLayer(kNear, 4000, 10.0);
  layer.crop(kNear, 6.0);
  for (const int threads : {1, 4}) {
    VoxelLayer filled(layer);
    const std::vector<Eigen::Vector3d> others = filledLayer(kNear + elsewhere, 4000, 10.0).points();
    filled.insertEach(others.data(), others.size(), threads);
    EXPECT_EQ(filled.size(), layer.size() + others.size());
    expectBruteForce(filled, filled.points(), kNear, 8.0);
    expectBruteForce(filled, filled.points(), kNear + elsewhere, 8.0);
    filled.clear();
    filled.insertEach(others.data(), others.size(), threads);
    expectBruteForce(filled, filled.points(), kNear + elsewhere, 8.0);
  }
}

TEST(VoxelLayer, PointsWithoutAPlaceAreLeftOut)
{
  VoxelLayer layer(0.2);
  insert(layer, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  insert(layer, {0.0, std::numeric_limits<double>::infinity(), 0.0});
  insert(layer, {0.0, 0.0, 1e300});
  EXPECT_EQ(layer.size(), 0U);
  insert(layer, {0.0, 0.0, 0.0});
  Neighbors neighbors;
  layer.nearest({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, 5, 1.0, neighbors);
  EXPECT_EQ(neighbors.count, 0);
  layer.nearest({0.0, std::numeric_limits<double>::infinity(), 0.0}, 5, 1.0, neighbors);
  EXPECT_EQ(neighbors.count, 0);
}

TEST(NeighborSearch, EmptyAndPoorTargets)
{
  Neighbors neighbors;
  const KdTreeSearch none({});
  none.nearest(kNear, 5, 1.0, neighbors);
  EXPECT_EQ(neighbors.count, 0);
  const KdTreeSearch no_finite({Eigen::Vector3d(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0)});
  no_finite.nearest(kNear, 5, 1.0, neighbors);
  EXPECT_EQ(neighbors.count, 0);
  const KdTreeSearch two({Eigen::Vector3d(0.1, 0.0, 0.0), Eigen::Vector3d(0.0, 0.3, 0.0)});
  two.nearest(kNear, 5, 1.0, neighbors);
  ASSERT_EQ(neighbors.count, 2);
  EXPECT_NEAR(neighbors[0].offset.x(), 0.1F, 1e-6F);
  two.nearest(Eigen::Vector3d(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0), 5, 1.0, neighbors);
  EXPECT_EQ(neighbors.count, 0);
}

}  // namespace
}  // namespace pcl_floam::test
