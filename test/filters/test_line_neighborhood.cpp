// Which lines are sparse, and how many neighbours tell of the surface there.
#include "filters/line_points.h"
#include "support/constants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr double kDegree = kPi / 180.0;

/// A level line, \p spacing degrees from beam to beam, of which \p is_there has returns.
LinePoints lineOf(
    double spacing, double from, double to, const std::function<double(double)>& range,
    const std::function<bool()>& is_there = [] { return true; })
{
  LinePoints line;
  for (double degrees = from; degrees < to; degrees += spacing) {
    if (is_there()) {
      const double angle = degrees * kDegree;
      line.x.push_back(static_cast<float>(range(angle) * std::cos(angle)));
      line.y.push_back(static_cast<float>(range(angle) * std::sin(angle)));
      line.z.push_back(0.0F);
    }
  }
  line.measure();
  return line;
}

double inACircle(double /*angle*/)
{
  return 8.0;
}
double alongAWall(double angle)
{
  return 3.0 / std::abs(std::sin(angle));
}

LineNeighborhood neighborhoodOf(const LinePoints& line, int wanted = 5)
{
  std::vector<float> scratch;
  return neighborhoodIn(line, wanted, scratch);
}

TEST(LineNeighborhood, IsTheOneAskedForInLinesOfUsualLidars)
{
  for (const double spacing : {0.09, 0.17, 0.2, 0.35, 0.4}) {
    for (const auto& range : {inACircle, alongAWall}) {
      for (const double to : {180.0, 60.0, 10.0}) {  // the rest looks at the sky
        const LineNeighborhood neighborhood = neighborhoodOf(lineOf(spacing, 1.0, to, range));
        EXPECT_FALSE(neighborhood.is_sparse) << spacing << " to " << to;
        EXPECT_EQ(neighborhood.each_side, 5);
      }
    }
  }
}

TEST(LineNeighborhood, StepsInDepthMakeNoLineSparse)
{
  int beam = 0;
  const auto picket_fence = [&beam](double) { return ++beam % 2 == 0 ? 4.0 : 9.0; };
  EXPECT_FALSE(neighborhoodOf(lineOf(0.2, 0.0, 90.0, picket_fence)).is_sparse);
}

TEST(LineNeighborhood, AThirdOfTheReturnsMissingMakesNoLineSparse)
{
  std::mt19937 random(1);
  const auto two_in_three = [&random] { return random() % 3 != 0; };
  for (const double spacing : {0.17, 0.2, 0.35}) {
    EXPECT_FALSE(neighborhoodOf(lineOf(spacing, 0.0, 180.0, inACircle, two_in_three)).is_sparse) << spacing;
  }
}

TEST(LineNeighborhood, IsNarrowWhereMostReturnsAreMissing)
{
  std::mt19937 random(1);
  const auto one_in_ten = [&random] { return random() % 10 == 0; };
  for (const double spacing : {0.17, 0.2, 0.35}) {
    const LineNeighborhood neighborhood = neighborhoodOf(lineOf(spacing, 0.0, 360.0, inACircle, one_in_ten));
    EXPECT_TRUE(neighborhood.is_sparse) << spacing;
    EXPECT_EQ(neighborhood.each_side, 2) << spacing;
  }
}

TEST(LineNeighborhood, ReachesAsFarAsItCanInBetween)
{
  EXPECT_EQ(neighborhoodOf(lineOf(0.7, 0.0, 360.0, inACircle)).each_side, 4);
  EXPECT_EQ(neighborhoodOf(lineOf(0.7, 0.0, 360.0, inACircle), 3).each_side, 3);
  EXPECT_EQ(neighborhoodOf(lineOf(2.0, 0.0, 360.0, inACircle), 10).each_side, 2);
}

TEST(LineNeighborhood, IsTheOneAskedForWhereNothingCanBeSaid)
{
  for (const double to : {0.0, 0.1}) {  // no point, one point
    const LineNeighborhood neighborhood = neighborhoodOf(lineOf(0.2, 0.0, to, inACircle));
    EXPECT_FALSE(neighborhood.is_sparse);
    EXPECT_EQ(neighborhood.each_side, 5);
  }
  const LineNeighborhood in_the_sensor = neighborhoodOf(lineOf(2.0, 0.0, 90.0, [](double) { return 0.0; }));
  EXPECT_FALSE(in_the_sensor.is_sparse);
}

}  // namespace
}  // namespace pcl_floam::test
