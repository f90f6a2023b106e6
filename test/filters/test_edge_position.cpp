// Where the edge is that a scan line's sharpest point stands for.
#include "filters/fan_of_beams.h"

#include "filters/edge_position.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr float kNoise = 0.1F;

TEST(EdgePosition, APostIsTakenByItsAxisWhicheverOfItsPointsIsAsked)
{
  const Eigen::Vector2d center(10.0, 0.3);
  for (const double radius : {0.04, 0.1, 0.18}) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    constexpr int kPhases = 20;
    for (int i = 0; i < kPhases; ++i) {
      Fan fan;
      fan.phase = static_cast<double>(i) / kPhases;
      const LinePoints line = seenBy(fan, roundPost(center, radius));
      const std::vector<int> seen = foreground(line);
      ASSERT_FALSE(seen.empty());
      const LineEdge edge = locateEdge(line, seen.front(), kNoise);
      EXPECT_EQ(edge.first, seen.front());
      EXPECT_EQ(edge.last, seen.back());
      for (const int n : seen) {
        EXPECT_EQ(locateEdge(line, n, kNoise).position, edge.position);
      }
      EXPECT_NEAR(inPlane(edge.position).y(), center.y(), 0.55 * 0.0035 * center.x()) << "half a beam";
      mean += inPlane(edge.position) / kPhases;
    }
    EXPECT_NEAR(mean.x(), center.x(), 0.35 * radius) << "the nearest point of the surface is a whole radius away; the "
                                                        "same for round and square posts is a compromise";
    EXPECT_NEAR(mean.y(), center.y(), 0.002);
  }
}

TEST(EdgePosition, AThinThingIsInTheSamePlaceFromAllSides)
{
  const double side = 0.12;
  for (const double turn : {0.0, 0.3, 0.6}) {
    double worst = 0.0;
    double raw = 0.0;
    for (int i = 0; i < 36; ++i) {
      const double angle = 2.0 * kPi * i / 36;
      // The post is turned instead of the sensor.
      const Eigen::Vector2d place(8.0, 0.0);
      const LinePoints line = seenBy(Fan(), walls(squarePost(place, side, turn - angle)));
      const std::vector<int> seen = foreground(line);
      const LineEdge edge = locateEdge(line, seen.front(), kNoise);
      worst = std::max(worst, (inPlane(edge.position) - place).norm());
      raw = std::max(raw, (pointAt(line, seen.front()) - place).norm());
    }
    EXPECT_LT(worst, 0.3 * side);
    EXPECT_GT(raw, 0.5 * side) << "the points themselves are half a width away and more";
  }
}

TEST(EdgePosition, ASurfaceEndsHalfAStepBehindItsLastPoint)
{
  // Along it, as the wall of a corridor beside an open door.
  const Eigen::Vector2d end(6.0, 1.2);
  double located = 0.0;
  double last_point = 0.0;
  constexpr int kPhases = 50;
  for (int i = 0; i < kPhases; ++i) {
    Fan fan;
    fan.from = 0.1;
    fan.to = 0.9;
    fan.phase = static_cast<double>(i) / kPhases;
    const LinePoints line = seenBy(fan, walls({{1.0, 1.2}, end}));
    const std::vector<int> seen = foreground(line);
    // The wall is seen from its far end on.
    const LineEdge edge = locateEdge(line, seen.front(), kNoise);
    EXPECT_EQ(edge.middle(), seen.front());
    EXPECT_NEAR(edge.position.y(), 1.2F, 1e-4F) << "it stays on the surface";
    located += (edge.position.x() - end.x()) / kPhases;
    last_point += (pointAt(line, seen.front()).x() - end.x()) / kPhases;
  }
  EXPECT_LT(last_point, -0.04) << "points are short of the end, in the mean by half of 11 cm";
  EXPECT_NEAR(located, 0.0, 0.1 * std::abs(last_point));
}

/// By how much the end of a wall is moved that is the last thing seen on the right, before something far behind.
double moveOfTheEnd(const Fan& fan, const Eigen::Vector2d& from, const Eigen::Vector2d& end)
{
  const LinePoints line = seenBy(fan, walls({from, end}));
  const std::vector<int> seen = foreground(line);
  const LineEdge edge = locateEdge(line, seen.front(), kNoise);
  return (inPlane(edge.position) - pointAt(line, seen.front())).norm();
}

TEST(EdgePosition, TheEndOfAGrazedSurfaceIsMovedLittleThatOfOneAcrossByHalfAStep)
{
  Fan fan;
  fan.from = 0.09;
  fan.to = 0.9;
  EXPECT_NEAR(moveOfTheEnd(fan, {1.0, 1.2}, {10.0, 1.2}), 0.05, 1e-4) << "its points are 0.3 m apart";
  fan.from = 0.0;
  fan.to = 0.2;
  fan.step = 0.006;
  EXPECT_NEAR(moveOfTheEnd(fan, {25.0, 3.0}, {25.0, 1.0}), 0.5 * 0.006 * 25.0, 1e-3) << "more than those 5 cm";
}

