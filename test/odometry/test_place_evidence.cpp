// Motions judged by places: neighbours are one witness, however many points they are.
#include "odometry/place_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace pcl_floam {
namespace {

constexpr double kFinest = 0.5;  // m, of the map's finest cells

ScanPoint pointAt(double x, double y)
{
  ScanPoint point;
  point.x = static_cast<float>(x);
  point.y = static_cast<float>(y);
  return point;
}

/// A car beside the sensor, of which there are very many points, and a road of which there are a few everywhere.
struct Scene {
  std::vector<ScanPoint> points;
  std::vector<float> by_car, by_road;  // evidence of its points where the pose goes along with one of them

  Scene()
  {
    for (int i = 0; i < 4000; ++i) {
      add(4.0 + 0.001 * i, 2.1 + 0.0001 * i, 0.1F, -0.2F);
    }
    for (int i = 0; i < 200; ++i) {
      add(0.7 * (i - 100), i % 2 == 0 ? -8.0 : 12.0, 0.02F, 0.1F);
    }
  }

  void add(double x, double y, float with_car, float with_road)
  {
    points.push_back(pointAt(x, y));
    by_car.push_back(with_car);
    by_road.push_back(with_road);
  }

  [[nodiscard]] std::vector<float> of(const std::vector<float>& evidence) const
  {
    return evidenceByPlace(evidence, placesOf(points, kFinest));
  }
};

TEST(PlaceEvidence, NeighboursAreOfOnePlaceAndFarOnesOfOthers)
{
  std::vector<ScanPoint> line;
  for (int i = 0; i < 1000; ++i) {
    line.push_back(pointAt(0.1 * i, 0.3));
  }
  const std::vector<std::uint32_t> places = placesOf(line, kFinest);
  ASSERT_EQ(places.size(), line.size());
  EXPECT_EQ(std::set<std::uint32_t>(places.begin(), places.end()).size(), 50U);  // of 2 m each
  EXPECT_EQ(*std::max_element(places.begin(), places.end()), 49U);
}

TEST(PlaceEvidence, NoEvidenceIsLost)
{
  const Scene scene;
  double of_points = 0.0;
  double of_places = 0.0;
  for (const float evidence : scene.by_car) {
    of_points += static_cast<double>(evidence);
  }
  for (const float evidence : scene.of(scene.by_car)) {
    of_places += static_cast<double>(evidence);
  }
  EXPECT_NEAR(of_places, of_points, 1e-3 * of_points);
}

TEST(PlaceEvidence, TheRoadOutvotesACarOfManyMorePoints)
{
  const Scene scene;
  PlaceVotes against_car;
  against_car.add(scene.of(scene.by_car), scene.of(scene.by_road));
  EXPECT_TRUE(against_car.areSurelyAgainst());
  PlaceVotes against_road;
  against_road.add(scene.of(scene.by_road), scene.of(scene.by_car));
  EXPECT_FALSE(against_road.areSurelyAgainst());
}

/// What one sweep does not tell surely, no number of sweeps that see the same does.
TEST(PlaceEvidence, SweepsThatSeeTheSameTellNoMoreThanOne)
{
  constexpr std::size_t kPlaces = 100;
  const std::vector<float> even(kPlaces, 0.5F);
  std::vector<float> others(kPlaces, -1.0F);
  const auto isSure = [&](std::size_t better, int sweeps) {
    std::fill(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(better), 1.0F);
    PlaceVotes votes;
    for (int i = 0; i < sweeps; ++i) {
      votes.add(even, others);
    }
    return votes.areSurelyAgainst();
  };
  for (const int sweeps : {1, 10, 1000}) {
    EXPECT_FALSE(isSure(69, sweeps)) << sweeps;  // a lead of 38: less than four roots of a hundred
    EXPECT_TRUE(isSure(71, sweeps)) << sweeps;
    std::fill(others.begin(), others.end(), -1.0F);
  }
}

/// A sensor that has moved less has seen less, and its map would lose for that alone.
TEST(PlaceEvidence, WhereOneMapKnowsNothingThereIsNoVote)
{
  const std::vector<float> nothing(1000, 0.0F);
  const std::vector<float> something(1000, 0.3F);
  const std::vector<float> contradicted(1000, -0.3F);
  PlaceVotes votes;
  votes.add(nothing, something);
  votes.add(contradicted, nothing);
  EXPECT_FALSE(votes.areSurelyAgainst());
  votes.add(contradicted, something);
  EXPECT_TRUE(votes.areSurelyAgainst());
}

TEST(PlaceEvidence, WhatBothExplainAlikeDoesNotVote)
{
  const std::vector<float> same(1000, 0.3F);
  PlaceVotes votes;
  votes.add(same, same);
  votes.add({}, {});
  EXPECT_FALSE(votes.areSurelyAgainst());
}

}  // namespace
}  // namespace pcl_floam
