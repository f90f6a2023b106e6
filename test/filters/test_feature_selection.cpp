// Which of the points that could be features become ones.
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/core/feature_kind.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;

/// The features of each scan line, in their order.
std::map<int, std::vector<Feature>> byLine(const Cloud& cloud, const std::vector<Feature>& features)
{
  std::map<int, std::vector<Feature>> lines;
  for (const Feature& feature : features) {
    lines[cloud[static_cast<std::size_t>(feature.index)].ring].push_back(feature);
  }
  return lines;
}

/// Of each line those that are chosen where each sector may have one, and all that could have been, sector by sector.
struct Choice {
  std::map<int, std::vector<Feature>> best;
  std::map<int, std::vector<Feature>> all;
};

Choice choiceOf(FeatureKind kind)
{
  const Cloud cloud = toCloud(sweepRoom(Room(), Lidar()));
  FeatureParameters parameters;
  const auto chosen = [&](int edges, int planes) {
    parameters.edges_per_sector = edges;
    parameters.planes_per_sector = planes;
    const FeatureSet features = featuresOf(cloud, parameters);
    return byLine(cloud, kind == FeatureKind::edge ? features.edges : features.planes);
  };
  return kind == FeatureKind::edge ? Choice{chosen(1, 0), chosen(100, 0)} : Choice{chosen(0, 1), chosen(0, 1000)};
}

TEST(FeatureSelection, AnEdgeIsTheSharpestOfItsSector)
{
  const Choice choice = choiceOf(FeatureKind::edge);
  ASSERT_GT(choice.all.size(), 20U);
  for (const auto& [line, all] : choice.all) {
    const std::vector<Feature>& best = choice.best.at(line);
    EXPECT_LE(best.size(), 6U);
    std::size_t sectors = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (sectors < best.size() && all[i].index == best[sectors].index) {
        ++sectors;
      } else {
        ASSERT_GT(sectors, 0U) << "line " << line;
        EXPECT_LE(all[i].smoothness, all[i - 1].smoothness) << "line " << line;
      }
    }
    EXPECT_EQ(sectors, best.size()) << "line " << line;
  }
}

TEST(FeatureSelection, APlaneIsTheSmoothestOfItsCell)
{
  const Choice choice = choiceOf(FeatureKind::plane);
  ASSERT_GT(choice.all.size(), 20U);
  for (const auto& [line, all] : choice.all) {
    const std::vector<Feature>& best = choice.best.at(line);
    EXPECT_LE(best.size(), 6U);
    std::size_t sector = 0;
    for (const Feature& plane : all) {
      const float next = best[std::min(sector, best.size() - 1)].smoothness;
      const float before = sector > 0 ? best[sector - 1].smoothness : next;
      EXPECT_GE(plane.smoothness, std::min(before, next)) << "line " << line;
      sector += sector < best.size() && plane.index == best[sector].index ? 1U : 0U;
    }
    EXPECT_EQ(sector, best.size()) << "line " << line;
  }
}

TEST(FeatureSelection, NoiseMakesNoEdges)
{
  Room empty;
  empty.furniture.clear();
  const auto edgesWith = [&](float noise) {
    Cloud cloud = toCloud(sweepRoom(empty, Lidar()));
    std::mt19937 random(1);
    std::normal_distribution<float> error(0.0F, noise);
    for (auto& point : cloud) {
      point.getVector3fMap() *= 1.0F + error(random) / point.getVector3fMap().norm();
    }
    return featuresOf(cloud).edges.size();
  };
  EXPECT_LT(edgesWith(0.05F), 2 * edgesWith(0.001F));  // m
}

TEST(FeatureSelection, MissingReturnsMakeNoEdges)
{
  Room walls;
  walls.walls = {{-30.0, -2.0, -100.0}, {30.0, 2.0, 100.0}};
  walls.furniture.clear();
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0.0F, 0.02F);  // m
  std::bernoulli_distribution lost(0.3);
  const Cloud whole = toCloud(sweepRoom(walls, Lidar()));
  Cloud rest;
  for (auto point : whole) {
    point.getVector3fMap() *= 1.0F + noise(random) / point.getVector3fMap().norm();
    if (!lost(random)) {
      rest.push_back(point);
    }
  }
  std::size_t on_walls = 0;
  for (const Feature& edge : featuresOf(rest).edges) {
    on_walls += std::abs(edge.x) < 28.0F ? 1U : 0U;  // not in the corners
  }
  EXPECT_LE(on_walls, 40U);  // 99 if an edge may lie along its line
}

TEST(FeatureSelection, NothingSeenAtGrazingIncidenceIsAFeature)
{
  Room corridor;
  corridor.walls = {{-30.0, -2.0, -100.0}, {30.0, 2.0, 100.0}};
  corridor.furniture.clear();
  const FeatureSet features = featuresOf(toCloud(sweepRoom(corridor, Lidar())));
  EXPECT_GT(features.planes.size(), 200U);
  for (const Feature& plane : features.planes) {
    // Two points of 900 a turn are 0.0141 of the range apart on a surface seen at 30 degrees.
    const double distance = std::abs(plane.y) > 1.999F ? 2.0 : 30.0;  // of the wall
    EXPECT_GT(distance / std::hypot(plane.x, plane.y), 0.45) << plane.x << ' ' << plane.y;
  }
}

/// Two walls that meet 30 m ahead; each is turned by \p bend degrees from facing the sensor.
Cloud bentWall(double bend)
{
  const double turned = bend * kPi / 180.0;
  Cloud cloud;
  for (int ring = 0; ring < 8; ++ring) {
    for (int column = 0; column < 200; ++column) {
      const double azimuth = (100.3 - column) * 0.4 * kPi / 180.0;
      const double range = 30.0 * std::cos(turned) / std::cos(std::abs(azimuth) - turned);
      cloud.push_back(PointXYZIRT(static_cast<float>(range * std::cos(azimuth)),
                                  static_cast<float>(range * std::sin(azimuth)), 0.5F * static_cast<float>(ring), 1.0F,
                                  static_cast<std::uint16_t>(ring), 5e-4F * static_cast<float>(column)));
    }
  }
  return cloud;
}

TEST(FeatureSelection, AGentleBendIsNoEdgeHoweverFarApartThePointsAre)
{
  FeatureParameters any_bend;
  any_bend.smoothness = SmoothnessKind::mean_of_norms;
  EXPECT_GE(featuresOf(bentWall(15.0), any_bend).edges.size(), 8U);  // rough enough, for how far away it is
  EXPECT_TRUE(featuresOf(bentWall(15.0)).edges.empty());
  EXPECT_GE(featuresOf(bentWall(45.0)).edges.size(), 8U);
}

}  // namespace
}  // namespace pcl_floam::test
