// The map inside PCL's algorithms.
#include "support/constants.h"
#include "support/random_motion.h"

#include <pcl_floam/map/map_search.h>

#include <pcl/features/normal_3d.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/impl/extract_clusters.hpp>  // so that its library need not be linked

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <set>

namespace pcl_floam::test {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

/// A floor, and two columns of points on it that stand apart.
KeyframeVoxelMap furnishedMap()
{
  std::mt19937 random(3);
  std::vector<Eigen::Vector3d> floor;
  for (int i = 0; i < 4000; ++i) {
    floor.emplace_back(uniform(random, 8.0), uniform(random, 8.0), uniform(random, 0.01));
  }
  std::vector<Eigen::Vector3d> columns;
  for (int i = 0; i < 40; ++i) {
    columns.emplace_back(-3.0, 0.0, 0.1 * i);
    columns.emplace_back(3.0, 1.0, 0.1 * i);
  }
  KeyframeVoxelMap map;
  map.insertPoints(FeatureKind::plane, floor);
  map.insertPoints(FeatureKind::edge, columns);
  return map;
}

std::vector<Point> queries()
{
  std::mt19937 random(5);
  std::vector<Point> points;
  for (int i = 0; i < 100; ++i) {
    points.emplace_back(static_cast<float>(uniform(random, 9.0)), static_cast<float>(uniform(random, 9.0)),
                        static_cast<float>(uniform(random, 1.0)));
  }
  return points;
}

TEST(MapSearch, AgreesWithTheMapsOwnSearch)
{
  const KeyframeVoxelMap map = furnishedMap();
  const MapSearch<Point> search(map, FeatureKind::plane);
  pcl::Indices indices;
  std::vector<float> distances;
  for (const Point& query : queries()) {
    const Eigen::Vector3d position = query.getVector3fMap().cast<double>();
    Neighbors expected;
    map.search(FeatureKind::plane).nearest(position, 10, 100.0, expected);
    ASSERT_EQ(search.nearestKSearch(query, 10, indices, distances), expected.count);
    for (int i = 0; i < expected.count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      EXPECT_NEAR(std::sqrt(distances[n]), expected[i].offset.norm(), 1e-4);
      const Point& found = search.getInputCloud()->at(static_cast<std::size_t>(indices[n]));
      EXPECT_NEAR((found.getVector3fMap() - query.getVector3fMap()).squaredNorm(), distances[n], 1e-4F);
    }
    std::size_t within = 0;
    for (const Eigen::Vector3d& point : map.points(FeatureKind::plane)) {
      within += (point - position).norm() <= 1.0 ? 1 : 0;
    }
    EXPECT_EQ(search.radiusSearch(query, 1.0, indices, distances), static_cast<int>(within));
  }
}

TEST(MapSearch, GivesMoreNeighboursThanTheMapsOwnSearchCan)
{
  const KeyframeVoxelMap map = furnishedMap();
  const MapSearch<Point> search(map, FeatureKind::edge);
  const auto size = static_cast<int>(map.size(FeatureKind::edge));
  ASSERT_GT(size, kMaxNeighbors);
  pcl::Indices indices;
  std::vector<float> distances;
  EXPECT_EQ(search.nearestKSearch(Point(0.0F, 0.0F, 0.0F), 10 * size, indices, distances), size);
  EXPECT_EQ(std::set<int>(indices.begin(), indices.end()).size(), static_cast<std::size_t>(size));
  EXPECT_EQ(search.radiusSearch(Point(0.0F, 0.0F, 0.0F), 100.0, indices, distances, 30U), 30);
}

TEST(MapSearch, NormalsOfAScanFromTheMap)
{
  const KeyframeVoxelMap map = furnishedMap();
  const auto search = pcl::make_shared<MapSearch<Point>>(map, FeatureKind::plane);
  const auto scan = pcl::make_shared<Cloud>();
  for (const Point& query : queries()) {
    scan->push_back(query);
  }
  pcl::NormalEstimation<Point, pcl::Normal> estimation;
  estimation.setInputCloud(scan);
  estimation.setSearchSurface(search->getInputCloud());
  estimation.setSearchMethod(search);
  estimation.setKSearch(15);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  ASSERT_EQ(normals.size(), scan->size());

  pcl::PointCloud<pcl::Normal> expected;
  estimation.setSearchSurface(map.cloud(FeatureKind::plane));
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<Point>>());
  estimation.compute(expected);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    EXPECT_GT(std::abs(normals[i].normal_z), 0.99F);
    EXPECT_NEAR(normals[i].normal_z, expected[i].normal_z, 1e-4F);
    EXPECT_NEAR(normals[i].curvature, expected[i].curvature, 1e-4F);
  }
}

