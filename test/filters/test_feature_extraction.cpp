// Edges at the corners of a room, planes on its walls.
// PointXYZIRT is no type of PCL's own.
#define PCL_NO_PRECOMPILE
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/feature_extraction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace pcl_floam::test {
namespace {

using Extraction = FeatureExtraction<PointXYZIRT>;

TEST(FeatureExtraction, EdgesLieAtTheCornersOfARoom)
{
  const Room room = emptyRoom();
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(scanOf(room));
  ASSERT_TRUE(extraction.extract(features));
  std::set<std::pair<int, int>> corners;
  std::set<std::pair<int, std::pair<int, int>>> corners_of_lines;
  for (const Feature& edge : features.edges) {
    EXPECT_LT(distancesFromWalls(room, edge.x, edge.y).second, 0.1);
    const std::pair<int, int> corner(edge.x > 0.0F ? 1 : 0, edge.y > 0.0F ? 1 : 0);
    corners.insert(corner);
    corners_of_lines.insert({(*extraction.getInputCloud())[static_cast<std::size_t>(edge.index)].ring, corner});
  }
  EXPECT_EQ(corners.size(), 4U);
  EXPECT_GT(corners_of_lines.size(), 110U);  // of 32 lines with 4 corners each
}

TEST(FeatureExtraction, PlanesLieOnItsWalls)
{
  const Room room = emptyRoom();
  FeatureParameters parameters;
  parameters.edges_per_sector = 0;  // edges keep planes away from corners; so must the threshold by itself
  parameters.planes_per_sector = 1000;
  FeatureSet features;
  Extraction extraction;
  extraction.setParameters(parameters);
  extraction.setInputCloud(scanOf(room));
  ASSERT_TRUE(extraction.extract(features));
  EXPECT_TRUE(features.edges.empty());
  EXPECT_GT(features.planes.size(), 2000U);
  for (const Feature& plane : features.planes) {
    const auto [off_wall, off_corner] = distancesFromWalls(room, plane.x, plane.y);
    EXPECT_LT(off_wall, 1e-4);
    EXPECT_GT(off_corner, 0.05);
    EXPECT_LT(plane.smoothness, parameters.plane_threshold);
  }
}

TEST(FeatureExtraction, EdgesAreANeighbourhoodApart)
{
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(scanOf(Room()));
  ASSERT_TRUE(extraction.extract(features));
  EXPECT_GT(features.edges.size(), 100U);
  for (const Feature& edge : features.edges) {
    for (const auto* set : {&features.edges, &features.planes}) {
      for (const Feature& other : *set) {  // 32 points a column
        if (&other != &edge && other.index % 32 == edge.index % 32) {
          EXPECT_GT(std::abs(other.index - edge.index) / 32, 5);
        }
      }
    }
  }
}

TEST(FeatureExtraction, PlanesAreTheCloudsPointsAndEdgesNearThem)
{
  const auto cloud = scanOf(Room());
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(cloud);
  ASSERT_TRUE(extraction.extract(features));
  std::set<std::int32_t> seen;
  for (const Feature& feature : features.planes) {
    const PointXYZIRT& point = (*cloud)[static_cast<std::size_t>(feature.index)];
    EXPECT_EQ(feature.x, point.x);
    EXPECT_EQ(feature.y, point.y);
    EXPECT_EQ(feature.z, point.z);
    EXPECT_NEAR(feature.time, point.time / 0.1F, 1e-5F);
    EXPECT_TRUE(seen.insert(feature.index).second) << "twice";
  }
  // Edges are where the surfaces meet: in this room, no farther off than what is thin is wide.
  int moved = 0;
  for (const Feature& feature : features.edges) {
    const PointXYZIRT& point = (*cloud)[static_cast<std::size_t>(feature.index)];
    const Eigen::Vector3f off(feature.x - point.x, feature.y - point.y, feature.z - point.z);
    EXPECT_LT(off.norm(), 0.4F);
    moved += off.norm() > 0.0F ? 1 : 0;
    EXPECT_NEAR(feature.time, point.time / 0.1F, 1e-5F);
    EXPECT_TRUE(seen.insert(feature.index).second) << "both edge and plane, or twice";
  }
  EXPECT_GT(moved, static_cast<int>(features.edges.size()) / 2);
}

TEST(FeatureExtraction, APostIsOneEdgeAScanLineAtItsAxis)
{
  Room room;
  room.walls = {{-30.0, -30.0, -30.0}, {30.0, 30.0, 30.0}};
  room.furniture = {{{7.95, 2.95, -30.0}, {8.05, 3.05, 30.0}}};
  const auto cloud = scanOf(room);
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(cloud);
  ASSERT_TRUE(extraction.extract(features));
  std::set<int> rings;
  for (const Feature& edge : features.edges) {
    const Eigen::Vector2f off(edge.x - 8.0F, edge.y - 3.0F);
    if (off.norm() < 1.0F) {
      EXPECT_LT(off.norm(), 0.04F) << "its surface is 5 cm away and more, the beams are 6 cm apart";
      EXPECT_TRUE(rings.insert((*cloud)[static_cast<std::size_t>(edge.index)].ring).second);
    }
  }
  EXPECT_GT(rings.size(), 20U);
}

TEST(FeatureExtraction, AnEdgeIsAtAPointThatWasAskedForAndHasTheTimeOfItsMiddle)
{
  // A post of nine columns and more, of which the inner ones are not asked for.
  Room room;
  room.walls = {{-30.0, -30.0, -30.0}, {30.0, 30.0, 30.0}};
  room.furniture = {{{2.9, 0.9, -30.0}, {3.1, 1.1, 30.0}}};
  const auto cloud = scanOf(room);
  const double middle = std::atan2(1.0, 3.0);
  const auto offMiddle = [&](const PointXYZIRT& point) { return std::abs(std::atan2(point.y, point.x) - middle); };
  auto outer = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    if (offMiddle((*cloud)[i]) > 0.02) {
      outer->push_back(static_cast<int>(i));
    }
  }
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(cloud);
  extraction.setIndices(outer);
  ASSERT_TRUE(extraction.extract(features));
  std::set<int> rings;
  for (const Feature& edge : features.edges) {
    if (std::abs(std::atan2(edge.y, edge.x) - middle) > 0.1) {
      continue;
    }
    const PointXYZIRT& point = (*cloud)[static_cast<std::size_t>(edge.index)];
    EXPECT_GT(offMiddle(point), 0.02);
    EXPECT_GT(std::abs(edge.time - point.time / 0.1F), 0.02F / 6.3F);
    EXPECT_TRUE(rings.insert(point.ring).second) << "one edge a scan line";
  }
  EXPECT_GT(rings.size(), 20U);
}

TEST(FeatureExtraction, NothingOnTheFarSideOfADepthStepIsAnEdge)
{
  // A board before a wall: its two sides are edges; beside it the wall only begins because the board hides the rest.
  Room room;
  room.walls = {{-9.0, -9.0, -30.0}, {9.0, 9.0, 30.0}};
  room.furniture = {{{5.0, -1.0, -30.0}, {5.2, 1.0, 30.0}}};
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(scanOf(room));
  ASSERT_TRUE(extraction.extract(features));
  int on_board = 0;
  for (const Feature& edge : features.edges) {
    if (std::abs(edge.y) < 3.0F && edge.x > 0.0F) {
      EXPECT_LT(edge.x, 5.3F) << "at y = " << edge.y;
      ++on_board;
    }
  }
  EXPECT_GT(on_board, 40);

  // Nor when the board's own edges, which keep others away, are not asked for.
  auto wall = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < extraction.getInputCloud()->size(); ++i) {
    if ((*extraction.getInputCloud())[i].x > 5.3F) {
      wall->push_back(static_cast<int>(i));
    }
  }
  extraction.setIndices(wall);
  ASSERT_TRUE(extraction.extract(features));
  EXPECT_FALSE(features.planes.empty());
  for (const Feature& edge : features.edges) {
    EXPECT_GT(std::abs(edge.y), 3.0F);
  }
}

