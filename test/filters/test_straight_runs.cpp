// How far a scan line goes on straight about a return.
#include "filters/straight_runs.h"
#include "support/constants.h"
#include "support/listed_returns.h"
#include "support/synthetic_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace pcl_floam::test {
namespace {

constexpr double kStep = 0.2 * kPi / 180.0;
constexpr double kNothing = 0.0;  // m: no return

/// With their runs.
std::vector<ScanPoint> pointsOf(const std::vector<Return>& returns)
{
  const auto cloud = toCloud(returns);
  const CloudView view = viewOf(cloud);
  ScanLines lines;
  findScanLines(view, SensorModel(), ScanLineSource::ring_field, lines);
  const ScanTiming timing = findScanTiming(view, lines);
  const ScanReturns all{view, lines, timing, 0.1, 200.0, 0.0};
  std::vector<ScanPoint> points = listed(all);
  findStraightRuns(all, points);
  return points;
}

/// The lower of two scan lines over +-20 steps about the x axis, of what a function of the azimuth says is how far
/// away.
std::vector<ScanPoint> lineOf(const std::function<double(double)>& range)
{
  std::vector<Return> returns;
  for (int ring = 0; ring < 2; ++ring) {
    for (int i = -20; i <= 20; ++i) {
      const double azimuth = i * kStep;
      const double r = range(azimuth);
      if (r == kNothing) {
        continue;
      }
      returns.push_back(
          {{r * std::cos(azimuth), r * std::sin(azimuth), 0.1 * r * ring}, ring, i + 20, (i + 20) / 41.0});
    }
  }
  return pointsOf(returns);
}

/// Three scan lines, 2 degrees apart, over +-20 steps about the x axis, with so much of each lost: of what a function
/// of azimuth and ring says is how far away.
std::vector<ScanPoint> threeLinesOf(const std::function<double(double, int)>& range, int lost = 0)
{
  constexpr double kApart = 2.0 * kPi / 180.0;
  std::vector<Return> returns;
  for (int ring = 0; ring < 3; ++ring) {
    for (int i = -20 + lost * ring; i <= 20; ++i) {
      const double r = range(i * kStep, ring);
      const double up = (ring - 1) * kApart;
      returns.push_back(
          {{r * std::cos(up) * std::cos(i * kStep), r * std::cos(up) * std::sin(i * kStep), r * std::sin(up)},
           ring,
           i + 20,
           (i + 20) / 41.0});
    }
  }
  return pointsOf(returns);
}

Eigen::Vector3d runAt(const std::vector<ScanPoint>& points, std::size_t i)
{
  return Eigen::Vector3f::Map(points.at(i).run.data()).cast<double>();
}

TEST(StraightRuns, GoAlongAWallHoweverFarApartItsReturnsLie)
{
  for (const double degrees : {30.0, 3.0, 1.5}) {  // between wall and ray
    const double angle = degrees * kPi / 180.0;
    const auto points = lineOf([&](double azimuth) { return 20.0 * std::sin(angle) / std::sin(angle + azimuth); });
    const std::size_t middle = 20;
    const Eigen::Vector3d ends(points[middle - 3].x - points[middle + 3].x, points[middle - 3].y - points[middle + 3].y,
                               0.0);
    const Eigen::Vector3d run = runAt(points, middle);
    EXPECT_NEAR(run.norm(), ends.norm() * 7.0 / 6.0, 0.01 * ends.norm()) << degrees;
    EXPECT_LT(run.cross(ends).norm(), 1e-4 * run.norm() * ends.norm()) << degrees;
  }
}

TEST(StraightRuns, EndWhereAThingEnds)
{
  // A post three returns wide before a wall.
  const auto points = lineOf([](double azimuth) { return std::abs(azimuth) < 1.5 * kStep ? 20.0 : 40.0; });
  EXPECT_NEAR(runAt(points, 20).norm(), 20.0 * 3.0 * kStep, 0.01);
  EXPECT_NEAR(runAt(points, 19).norm(), 20.0 * 3.0 * kStep, 0.01);
  EXPECT_GT(runAt(points, 14).norm(), 40.0 * 4.0 * kStep);
}

TEST(StraightRuns, AReturnWithoutNeighboursOfItsOwnThingHasNone)
{
  const auto points = lineOf([](double azimuth) { return std::abs(azimuth) < 0.5 * kStep ? 20.0 : 40.0; });
  EXPECT_EQ(runAt(points, 20).norm(), 0.0);
}

TEST(StraightRuns, DoNotGoOnAcrossWhatIsMissing)
{
  // A post before the sky, and things far to both sides of it.
  const auto points = lineOf([](double azimuth) {
    return std::abs(azimuth) < 0.5 * kStep || std::abs(azimuth) > 10.0 * kStep ? 20.0 : kNothing;
  });
  ASSERT_LT(points.size(), 50U);
  for (const ScanPoint& point : points) {
    const bool is_post = std::abs(point.y) < 0.01;
    EXPECT_EQ(Eigen::Vector3f::Map(point.run.data()).norm() == 0.0F, is_post) << point.y;
  }
}

/// With the huge and the doubled, too: the search ends.
TEST(StraightRuns, AreFiniteOfAnyReturns)
{
  for (const double range : {1e-3, 1.0, 1e10, 3e38}) {
    const auto points = lineOf([&](double azimuth) { return std::sin(1e3 * azimuth) > 0.0 ? range : 1.0; });
    ASSERT_FALSE(points.empty());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_TRUE(runAt(points, i).allFinite()) << range;
    }
  }
}

