// Edges that are lost in the noise of a few neighbours, and found over many.
#include "filters/wide_smoothness.h"

#include "filters/line_points.h"
#include "filters/smoothness.h"
#include "support/constants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr int kEachSide = 5;
constexpr double kSpacing = 0.2 * kPi / 180.0;  // rad, of the beams
constexpr double kJamb = 0.45;                  // m to each side of the middle of a door
constexpr double kDepth = 0.14;                 // m, of the door behind its wall

/// A level line 60 degrees to each side; \p range by the angle, with noise of \p sd m, of which a part is \p missing.
LinePoints lineOf(const std::function<double(double)>& range, double sd, double missing, std::mt19937& random)
{
  std::normal_distribution<double> noise(0.0, 1.0);
  std::uniform_real_distribution<double> lot(0.0, 1.0);
  LinePoints line;
  for (double angle = -kPi / 3.0; angle < kPi / 3.0; angle += kSpacing) {
    const double seen = range(angle) + sd * noise(random);
    if (lot(random) >= missing) {
      line.x.push_back(static_cast<float>(seen * std::sin(angle)));
      line.y.push_back(static_cast<float>(seen * std::cos(angle)));
      line.z.push_back(0.0F);
    }
  }
  line.measure();
  return line;
}

double behindADoor(double angle)
{
  constexpr double kWall = 1.0;  // m away
  const double to_door = (kWall + kDepth) / std::cos(angle);
  const bool is_door = std::abs(std::tan(angle)) * (kWall + kDepth) < kJamb;
  const bool is_jamb = !is_door && std::abs(std::tan(angle)) * kWall < kJamb;
  return is_door ? to_door : (is_jamb ? kJamb / std::abs(std::sin(angle)) : kWall / std::cos(angle));
}

std::function<double(double)> wallAt(double distance)
{
  return [distance](double angle) { return distance / std::cos(angle); };
}

struct Rated {
  std::vector<float> sharpness;
  WideSmoothness wide;
};

constexpr float kAnySharpness = 0.0F;

/// As the feature extraction rates a line.
Rated ratedOf(const LinePoints& line, float least = kAnySharpness)
{
  Rated rated;
  std::vector<float> scratch;
  std::vector<float> sigma;
  const LineNeighborhood neighborhood = neighborhoodIn(line, kEachSide, scratch);
  if (neighborhood.is_sparse) {
    computeSmoothnessAcross(line, neighborhood.each_side, sigma);
  } else {
    computeSmoothness(line, neighborhood.each_side, SmoothnessKind::vector_sum, sigma);
  }
  const std::vector<std::int32_t> unfit(sigma.size(), 0);
  rated.sharpness.assign(sigma.size(), 0.0F);
  rated.wide.rate(line, {neighborhood.each_side, neighborhood.spacing, least}, sigma, unfit, rated.sharpness);
  return rated;
}

std::size_t edgesIn(const LinePoints& line, float least = kAnySharpness)
{
  const Rated rated = ratedOf(line, least);
  return static_cast<std::size_t>(
      std::count_if(rated.sharpness.begin(), rated.sharpness.end(), [](float s) { return s > 0.0F; }));
}

/// Along the wall from the middle of the door.
bool isNearAJamb(float along)
{
  constexpr double kNear = 0.1;  // m: as far as the neighbourhood reaches
  return std::abs(std::abs(static_cast<double>(along)) - kJamb) < kNear;
}

TEST(WideSmoothness, FindsADoorsJambsAMetreAwayThroughNoise)
{
  constexpr float kLeast = 0.1F;  // m: the default
  constexpr int kScans = 50;
  std::mt19937 random(1);
  int both = 0;
  std::size_t elsewhere = 0;
  for (int scan = 0; scan < kScans; ++scan) {
    const LinePoints line = lineOf(behindADoor, 0.02, 0.0, random);
    const Rated rated = ratedOf(line, kLeast);
    bool left = false;
    bool right = false;
    for (std::size_t n = 0; n < rated.sharpness.size(); ++n) {
      if (rated.sharpness[n] > 0.0F) {
        left = left || (isNearAJamb(line.x[n]) && line.x[n] < 0.0F);
        right = right || (isNearAJamb(line.x[n]) && line.x[n] > 0.0F);
        elsewhere += isNearAJamb(line.x[n]) ? 0 : 1;
      }
    }
    both += left && right ? 1 : 0;
  }
  EXPECT_GT(both, 9 * kScans / 10);
  EXPECT_LT(elsewhere, static_cast<std::size_t>(kScans / 10));  // of some hundred neighbourhoods a scan
}

TEST(WideSmoothness, FindsNothingInAWallsNoise)
{
  std::mt19937 random(2);
  for (const double sd : {0.002, 0.01, 0.02, 0.05}) {
    for (const double distance : {0.6, 1.0, 2.0, 4.0}) {
      std::size_t edges = 0;
      for (int scan = 0; scan < 40; ++scan) {
        edges += edgesIn(lineOf(wallAt(distance), sd, 0.0, random));
      }
      EXPECT_LE(edges, 2U) << sd << " at " << distance;  // of some 24000 points
    }
  }
}

