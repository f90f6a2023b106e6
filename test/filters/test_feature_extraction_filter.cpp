// A filter as PCL's filters are.
// PointXYZIRT is no type of PCL's own.
#define PCL_NO_PRECOMPILE
#include "support/constants.h"
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

pcl::Indices filtered(Extraction& extraction, const Cloud::ConstPtr& cloud, FeatureKind kind)
{
  pcl::Indices indices;
  extraction.setFeatureKind(kind);
  extraction.setInputCloud(cloud);
  extraction.filter(indices);
  return indices;
}

TEST(FeatureExtractionFilter, NegativeIsTheComplementAmongFinitePoints)
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

TEST(FeatureExtractionFilter, ScanLinesComeFromWhereItIsTold)
{
  for (const ScanLineSource source : {ScanLineSource::ring_field, ScanLineSource::elevation_clusters}) {
    Extraction extraction;
    extraction.setScanLineSource(source);
    EXPECT_EQ(extraction.getScanLineSource(), source);
    EXPECT_FALSE(filtered(extraction, scanOf(Room()), FeatureKind::edge).empty());
    EXPECT_EQ(extraction.getScanLines().source, source);
  }
}

TEST(FeatureExtractionFilter, SelectsWhatExtractGives)
{
  const auto cloud = scanOf(Room());
  Extraction extraction;
  extraction.setInputCloud(cloud);
  FeatureSet features;
  ASSERT_TRUE(extraction.extract(features));
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    const pcl::Indices selected = filtered(extraction, cloud, kind);
    std::set<int> extracted;
    for (const Feature& feature : kind == FeatureKind::edge ? features.edges : features.planes) {
      extracted.insert(feature.index);
    }
    EXPECT_EQ(std::set<int>(selected.begin(), selected.end()), extracted);
  }
}

TEST(FeatureExtractionFilter, HonoursIndicesInTheirOrder)
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

TEST(FeatureExtractionFilter, ACutByIndicesIsNoEdge)
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

TEST(FeatureExtractionFilter, KeepsTheCloudOrganised)
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

TEST(FeatureExtractionFilter, ChainsWithPclsFiltersByTheirBase)
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

TEST(FeatureExtractionFilter, RemembersNothingBetweenCalls)
{
  Extraction used;
  filtered(used, scanOf(Room()), FeatureKind::plane);
  Extraction fresh;
  const auto cloud = scanOf(emptyRoom());
  EXPECT_EQ(filtered(used, cloud, FeatureKind::edge), filtered(fresh, cloud, FeatureKind::edge));
}

TEST(FeatureExtractionFilter, NoScanLinesNoFeatures)
{
  const auto cloud = pcl::make_shared<Cloud>();
  FeatureSet features;
  Extraction extraction;
  EXPECT_FALSE(extraction.extract(features));  // no input at all
  extraction.setInputCloud(cloud);
  EXPECT_FALSE(extraction.extract(features));
  EXPECT_EQ(extraction.getScanLines().failure, ScanLineFailure::empty_cloud);
  FeatureParameters parameters;
  parameters.edges_per_sector = -1;
  EXPECT_THROW(extraction.setParameters(parameters), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam::test
