// Edges at the corners of a room, planes on its walls; and a filter as PCL's filters are.
// PointXYZIRT is no type of PCL's own.
#define PCL_NO_PRECOMPILE
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/feature_extraction.h>

#include <pcl/filters/passthrough.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;
using Extraction = FeatureExtraction<PointXYZIRT>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// An empty room, so that the only edges are its four vertical ones (the horizontal ones are crossed at an angle by
/// scan lines that are not level).
Room emptyRoom()
{
  Room room;
  room.walls = {{-6.0, -4.0, -30.0}, {5.0, 5.0, 30.0}};
  room.furniture.clear();
  return room;
}

Cloud::Ptr scanOf(const Room& room)
{
  return pcl::make_shared<Cloud>(toCloud(sweepRoom(room, Lidar())));
}

/// Distances of a point from the nearest walls: the first is how far off the walls, the second how far off a corner.
std::pair<double, double> distancesFromWalls(const Room& room, double x, double y)
{
  const double to_x = std::min(std::abs(x - room.walls.lowest[0]), std::abs(x - room.walls.highest[0]));
  const double to_y = std::min(std::abs(y - room.walls.lowest[1]), std::abs(y - room.walls.highest[1]));
  return {std::min(to_x, to_y), std::max(to_x, to_y)};
}

pcl::Indices filtered(Extraction& extraction, const Cloud::ConstPtr& cloud, FeatureKind kind)
{
  pcl::Indices indices;
  extraction.setFeatureKind(kind);
  extraction.setInputCloud(cloud);
  extraction.filter(indices);
  return indices;
}

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
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(scanOf(room));
  ASSERT_TRUE(extraction.extract(features));
  EXPECT_GT(features.planes.size(), 2000U);
  for (const Feature& plane : features.planes) {
    const auto [off_wall, off_corner] = distancesFromWalls(room, plane.x, plane.y);
    EXPECT_LT(off_wall, 1e-4);
    EXPECT_GT(off_corner, 0.05);
    EXPECT_LT(plane.smoothness, extraction.getParameters().plane_threshold);
  }
}

TEST(FeatureExtraction, FeaturesAreTheCloudsPoints)
{
  const auto cloud = scanOf(Room());
  FeatureSet features;
  Extraction extraction;
  extraction.setInputCloud(cloud);
  ASSERT_TRUE(extraction.extract(features));
  std::set<std::int32_t> seen;
  for (const auto* set : {&features.edges, &features.planes}) {
    for (const Feature& feature : *set) {
      const PointXYZIRT& point = (*cloud)[static_cast<std::size_t>(feature.index)];
      EXPECT_EQ(feature.x, point.x);
      EXPECT_EQ(feature.y, point.y);
      EXPECT_EQ(feature.z, point.z);
      EXPECT_NEAR(feature.time, point.time / 0.1F, 1e-5F);
      EXPECT_TRUE(seen.insert(feature.index).second) << "both edge and plane, or twice";
    }
  }
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

TEST(FeatureExtraction, NegativeIsTheComplementAmongFinitePoints)
{
  const auto cloud = scanOf(Room());
  for (std::size_t i = 100; i < cloud->size(); i += 1000) {
    (*cloud)[i].x = kNan;
  }
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    Extraction extraction(true);
    const pcl::Indices selected = filtered(extraction, cloud, kind);
    const pcl::Indices removed = *extraction.getRemovedIndices();
    extraction.setNegative(true);
    const pcl::Indices negative = filtered(extraction, cloud, kind);
    EXPECT_FALSE(selected.empty());
    std::set<int> all(selected.begin(), selected.end());
    all.insert(negative.begin(), negative.end());
    EXPECT_EQ(all.size(), selected.size() + negative.size());
    std::size_t finite = 0;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const bool is_finite = pcl::isFinite((*cloud)[i]);
      finite += is_finite ? 1U : 0U;
      EXPECT_EQ(all.count(static_cast<int>(i)) != 0, is_finite);
    }
    EXPECT_EQ(all.size(), finite);
    EXPECT_EQ(removed.size(), cloud->size() - selected.size());  // with those that are not finite
  }
}

