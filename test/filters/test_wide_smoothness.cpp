// Edges that are lost in the noise of a few neighbours, and found over many.
#include "filters/wide_smoothness.h"

#include "filters/smoothness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

constexpr int kEachSide = 5;
constexpr double kSpacing = 0.2 * M_PI / 180.0;  // rad, of the beams
constexpr double kJamb = 0.45;                   // m to each side of the middle of a door
constexpr double kDepth = 0.14;                  // m, of the door behind its wall

/// A level line 60 degrees to each side; \p range by the angle, with noise of \p sd m, of which a part is \p missing.
LinePoints lineOf(const std::function<double(double)>& range, double sd, double missing, std::mt19937& random)
{
  std::normal_distribution<double> noise(0.0, 1.0);
  std::uniform_real_distribution<double> lot(0.0, 1.0);
  LinePoints line;
  for (double angle = -M_PI / 3.0; angle < M_PI / 3.0; angle += kSpacing) {
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

Rated ratedOf(const LinePoints& line)
{
  Rated rated;
  std::vector<float> sigma;
  computeSmoothness(line, kEachSide, SmoothnessKind::vector_sum, sigma);
  const std::vector<std::int32_t> unfit(sigma.size(), 0);
  rated.sharpness.assign(sigma.size(), 0.0F);
  rated.wide.rate(line, kEachSide, static_cast<float>(kSpacing), sigma, unfit, rated.sharpness);
  return rated;
}

std::size_t edgesIn(const LinePoints& line)
{
  const Rated rated = ratedOf(line);
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
  constexpr int kScans = 50;
  constexpr double kNoise = 0.02;  // m
  std::mt19937 random(1);
  int both = 0;
  std::size_t elsewhere = 0;
  for (int scan = 0; scan < kScans; ++scan) {
    const LinePoints line = lineOf(behindADoor, kNoise, 0.0, random);
    const Rated rated = ratedOf(line);
    bool left = false;
    bool right = false;
    for (std::size_t n = 0; n < rated.sharpness.size(); ++n) {
      if (rated.sharpness[n] > 0.0F) {
        left = left || (isNearAJamb(line.x[n]) && line.x[n] < 0.0F);
        right = right || (isNearAJamb(line.x[n]) && line.x[n] > 0.0F);
        elsewhere += isNearAJamb(line.x[n]) ? 0 : 1;
        EXPECT_GT(rated.wide.reachOf(static_cast<int>(n)), kEachSide);
      }
    }
    both += left && right ? 1 : 0;
  }
  EXPECT_GT(both, 9 * kScans / 10);
  EXPECT_LT(elsewhere, static_cast<std::size_t>(kScans));  // of some 250 neighbourhoods a scan
}

TEST(WideSmoothness, FindsNothingInAWallsNoise)
{
  std::mt19937 random(2);
  for (const double sd : {0.002, 0.01, 0.02, 0.05}) {
    for (const double distance : {0.6, 1.0, 2.0, 4.0}) {
      std::size_t edges = 0;
      std::size_t points = 0;
      for (int scan = 0; scan < 20; ++scan) {
        const LinePoints line = lineOf(wallAt(distance), sd, 0.0, random);
        edges += edgesIn(line);
        points += line.x.size();
      }
      EXPECT_LT(1000 * edges, 2 * points) << sd << " at " << distance;
    }
  }
}

/// Along a line the neighbours of both sides are then not equally far.
TEST(WideSmoothness, FindsNothingWhereReturnsOfAWallAreMissing)
{
  std::mt19937 random(3);
  for (const double missing : {0.3, 0.7}) {
    std::size_t edges = 0;
    std::size_t points = 0;
    for (int scan = 0; scan < 20; ++scan) {
      const LinePoints line = lineOf(wallAt(1.0), 0.01, missing, random);
      edges += edgesIn(line);
      points += line.x.size();
    }
    EXPECT_LT(1000 * edges, 2 * points) << missing;
  }
}

TEST(WideSmoothness, LeavesWhatIsFarToItsFewNeighbours)
{
  std::mt19937 random(4);
  const LinePoints line = lineOf([](double angle) { return 10.0 * behindADoor(angle); }, 0.0, 0.0, random);
  const Rated rated = ratedOf(line);
  for (std::size_t n = 0; n < rated.sharpness.size(); ++n) {
    EXPECT_EQ(rated.wide.reachOf(static_cast<int>(n)), 0);
    EXPECT_EQ(rated.sharpness[n], 0.0F);
  }
}

TEST(WideSmoothness, KnowsNothingOfLinesThatAreTooShortOrHaveNoSpacing)
{
  std::mt19937 random(5);
  LinePoints line = lineOf(wallAt(1.0), 0.02, 0.0, random);
  std::vector<float> sigma;
  computeSmoothness(line, kEachSide, SmoothnessKind::vector_sum, sigma);
  std::vector<float> sharpness(sigma.size(), 0.0F);
  WideSmoothness wide;
  for (const float spacing : {0.0F, std::nanf("")}) {
    wide.rate(line, kEachSide, spacing, sigma, std::vector<std::int32_t>(sigma.size(), 0), sharpness);
    EXPECT_EQ(wide.reachOf(50), 0);
  }
  line = LinePoints();
  wide.rate(line, kEachSide, static_cast<float>(kSpacing), {}, {}, sharpness);
  EXPECT_EQ(wide.reachOf(0), 0);
}

}  // namespace
}  // namespace pcl_floam::test
