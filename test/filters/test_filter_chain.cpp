// This library's filters among PCL's, through their common bases, on clouds and on indices.
// PointXYZIRT is no type of PCL's own.
#define PCL_NO_PRECOMPILE
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/feature_extraction.h>
#include <pcl_floam/filters/motion_compensation.h>

#include <pcl/filters/crop_box.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;
using Filter = pcl::Filter<PointXYZIRT>;
using IndexFilter = pcl::FilterIndices<PointXYZIRT>;

const Vector6 kChainTwist = (Vector6() << 0.3, 0.05, 0.0, 0.0, 0.0, 0.02).finished();

/// A scan whose intensity is the number of the point, so that each can be found again.
Cloud::Ptr numberedScan()
{
  auto scan = scanOf(Room());
  for (std::size_t i = 0; i < scan->size(); ++i) {
    (*scan)[i].intensity = static_cast<float>(i);  // below 2^24: exact
  }
  return scan;
}

IndexFilter::Ptr nearSlice()
{
  auto pass = pcl::make_shared<pcl::PassThrough<PointXYZIRT>>();
  pass->setFilterFieldName("z");
  pass->setFilterLimits(-1.2F, 10.0F);
  return pass;
}

IndexFilter::Ptr withoutRobot()
{
  auto box = pcl::make_shared<pcl::CropBox<PointXYZIRT>>();
  box->setMin({-4.0F, -4.0F, -2.0F, 1.0F});
  box->setMax({4.0F, 4.0F, 1.0F, 1.0F});
  box->setNegative(true);
  return box;
}

IndexFilter::Ptr withoutOutliers()
{
  auto outliers = pcl::make_shared<pcl::StatisticalOutlierRemoval<PointXYZIRT>>();
  outliers->setMeanK(8);
  outliers->setStddevMulThresh(3.0);
  return outliers;
}

IndexFilter::Ptr planes()
{
  auto extraction = pcl::make_shared<FeatureExtraction<PointXYZIRT>>();
  extraction->setFeatureKind(FeatureKind::plane);
  return extraction;
}

Filter::Ptr undistorted()
{
  auto compensation = pcl::make_shared<MotionCompensation<PointXYZIRT>>();
  compensation->setTwist(kChainTwist);
  return compensation;
}

Cloud::Ptr throughAll(const std::vector<Filter::Ptr>& chain, Cloud::Ptr cloud)
{
  for (const Filter::Ptr& filter : chain) {
    auto output = pcl::make_shared<Cloud>();
    filter->setInputCloud(cloud);
    filter->filter(*output);
    EXPECT_FALSE(output->empty()) << typeid(*filter).name();
    cloud = output;
  }
  return cloud;
}

void expectTimeAndRingOfOrigin(const Cloud& output, const Cloud& origin)
{
  for (const PointXYZIRT& point : output) {
    const PointXYZIRT& before = origin[static_cast<std::size_t>(point.intensity)];
    ASSERT_EQ(point.time, before.time);
    ASSERT_EQ(point.ring, before.ring);
  }
}

TEST(FilterChain, TimeAndRingSurviveEveryOrder)
{
  const auto scan = numberedScan();
  const std::vector<std::vector<Filter::Ptr>> chains = {
      {nearSlice(), withoutRobot(), undistorted(), withoutOutliers(), planes()},
      {undistorted(), planes(), withoutOutliers(), withoutRobot(), nearSlice()},
      {planes(), undistorted(), nearSlice(), withoutOutliers()}};
  for (const auto& chain : chains) {
    const auto output = throughAll(chain, scan);
    EXPECT_LT(output->size(), scan->size());
    expectTimeAndRingOfOrigin(*output, *scan);
  }
}

TEST(FilterChain, CompensationIsTheSameBeforeAndAfterACut)
{
  const auto scan = numberedScan();
  const auto all = throughAll({undistorted()}, scan);
  const auto cut_first = throughAll({withoutRobot(), nearSlice(), undistorted()}, scan);
  EXPECT_LT(cut_first->size(), all->size());
  for (const PointXYZIRT& point : *cut_first) {
    const PointXYZIRT& same = (*all)[static_cast<std::size_t>(point.intensity)];
    ASSERT_LT((point.getVector3fMap() - same.getVector3fMap()).norm(), 1e-5F);
  }
}

TEST(FilterChain, VoxelGridThinsWhatIsUndistorted)
{
  constexpr float kLeaf = 0.2F;
  auto grid = pcl::make_shared<pcl::VoxelGrid<PointXYZIRT>>();
  grid->setLeafSize(kLeaf, kLeaf, kLeaf);
  const auto scan = numberedScan();
  const auto all = throughAll({undistorted()}, scan);
  const auto thinned = throughAll({undistorted(), grid}, scan);
  EXPECT_LT(thinned->size(), scan->size() / 2);
  for (std::size_t i = 0; i < thinned->size(); i += 50) {
    const Eigen::Vector3f mean = (*thinned)[i].getVector3fMap();
    EXPECT_TRUE(std::any_of(all->begin(), all->end(), [&mean](const PointXYZIRT& point) {
      return (point.getVector3fMap() - mean).norm() < 2.0F * kLeaf;
    }));
  }
}

TEST(FilterChain, OnIndicesEachAmongThoseOfTheOneBefore)
{
  const auto scan = numberedScan();
  auto indices = pcl::make_shared<pcl::Indices>(scan->size());
  for (std::size_t i = 0; i < indices->size(); ++i) {
    (*indices)[i] = static_cast<int>(i);
  }
  for (const IndexFilter::Ptr& filter : {nearSlice(), withoutRobot(), planes(), withoutOutliers()}) {
    auto kept = pcl::make_shared<pcl::Indices>();
    filter->setInputCloud(scan);
    filter->setIndices(indices);
    filter->filter(*kept);
    ASSERT_FALSE(kept->empty());
    EXPECT_LT(kept->size(), indices->size());
    EXPECT_TRUE(std::includes(indices->begin(), indices->end(), kept->begin(), kept->end()));
    indices = kept;
  }
  const auto compensation = undistorted();
  compensation->setInputCloud(scan);
  compensation->setIndices(indices);
  Cloud output;
  compensation->filter(output);
  const auto all = throughAll({undistorted()}, scan);
  ASSERT_EQ(output.size(), indices->size());
  for (std::size_t i = 0; i < output.size(); ++i) {
    const PointXYZIRT& same = (*all)[static_cast<std::size_t>((*indices)[i])];
    EXPECT_EQ(output[i].intensity, same.intensity);
    EXPECT_EQ(output[i].getVector3fMap(), same.getVector3fMap());
  }
  expectTimeAndRingOfOrigin(output, *scan);
}

}  // namespace
}  // namespace pcl_floam::test
