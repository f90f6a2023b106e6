// The search tree against looking at every point.
#include "registration/point_tree.h"

#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace pcl_floam::test {
namespace {

std::vector<Eigen::Vector3f> randomPoints(unsigned seed, int count, double flatness)
{
  std::mt19937 random(seed);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(static_cast<float>(uniform(random, 1.0)), static_cast<float>(uniform(random, 1.0)),
                        static_cast<float>(uniform(random, flatness)));
  }
  return points;
}

std::vector<float> sortedDistances(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& query)
{
  std::vector<float> distances;
  for (const Eigen::Vector3f& point : points) {
    distances.push_back(squaredDistance(point, query));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

std::vector<float> distancesOf(const NearestPoints& nearest)
{
  std::vector<float> distances;
  for (int i = 0; i < nearest.count(); ++i) {
    distances.push_back(nearest.squaredDistance(i));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

/// The places of the neighbours, in an order that depends on them alone.
std::vector<std::array<float, 3>> placesOf(const PointTree& tree, const NearestPoints& nearest)
{
  std::vector<std::array<float, 3>> places;
  for (int i = 0; i < nearest.count(); ++i) {
    const Eigen::Vector3f& point = tree.points()[static_cast<std::size_t>(nearest.index(i))];
    places.push_back({point.x(), point.y(), point.z()});
  }
  std::sort(places.begin(), places.end());
  return places;
}

TEST(PointTree, FindsWhatLookingAtAllPointsFinds)
{
  for (const double flatness : {1.0, 0.0}) {
    const auto points = randomPoints(1, 2000, flatness);
    const PointTree tree(points);
    for (const Eigen::Vector3f& query : randomPoints(2, 300, 2.0)) {
      const std::vector<float> expected = sortedDistances(points, query);
      float squared = std::numeric_limits<float>::max();
      const int found = tree.nearest(query, squared);
      ASSERT_GE(found, 0);
      EXPECT_EQ(squared, expected[0]);
      EXPECT_EQ(squaredDistance(tree.points()[static_cast<std::size_t>(found)], query), expected[0]);
      NearestPoints nearest;
      tree.nearest(query, 14, nearest);
      ASSERT_EQ(nearest.count(), 14);
      EXPECT_EQ(distancesOf(nearest), std::vector<float>(expected.begin(), expected.begin() + 14));
      EXPECT_EQ(nearest.squaredDistance(13), expected[13]);
    }
  }
}

TEST(PointTree, NoOtherPointIsWithinTheClearDistance)
{
  const auto points = randomPoints(4, 2000, 0.3);
  const PointTree tree(points);
  double share = 0.0;
  for (const Eigen::Vector3f& query : randomPoints(5, 300, 0.5)) {
    const std::vector<float> expected = sortedDistances(points, query);
    float limit = std::numeric_limits<float>::max();
    float clear = 0.0F;
    ASSERT_GE(tree.nearest(query, limit, clear), 0);
    EXPECT_LE(clear, expected[1]);
    EXPECT_GE(clear, expected[0]);
    share += static_cast<double>((clear - expected[0]) / (expected[1] - expected[0])) / 300.0;

    limit = 0.9F * expected[0];
    EXPECT_EQ(tree.nearest(query, limit, clear), -1);
    EXPECT_LE(clear, expected[0]);
    EXPECT_GE(clear, 0.9F * expected[0]);
  }
  EXPECT_GT(share, 0.3);  // of what there is to gain
}

TEST(PointTree, TheLimitIsIncluded)
{
  const PointTree tree({{1.0F, 0.0F, 0.0F}});
  float limit = 1.0F;
  EXPECT_EQ(tree.nearest({0.0F, 0.0F, 0.0F}, limit), 0);
  limit = 0.999F;
  EXPECT_EQ(tree.nearest({0.0F, 0.0F, 0.0F}, limit), -1);
}

TEST(PointTree, OrderTellsWhereAPointCameFrom)
{
  const auto points = randomPoints(3, 500, 1.0);
  const PointTree tree(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(tree.points()[i], points[static_cast<std::size_t>(tree.order()[i])]);
  }
}

TEST(PointTree, TiesDoNotDependOnTheOrderOfThePoints)
{
  std::vector<Eigen::Vector3f> grid;
  for (int i = 0; i < 1000; ++i) {
    grid.emplace_back(static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100));
  }
  auto shuffled = grid;
  std::reverse(shuffled.begin(), shuffled.end());
  std::swap_ranges(shuffled.begin(), shuffled.begin() + 300, shuffled.begin() + 500);
  const PointTree tree(grid);
  const PointTree other(shuffled);
  for (const Eigen::Vector3f& query : grid) {
    NearestPoints a;
    NearestPoints b;
    tree.nearest(query, 10, a);
    other.nearest(query, 10, b);
    EXPECT_EQ(placesOf(tree, a), placesOf(other, b));
  }
}

TEST(PointTree, EqualPointsAndNoPoints)
{
  const PointTree equal(std::vector<Eigen::Vector3f>(100, Eigen::Vector3f(1.0F, 2.0F, 3.0F)));
  NearestPoints nearest;
  equal.nearest({0.0F, 0.0F, 0.0F}, 5, nearest);
  EXPECT_EQ(nearest.count(), 5);
  equal.nearest({1.0F, 2.0F, 3.0F}, 5, nearest);
  EXPECT_EQ(nearest.count(), 5);
  const PointTree none;
  float limit = 1.0F;
  EXPECT_EQ(none.nearest({0.0F, 0.0F, 0.0F}, limit), -1);
  none.nearest({0.0F, 0.0F, 0.0F}, 5, nearest);
  EXPECT_EQ(nearest.count(), 0);
}

}  // namespace
}  // namespace pcl_floam::test