TEST(FeatureExtraction, WallsArePlanesWhereNineInTenReturnsAreMissing)
{
  const Room room = emptyRoom();
  const auto cloud = scanOf(room);
  std::mt19937 random(1);
  auto sparse = pcl::make_shared<pcl::PointCloud<PointXYZIRT>>();
  for (const PointXYZIRT& point : *cloud) {
    if (random() % 10 == 0) {
      sparse->push_back(point);
    }
  }
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(sparse);
  ASSERT_TRUE(extraction.extract(features));
  EXPECT_GT(features.planes.size(), sparse->size() / 2);
  for (const Feature& plane : features.planes) {
    EXPECT_LT(distancesFromWalls(room, plane.x, plane.y).first, 1e-4);
  }
}

TEST(FeatureExtraction, NothingOutOfRangeIsAFeature)
{
  FeatureParameters parameters;
  parameters.min_range = 6.0F;
  parameters.max_range = 12.0F;
  Extraction extraction;
  extraction.setParameters(parameters);
  extraction.setInputCloud(scanOf(Room()));
  FeatureSet features;
  ASSERT_TRUE(extraction.extract(features));
  EXPECT_GT(features.planes.size(), 100U);
  for (const auto* set : {&features.edges, &features.planes}) {
    for (const Feature& f : *set) {
      const float range = std::sqrt(f.x * f.x + f.y * f.y + f.z * f.z);
      EXPECT_GE(range, 6.0F);
      EXPECT_LE(range, 12.0F);
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
