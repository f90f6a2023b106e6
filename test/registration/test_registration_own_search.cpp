// A search of the user's own, of any kind, finds what the library's finds.
#include "support/object_pair.h"

#include <pcl_floam/map/map_search.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace pcl_floam::test {
namespace {

/// Positions, and a fourth number that all points share.
class WithIntensity : public pcl::PointRepresentation<Point> {
public:
  WithIntensity() { nr_dimensions_ = 4; }
  void copyToFloatArray(const Point& point, float* out) const override
  {
    std::copy_n(point.data, 3, out);
    out[3] = point.intensity;
  }
};

/// A class that the library does not know.
class OwnTree : public pcl::search::KdTree<Point> {};

/// Without the tree of its base, as PCL 1.15's KdTreeNanoflann.
class TreelessSearch : public pcl::search::KdTree<Point> {
  using Base = pcl::search::KdTree<Point>;
  using Done = decltype(std::declval<Base&>().setInputCloud(Cloud::ConstPtr(), pcl::IndicesConstPtr()));

public:
  using Base::nearestKSearch;
  TreelessSearch() { tree_.reset(); }
  Done setInputCloud(const Cloud::ConstPtr& cloud, const pcl::IndicesConstPtr& indices) override
  {
    input_ = cloud;
    return other_.setInputCloud(cloud, indices);
  }
  int nearestKSearch(const Point& point, int k, pcl::Indices& indices, std::vector<float>& squared) const override
  {
    return other_.nearestKSearch(point, k, indices, squared);
  }

private:
  Base other_;
};

/// Gives a registration a search of the user's own that finds the nearest points.
using SetsSearch = void (*)(EdgePlaneRegistration<Point, Point>&, const Cloud::Ptr& target);

void setFixedTree(EdgePlaneRegistration<Point, Point>& registration, const Cloud::Ptr& target)
{
  auto tree = pcl::make_shared<pcl::search::KdTree<Point>>();
  tree->setInputCloud(target);
  registration.setSearchMethodTarget(tree, true);
}

void setRepresentation(EdgePlaneRegistration<Point, Point>& registration, const Cloud::Ptr&)
{
  registration.setPointRepresentation(pcl::make_shared<const WithIntensity>());
}

void setOwnTree(EdgePlaneRegistration<Point, Point>& registration, const Cloud::Ptr&)
{
  registration.setSearchMethodTarget(pcl::make_shared<OwnTree>());
}

void setTreelessSearch(EdgePlaneRegistration<Point, Point>& registration, const Cloud::Ptr&)
{
  registration.setSearchMethodTarget(pcl::make_shared<TreelessSearch>());
}

void setMapSearch(EdgePlaneRegistration<Point, Point>& registration, const Cloud::Ptr&)
{
  registration.setSearchMethodTarget(pcl::make_shared<MapSearch<Point>>());
}

class SearchOfTheUsersOwn : public ::testing::TestWithParam<SetsSearch> {};

TEST_P(SearchOfTheUsersOwn, FindsACloudThatWasMovedByACentimetre)
{
  std::mt19937 random(7);
  const auto target = pcl::make_shared<Cloud>();
  for (int i = 0; i < 2000; ++i) {
    Point point;
    point.getVector3fMap() =
        (farOff() + Eigen::Vector3d(5.0 + uniform(random, 1.0), uniform(random, 1.0), uniform(random, 1.0)))
            .cast<float>();
    target->push_back(point);
  }
  const auto source = pcl::make_shared<Cloud>(*target);
  for (Point& point : *source) {
    point.x += 0.01F;
  }
  EdgePlaneRegistration<Point, Point> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  GetParam()(registration, target);
  Cloud output;
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_NEAR(registration.getFinalTransformation()(0, 3), -0.0100F, 1e-4F);
  EXPECT_LT(disagreement(*source, registration.getFinalTransformation(),
                         Eigen::Affine3f(Eigen::Translation3f(-0.01F, 0.0F, 0.0F)).matrix()),
            1e-4);
}

TEST_P(SearchOfTheUsersOwn, FindsAnObject)
{
  ObjectPair setup;
  for (const auto& cloud : {setup.source, setup.target}) {
    for (Point& point : *cloud) {
      point.intensity = 0.0F;
    }
  }
  GetParam()(setup.registration, setup.target);
  EXPECT_LT(setup.align(), 0.005);
  EXPECT_TRUE(setup.registration.hasConverged());
}

INSTANTIATE_TEST_SUITE_P(EachKind, SearchOfTheUsersOwn,
                         ::testing::Values(&setFixedTree, &setRepresentation, &setOwnTree, &setTreelessSearch,
                                           &setMapSearch));

}  // namespace
}  // namespace pcl_floam::test