TEST(StraightRuns, OfPointsThatAreNotTheScansStayAsTheyAre)
{
  const auto cloud =
      toCloud({{{5.0, 0.0, 0.0}, 0, 0, 0.0}, {{5.0, 0.1, 0.0}, 0, 1, 0.5}, {{5.0, 0.2, 0.0}, 0, 2, 1.0}});
  const CloudView view = viewOf(cloud);
  ScanLines lines;
  lines.index = {0, 1, 2};
  lines.begin = {0, 3};
  const ScanTiming timing;
  const ScanReturns returns{view, lines, timing, 0.1, 200.0, 0.0};
  std::vector<ScanPoint> points(5);
  for (ScanPoint& point : points) {
    point.laser = 0;
    point.place = point.index = 1;
  }
  points[1].laser = 0xFFFFFFFFU;
  points[2].place = 3;
  points[3].place = -1;
  points[4].index = 2;
  findStraightRuns(returns, points);
  EXPECT_GT(runAt(points, 0).norm(), 0.1);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_EQ(runAt(points, i).norm(), 0.0) << i;
  }
}

/// Whatever the other lines have lost.
TEST(StraightRuns, GoUpAWallAcrossTheScanLines)
{
  for (const int lost : {0, 5}) {
    for (const ScanPoint& point : threeLinesOf(
             [](double azimuth, int ring) { return 5.0 / (std::cos(azimuth) * std::cos((ring - 1) * kPi / 90.0)); },
             lost)) {
      const Eigen::Vector3f up = Eigen::Vector3f::Map(point.run_across.data());
      const float step = 5.0F * static_cast<float>(std::tan(kPi / 90.0) / std::cos(std::atan2(point.y, point.x)));
      const bool has_others_near = point.y > 5.0 * std::tan((-20 + 2 * lost) * kStep) - 0.01;
      if (has_others_near) {
        EXPECT_NEAR(up.norm(), (point.laser == 1 ? 3.0F : 2.0F) * step, 0.1F * step) << lost << ' ' << point.laser;
        EXPECT_GT(std::abs(up.z()), 0.99F * up.norm());
      }
    }
  }
}

/// A bar that one line alone hits, before a wall.
TEST(StraightRuns, DoNotGoUpFromABarToTheWallBehind)
{
  for (const ScanPoint& point :
       threeLinesOf([](double azimuth, int ring) { return (ring == 1 ? 5.0 : 8.0) / std::cos(azimuth); })) {
    if (point.laser == 1) {
      EXPECT_EQ(Eigen::Vector3f::Map(point.run_across.data()).norm(), 0.0F) << point.y;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