std::vector<pcl::PointIndices> clustersOf(const MapSearch<Point>::Ptr& search, const pcl::IndicesPtr& indices = nullptr)
{
  pcl::EuclideanClusterExtraction<Point> extraction;
  extraction.setInputCloud(search->getInputCloud());
  if (indices) {
    extraction.setIndices(indices);
  }
  extraction.setSearchMethod(search);
  extraction.setClusterTolerance(0.5);
  std::vector<pcl::PointIndices> clusters;
  extraction.extract(clusters);
  return clusters;
}

TEST(MapSearch, ClustersOfTheMap)
{
  const KeyframeVoxelMap map = furnishedMap();
  const auto search = pcl::make_shared<MapSearch<Point>>(map, FeatureKind::edge);
  const auto clusters = clustersOf(search);
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_EQ(clusters[0].indices.size() + clusters[1].indices.size(), map.size(FeatureKind::edge));
  for (const pcl::PointIndices& cluster : clusters) {
    const bool left = search->getInputCloud()->at(static_cast<std::size_t>(cluster.indices.front())).x < 0.0F;
    for (const int index : cluster.indices) {
      EXPECT_EQ(search->getInputCloud()->at(static_cast<std::size_t>(index)).x < 0.0F, left);
    }
  }
}

TEST(MapSearch, KnowsWhatItTook)
{
  EXPECT_EQ(MapSearch<Point>().getMap(), nullptr);
  const KeyframeVoxelMap map = furnishedMap();
  MapSearch<Point> search(map, FeatureKind::edge);
  const auto taken = search.getMap();
  EXPECT_EQ(taken->size(), map.size(FeatureKind::edge));
  search.setInputCloud(pcl::make_shared<Cloud>(1, 1));
  EXPECT_EQ(search.getMap(), taken);
}

TEST(MapSearch, ClustersAmongIndices)
{
  const auto search = pcl::make_shared<MapSearch<Point>>(furnishedMap(), FeatureKind::edge);
  auto left = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < search->getInputCloud()->size(); ++i) {
    if (search->getInputCloud()->at(i).x < 0.0F) {
      left->push_back(static_cast<int>(i));
    }
  }
  const auto clusters = clustersOf(search, left);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_EQ(clusters[0].indices.size(), left->size());
}

TEST(MapSearch, StaysWhileTheMapGrowsUntilItIsSetAgain)
{
  KeyframeVoxelMap map = furnishedMap();
  MapSearch<Point> search(map, FeatureKind::edge);
  const std::size_t before = search.getInputCloud()->size();
  map.insertPoints(FeatureKind::edge, {Eigen::Vector3d(50.0, 0.0, 0.0)});
  EXPECT_EQ(search.getInputCloud()->size(), before);
  pcl::Indices indices;
  std::vector<float> distances;
  EXPECT_EQ(search.radiusSearch(Point(50.0F, 0.0F, 0.0F), 1.0, indices, distances), 0);
  search.setMap(map, FeatureKind::edge);
  EXPECT_EQ(search.radiusSearch(Point(50.0F, 0.0F, 0.0F), 1.0, indices, distances), 1);
}

TEST(MapSearch, NothingToFindIsNoError)
{
  pcl::Indices indices;
  std::vector<float> distances;
  MapSearch<Point> search;
  EXPECT_EQ(search.nearestKSearch(Point(0.0F, 0.0F, 0.0F), 3, indices, distances), 0);
  search.setMap(KeyframeVoxelMap(), FeatureKind::plane);
  EXPECT_EQ(search.nearestKSearch(Point(0.0F, 0.0F, 0.0F), 3, indices, distances), 0);
  EXPECT_EQ(search.radiusSearch(Point(0.0F, 0.0F, 0.0F), 3.0, indices, distances), 0);
  search.setMap(furnishedMap(), FeatureKind::plane);
  EXPECT_EQ(search.nearestKSearch(Point(kNan, 0.0F, 0.0F), 3, indices, distances), 0);
  EXPECT_EQ(search.radiusSearch(Point(0.0F, kNan, 0.0F), 3.0, indices, distances), 0);
  EXPECT_TRUE(indices.empty());
}

}  // namespace
}  // namespace pcl_floam::test