TEST(EdgePosition, ACornerIsWhereTwoSurfacesMeet)
{
  const Eigen::Vector2d corner(5.0, 0.2);
  for (const double opening : {1.2, 1.57, 2.0}) {
    for (int i = 0; i < 10; ++i) {
      Fan fan;
      fan.phase = 0.1 * i;
      const Eigen::Vector2d other = corner + 2.0 * Eigen::Vector2d(std::sin(0.7 + opening), std::cos(0.7 + opening));
      const LinePoints line =
          seenBy(fan, walls({corner + 2.0 * Eigen::Vector2d(std::sin(0.7), std::cos(0.7)), corner, other}));
      int nearest = 0;
      for (int n = 0; n < line.size(); ++n) {
        if ((pointAt(line, n) - corner).norm() < (pointAt(line, nearest) - corner).norm()) {
          nearest = n;
        }
      }
      EXPECT_GT((pointAt(line, nearest) - corner).norm(), 1e-4);
      EXPECT_LT((inPlane(locateEdge(line, nearest, kNoise).position) - corner).norm(), 1e-4);
    }
  }
}

TEST(EdgePosition, AStraightWallIsLeftAsItIs)
{
  const LinePoints line = seenBy(Fan(), walls({{6.0, -3.0}, {8.0, 3.0}}));
  for (int n = 1; n + 1 < line.size(); ++n) {
    EXPECT_EQ(inPlane(locateEdge(line, n, kNoise).position), pointAt(line, n));
  }
}

TEST(EdgePosition, WhatIsPartlyHiddenIsNotTakenForThin)
{
  // A wide box behind the edge of a nearer one: only 20 cm of it show.
  const LinePoints line = seenBy(Fan(), [](const Eigen::Vector2d& origin, const Eigen::Vector2d& ray) {
    return std::optional<double>(std::min({background(origin, ray), toSegment(origin, ray, {4.0, -1.0}, {4.0, 0.0}),
                                           toSegment(origin, ray, {8.0, -2.0}, {8.0, 0.2})}));
  });
  int last = 0;
  for (int n = 0; n < line.size(); ++n) {
    last = std::abs(line.x[static_cast<std::size_t>(n)] - 8.0F) < 0.1F ? n : last;
  }
  const LineEdge edge = locateEdge(line, last, kNoise);
  EXPECT_EQ(edge.first, last);
  EXPECT_NEAR(edge.position.x(), 8.0F, 1e-4F) << "not behind the surface";
  EXPECT_NEAR(edge.position.y(), 0.2F, 0.5F * 0.0035F * 8.0F);
}

TEST(EdgePosition, APostBeforeTheSkyIsTakenByItsAxisUnlessOneBeamAloneHitIt)
{
  const Eigen::Vector2d center(10.0, 0.0);
  const auto lineWith = [&](double radius, float beside) {
    Fan fan;
    fan.phase = 0.5;
    LinePoints line = seenBy(fan, roundPost(center, radius, false));
    // What else the scan line sees is far to the sides, nearer or farther.
    line.x.insert(line.x.begin(), beside);
    line.y.insert(line.y.begin(), -0.5F * beside);
    line.z.insert(line.z.begin(), 0.0F);
    line.x.push_back(beside);
    line.y.push_back(0.5F * beside);
    line.z.push_back(0.0F);
    line.measure();
    return line;
  };
  for (const float beside : {5.0F, 15.0F}) {
    const LinePoints several = lineWith(0.1, beside);
    ASSERT_GT(several.size(), 4);
    EXPECT_LT((inPlane(locateEdge(several, 1, kNoise).position) - center).norm(), 0.06);
    const LinePoints one = lineWith(0.02, beside);
    ASSERT_EQ(one.size(), 3);
    EXPECT_EQ(inPlane(locateEdge(one, 1, kNoise).position), pointAt(one, 1));
  }
}

TEST(EdgePosition, PointsInOnePlaceTellNoDirection)
{
  LinePoints line;
  for (const float y : {-0.2F, -0.15F, -0.1F, -0.05F, 0.0F, 0.05F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F}) {
    line.x.push_back(5.0F);
    line.y.push_back(y);
    line.z.push_back(0.0F);
  }
  line.measure();
  for (int n = 1; n + 1 < line.size(); ++n) {
    EXPECT_EQ(inPlane(locateEdge(line, n, kNoise).position), pointAt(line, n)) << n;
  }
}

TEST(EdgePosition, NothingIsMovedFar)
{
  // The corner of a house so far away that its points are half a metre apart.
  double farthest = 0.0;
  for (int i = 0; i < 20; ++i) {
    Fan fan;
    fan.phase = 0.05 * i;
    const LinePoints line = seenBy(fan, [](const Eigen::Vector2d& origin, const Eigen::Vector2d& ray) {
      return std::optional<double>(std::min(toSegment(origin, ray, {100.0, 0.0}, {140.0, 40.0}),
                                            toSegment(origin, ray, {100.0, 0.0}, {140.0, -40.0})));
    });
    for (int n = 1; n + 1 < line.size(); ++n) {
      farthest = std::max(farthest, (inPlane(locateEdge(line, n, kNoise).position) - pointAt(line, n)).norm());
    }
  }
  EXPECT_LE(farthest, 0.4 + 1e-4);
}

TEST(EdgePosition, TheEndsOfAScanLineAreRespected)
{
  for (int count = 3; count < 6; ++count) {
    LinePoints line;
    for (int n = 0; n < count; ++n) {
      line.x.push_back(5.0F);
      line.y.push_back(0.02F * static_cast<float>(n));
      line.z.push_back(0.0F);
    }
    line.measure();
    for (int n = 1; n + 1 < count; ++n) {
      const LineEdge edge = locateEdge(line, n, kNoise);
      EXPECT_EQ(inPlane(edge.position), pointAt(line, n));
      EXPECT_EQ(edge.middle(), n);
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