TEST(FeatureExtraction, HonoursIndicesInTheirOrder)
{
  const auto cloud = scanOf(Room());
  Extraction extraction;
  auto asked = pcl::make_shared<pcl::Indices>();
  for (int i = static_cast<int>(cloud->size()) - 1; i >= 0; i -= 2) {
    asked->push_back(i);
  }
  const pcl::Indices before = *asked;
  extraction.setIndices(asked);
  const pcl::Indices among = filtered(extraction, cloud, FeatureKind::plane);
  EXPECT_EQ(*asked, before);
  EXPECT_FALSE(among.empty());
  EXPECT_TRUE(std::is_sorted(among.rbegin(), among.rend()));
  EXPECT_TRUE(std::all_of(among.begin(), among.end(), [](int index) { return index % 2 == 1; }));

  extraction.filter(*asked);  // into the very vector that was set
  EXPECT_EQ(*asked, among);
}

TEST(FeatureExtraction, ACutByIndicesIsNoEdge)
{
  const Room room = emptyRoom();
  const auto cloud = scanOf(room);
  auto half = pcl::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    if ((*cloud)[i].y > 1.0F) {
      half->push_back(static_cast<int>(i));
    }
  }
  Extraction extraction;
  extraction.setIndices(half);
  const pcl::Indices edges = filtered(extraction, cloud, FeatureKind::edge);
  EXPECT_FALSE(edges.empty());
  for (const int index : edges) {
    const PointXYZIRT& point = (*cloud)[static_cast<std::size_t>(index)];
    EXPECT_LT(distancesFromWalls(room, point.x, point.y).second, 0.1);
  }
}

TEST(FeatureExtraction, KeepsTheCloudOrganised)
{
  const auto cloud = scanOf(Room());
  cloud->width = 32;
  cloud->height = 900;
  Extraction extraction;
  const pcl::Indices edges = filtered(extraction, cloud, FeatureKind::edge);
  extraction.setKeepOrganized(true);
  Cloud output;
  extraction.filter(output);
  ASSERT_EQ(output.size(), cloud->size());
  EXPECT_EQ(output.width, 32U);
  EXPECT_EQ(output.height, 900U);
  std::size_t kept = 0;
  for (const PointXYZIRT& point : output) {
    kept += pcl::isFinite(point) ? 1U : 0U;
  }
  EXPECT_EQ(kept, edges.size());
}

TEST(FeatureExtraction, ChainsWithPclsFiltersByTheirBase)
{
  const auto cloud = scanOf(Room());
  auto pass = pcl::make_shared<pcl::PassThrough<PointXYZIRT>>();
  pass->setFilterFieldName("z");
  pass->setFilterLimits(-1.0F, 10.0F);
  const std::vector<pcl::Filter<PointXYZIRT>::Ptr> chain = {pass, pcl::make_shared<Extraction>()};
  Cloud::Ptr current = cloud;
  for (const auto& filter : chain) {
    auto next = pcl::make_shared<Cloud>();
    filter->setInputCloud(current);
    filter->filter(*next);
    current = next;
  }
  EXPECT_GT(current->size(), 10U);
  EXPECT_LT(current->size(), cloud->size() / 10);
}

TEST(FeatureExtraction, RemembersNothingBetweenCalls)
{
  Extraction used;
  filtered(used, scanOf(Room()), FeatureKind::plane);
  Extraction fresh;
  const auto cloud = scanOf(emptyRoom());
  EXPECT_EQ(filtered(used, cloud, FeatureKind::edge), filtered(fresh, cloud, FeatureKind::edge));
}

TEST(FeatureExtraction, NoScanLinesNoFeatures)
{
  const auto cloud = pcl::make_shared<Cloud>();
  FeatureSet features;
  Extraction extraction;
  EXPECT_FALSE(extraction.extract(features));  // no input at all
  extraction.setInputCloud(cloud);
  EXPECT_FALSE(extraction.extract(features));
  EXPECT_EQ(extraction.getScanLines().failure, ScanLineFailure::empty_cloud);
  FeatureParameters parameters;
  parameters.sectors = 0;
  EXPECT_THROW(extraction.setParameters(parameters), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam::test