/// Along a line the neighbours of both sides are then not equally far.
TEST(WideSmoothness, FindsNothingWhereReturnsOfAWallAreMissing)
{
  std::mt19937 random(3);
  for (const double missing : {0.3, 0.7}) {
    std::size_t edges = 0;
    for (int scan = 0; scan < 40; ++scan) {
      edges += edgesIn(lineOf(wallAt(1.0), 0.01, missing, random));
    }
    EXPECT_LE(edges, 2U) << missing;
  }
}

/// What is hidden behind a thing ends where the sensor stops to see it.
TEST(WideSmoothness, FindsNothingBehindADepthStep)
{
  std::mt19937 random(7);
  for (const double behind : {0.15, 0.2, 0.3, 0.6}) {
    std::size_t before = 0;
    const auto boxBeforeAWall = [behind](double angle) { return (angle < 0.2 ? 1.0 : 1.0 + behind) / std::cos(angle); };
    for (int scan = 0; scan < 20; ++scan) {
      const LinePoints line = lineOf(boxBeforeAWall, 0.005, 0.0, random);
      const Rated rated = ratedOf(line);
      for (std::size_t n = 0; n < rated.sharpness.size(); ++n) {
        const bool is_behind = static_cast<double>(line.y[n]) > 1.0 + 0.5 * behind;
        EXPECT_TRUE(!is_behind || rated.sharpness[n] == 0.0F) << behind << ": " << n;
        before += !is_behind && rated.sharpness[n] > 0.0F ? 1 : 0;
      }
    }
    EXPECT_TRUE(before > 0 || behind > 0.5) << behind;  // the few neighbours see a deep one themselves
  }
}

TEST(WideSmoothness, TakesNothingThatIsLessSharpThanAsked)
{
  std::mt19937 random(6);
  const LinePoints line = lineOf(behindADoor, 0.002, 0.0, random);
  EXPECT_GT(edgesIn(line), 0U);
  EXPECT_EQ(edgesIn(line, 10.0F), 0U);
}

TEST(WideSmoothness, LeavesWhatIsFarToItsFewNeighbours)
{
  std::mt19937 random(4);
  const LinePoints line = lineOf([](double angle) { return 10.0 * behindADoor(angle); }, 0.0, 0.0, random);
  EXPECT_EQ(edgesIn(line), 0U);
}

TEST(WideSmoothness, OfAnEdgeThatIsTakenNothingIsLeft)
{
  constexpr std::ptrdiff_t kBeside = 20;  // points: fewer than the neighbourhood has on each side
  std::mt19937 random(8);
  const LinePoints line = lineOf(behindADoor, 0.005, 0.0, random);
  Rated rated = ratedOf(line);
  const auto begin = rated.sharpness.begin();
  const auto taken = std::max_element(begin, rated.sharpness.end()) - begin;
  const auto besideIt = [&] {
    return std::count_if(begin + taken - kBeside, begin + taken + kBeside, [](float s) { return s > 0.0F; });
  };
  EXPECT_GT(besideIt(), 1);
  rated.wide.forgetAround(line, static_cast<int>(taken), rated.sharpness);
  EXPECT_EQ(besideIt(), 0);
  EXPECT_GT(*std::max_element(rated.sharpness.begin(), rated.sharpness.end()), 0.0F);  // the other jamb
}

TEST(WideSmoothness, KnowsNothingOfLinesThatAreTooShortOrWithoutSpacing)
{
  std::mt19937 random(5);
  const LinePoints door = lineOf(behindADoor, 0.005, 0.0, random);
  WideSmoothness wide;
  std::vector<float> sigma;
  computeSmoothness(door, kEachSide, SmoothnessKind::vector_sum, sigma);
  std::vector<float> sharpness(sigma.size(), 0.0F);
  for (const float spacing : {0.0F, std::nanf("")}) {
    wide.rate(door, {kEachSide, spacing, kAnySharpness}, sigma, std::vector<std::int32_t>(sigma.size(), 0), sharpness);
    EXPECT_EQ(*std::max_element(sharpness.begin(), sharpness.end()), 0.0F);
  }
  for (std::size_t size = 0; size <= 2 * kEachSide + 3; ++size) {  // none has a neighbourhood that is wide
    LinePoints line = door;
    line.x.resize(size);
    line.y.resize(size);
    line.z.resize(size);
    line.measure();
    EXPECT_EQ(edgesIn(line), 0U) << size;
  }
}

/// A point that is said to be beyond all bounds takes the digits of none.
TEST(WideSmoothness, IsTheSameWhateverIsFarAway)
{
  std::mt19937 random(9);
  LinePoints line = lineOf(behindADoor, 0.005, 0.0, random);
  const std::vector<float> expected = ratedOf(line).sharpness;
  for (const float far : {1e13F, 1e30F, std::numeric_limits<float>::infinity()}) {
    line.x[2] = far;
    line.measure();
    const std::vector<float> found = ratedOf(line).sharpness;
    for (std::size_t n = 60; n < found.size(); ++n) {
      EXPECT_NEAR(found[n], expected[n], 1e-6F) << far << ": " << n;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
