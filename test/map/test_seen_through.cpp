// What later scans see through leaves the map.
#include "map/pillar_scans.h"
#include "map/range_image.h"
#include "support/random_motion.h"

#include <pcl_floam/map/keyframe_voxel_map.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pcl_floam::test {
namespace {

class SeenThroughAnywhere : public testing::TestWithParam<double> {
protected:
  /// Turned about the vertical, so that the axes of map and sensor differ; up to 1000 km from the map's origin.
  SE3 pose{expSO3(Eigen::Vector3d(0.0, 0.0, 0.7)), Eigen::Vector3d(GetParam(), -GetParam(), 3.0)};
};

INSTANTIATE_TEST_SUITE_P(FromTheOrigin, SeenThroughAnywhere, testing::Values(0.0, 1e6));

TEST_P(SeenThroughAnywhere, WhatHasGoneIsForgottenAndTheRestIsNot)
{
  KeyframeVoxelMap map;
  map.insert(featuresAt(scanOf(15.0F, true)), pose);
  const std::size_t before = size(map);
  const std::size_t pillar = pillarPoints(map, pose);
  ASSERT_GT(pillar, 20U);
  map.forgetSeenThrough(scanOf(15.0F, true), pose);
  EXPECT_EQ(size(map), before);
  // Voxels of the pillar are hit by up to twenty beams of the one scan: they take several looks.
  for (int looks = 0; looks < 5; ++looks) {
    map.forgetSeenThrough(scanOf(15.0F, false), pose);
  }
  const std::size_t left = pillarPoints(map, pose);
  EXPECT_LT(static_cast<double>(left), 0.3 * static_cast<double>(pillar));
  EXPECT_EQ(before - size(map), pillar - left);  // no others
}

TEST_P(SeenThroughAnywhere, AllThreadsForgetTheSame)
{
  std::vector<std::vector<Eigen::Vector3d>> left;
  for (const int threads : {1, 2, 3, 8}) {
    KeyframeVoxelMap map;
    map.insert(featuresAt(scanOf(15.0F, true, 0.05F)), pose);
    const std::size_t before = size(map);
    map.forgetSeenThrough(scanOf(15.0F, false), pose, threads);
    EXPECT_LT(size(map), before);
    left.push_back(map.points(FeatureKind::plane));
    EXPECT_EQ(left.front(), left.back()) << threads;
  }
}

TEST_P(SeenThroughAnywhere, NeighboursAreFoundAsIfItHadNeverBeenThere)
{
  KeyframeVoxelMap map;
  map.insert(featuresAt(scanOf(15.0F, true, 0.1F)), pose);
  for (int looks = 0; looks < 5; ++looks) {
    map.forgetSeenThrough(scanOf(15.0F, false), pose);
  }
  KeyframeVoxelMap left;
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    left.insertPoints(kind, map.points(kind));
    ASSERT_EQ(left.size(kind), map.size(kind));
    ASSERT_EQ(map.points(kind).size(), map.size(kind));
    for (const Eigen::Vector3f& point : scanOf(15.0F, true, 0.5F)) {
      Neighbors expected;
      Neighbors found;
      left.search(kind).nearest(pose * point.cast<double>(), 5, 2.0, expected);
      map.search(kind).nearest(pose * point.cast<double>(), 5, 2.0, found);
      ASSERT_EQ(found.count, expected.count);
      for (int i = 0; i < found.count; ++i) {
        EXPECT_FLOAT_EQ(found[i].squared_distance, expected[i].squared_distance);
      }
    }
  }
}

TEST(SeenThrough, TheVeryScanThatMadeTheMapSeesThroughNoneOfIt)
{
  for (const int lines : {16, 64, 128}) {
    for (const auto& [range, radius] : {std::pair(8.0F, 0.1F), {15.0F, 0.05F}, {25.0F, 0.05F}, {35.0F, 0.1F}}) {
      const Points scan = poleBeforeWall(range, radius, lines);
      FeatureSet pole;
      for (const Eigen::Vector3f& point : scan) {
        if (point.head<2>().norm() < 50.0F) {
          pole.edges.push_back(featuresAt({point}).edges.front());
        }
      }
      KeyframeVoxelMap map;
      map.insert(pole, SE3());
      const std::size_t before = map.size(FeatureKind::edge);
      ASSERT_GT(before, 5U);
      map.forgetSeenThrough(scan, SE3());
      EXPECT_EQ(map.size(FeatureKind::edge), before) << lines << " lines, pole at " << range;
    }
  }
}

TEST(SeenThrough, DirectionsWithoutReturnsTellNothing)
{
  KeyframeVoxelMap map;
  map.insert(featuresAt(scanOf(15.0F, true)), SE3());
  const std::size_t before = size(map);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  map.forgetSeenThrough({}, SE3());
  map.forgetSeenThrough({{nan, 0.0F, 0.0F}, {nan, nan, nan}, {0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 9.0F}}, SE3());
  map.forgetSeenThrough({{1.0F, inf, 0.0F}, {inf, 0.0F, 0.0F}, {-inf, inf, inf}, {1e30F, 0.0F, 0.0F}}, SE3());
  EXPECT_EQ(size(map), before);
}

/// A scan of which the odd thing is that some of its points are not finite.
TEST(SeenThrough, PointsThatAreNotFiniteAreLeftOut)
{
  Points scan = scanOf(15.0F, false);
  KeyframeVoxelMap expected;
  expected.insert(featuresAt(scanOf(15.0F, true)), SE3());
  KeyframeVoxelMap map = expected;
  expected.forgetSeenThrough(scan, SE3());
  for (std::size_t i = 0; i < 200; ++i) {
    scan.insert(scan.begin() + static_cast<std::ptrdiff_t>(97 * i),
                Eigen::Vector3f(std::numeric_limits<float>::infinity(), 0.0F, i % 2 == 0 ? 0.0F : 1e25F));
  }
  map.forgetSeenThrough(scan, SE3());
  EXPECT_EQ(size(map), size(expected));
}

TEST(SeenThrough, ASavedMapStandsOneLook)
{
  KeyframeVoxelMap made;
  made.insert(featuresAt(scanOf(15.0F, true, 0.05F)), SE3());
  KeyframeVoxelMap map;
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    map.insertPoints(kind, made.points(kind));
  }
  const std::size_t before = size(map);
  EXPECT_EQ(before, size(made));
  map.forgetSeenThrough(scanOf(15.0F, false), SE3());
  EXPECT_EQ(size(map), before);
  map.forgetSeenThrough(scanOf(15.0F, false), SE3());
  EXPECT_LT(size(map), before);
}

TEST(SeenThrough, WhatWasSeenOftenStaysLonger)
{
  KeyframeVoxelMap once;
  KeyframeVoxelMap often;
  for (int times = 0; times < 20; ++times) {
    often.insert(featuresAt(scanOf(15.0F, true, 0.05F)), SE3());
  }
  once.insert(featuresAt(scanOf(15.0F, true, 0.05F)), SE3());
  const std::size_t once_before = pillarPoints(once, SE3());
  const std::size_t often_before = pillarPoints(often, SE3());
  once.forgetSeenThrough(scanOf(15.0F, false), SE3());
  often.forgetSeenThrough(scanOf(15.0F, false), SE3());
  EXPECT_LT(pillarPoints(once, SE3()), once_before);
  EXPECT_EQ(pillarPoints(often, SE3()), often_before);
  often.forgetSeenThrough(scanOf(15.0F, false), SE3());
  EXPECT_LT(pillarPoints(often, SE3()), often_before);
}

TEST(SeenThrough, OnlyWithinItsRange)
{
  // The pillar is 5 m away, its blocks a metre wide.
  for (const double range : {0.0, 3.0, 4.0, 6.0}) {
    MapParameters parameters;
    parameters.see_through_range = range;
    KeyframeVoxelMap map(parameters);
    map.insert(featuresAt(scanOf(15.0F, true, 0.05F)), SE3());
    const std::size_t before = size(map);
    map.forgetSeenThrough(scanOf(15.0F, false), SE3());
    EXPECT_EQ(size(map) < before, range > 5.0) << range;
  }
}

TEST(SeenThrough, TheTreesForgetToo)
{
  MapParameters parameters;
  parameters.search = SearchMethod::kdtree;
  KeyframeVoxelMap map(parameters);
  map.insert(featuresAt(scanOf(15.0F, true, 0.05F)), SE3());
  const auto pillarFound = [&] {
    Neighbors neighbors;
    map.search(FeatureKind::plane).nearest({5.0, 0.0, 0.5}, kMaxNeighbors, 0.5, neighbors);
    return neighbors.count;
  };
  const int before = pillarFound();
  ASSERT_GT(before, 3);
  map.forgetSeenThrough(scanOf(15.0F, false), SE3());
  EXPECT_LT(pillarFound(), before);
}

/// The floor as a low sensor's scan sees it from here, and again from a little farther on.
TEST(SeenThrough, TheFloorStaysWhereBeamsPassJustAboveIt)
{
  for (const int lines : {64, 32, 16, 12}) {
    KeyframeVoxelMap map;
    map.insert(featuresAt(scanOf(28.0F, false, 0.006F, 64)), SE3());
    const std::size_t before = size(map);
    for (const float ahead : {0.0F, 0.1F, 0.35F, 0.8F, 2.0F}) {
      Points scan;
      for (const Eigen::Vector3f& point : scanOf(28.0F, false, 0.006F, lines)) {
        if (point.z() < -kHeight + 1e-3F) {  // the wall would move with the sensor
          scan.push_back(point);
        }
      }
      map.forgetSeenThrough(scan, SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(ahead, 0.0, 0.0)));
    }
    EXPECT_EQ(size(map), before) << lines;
  }
}

/// Both places are in the cell of the only beam.
TEST(SeenThrough, TheBeamMustPassTheVeryPlace)
{
  const auto towards = [](float azimuth) { return Eigen::Vector3f(std::cos(azimuth), std::sin(azimuth), 0.005F); };
  RangeImage scan;
  scan.take({30.0F * towards(0.7856F)});
  EXPECT_TRUE(scan.seesThrough(10.0F * towards(0.7906F)));
  EXPECT_FALSE(scan.seesThrough(10.0F * towards(0.8008F)));
}

/// Whole blocks are passed over only where each of their places would be.
TEST(SeenThrough, WhatIsToldOfABlockHoldsForItsPlaces)
{
  RangeImage scan;
  scan.take(scanOf(15.0F, true, 0.02F));
  std::mt19937 random(3);
  const auto randomVector = [&random](double limit) {
    return Eigen::Vector3f(static_cast<float>(uniform(random, limit)), static_cast<float>(uniform(random, limit)),
                           static_cast<float>(uniform(random, 0.2 * limit)));
  };
  constexpr float kRadius = 0.87F;
  int seen_through = 0;
  int passed_over = 0;
  for (int block = 0; block < 3000; ++block) {
    const Eigen::Vector3f center = randomVector(14.0);
    const bool may = scan.maySeeThrough(center, kRadius);
    passed_over += may ? 0 : 1;
    for (int n = 0; n < 50; ++n) {
      const Eigen::Vector3f place = center + randomVector(0.5);
      seen_through += scan.seesThrough(place) ? 1 : 0;
      ASSERT_TRUE(may || !scan.seesThrough(place)) << center.transpose();
    }
  }
  EXPECT_GT(seen_through, 1000);
  EXPECT_GT(passed_over, 300);
}

/// Boards of a rack, 4 cm thick, before a wall: most beams pass between them.
TEST(SeenThrough, BoardsStay)
{
  Points boards;
  for (float y = -3.0F; y <= 3.0F; y += 0.05F) {
    for (float z = -1.0F; z <= 1.0F; z += 0.5F) {
      boards.emplace_back(4.0F, y, z);
    }
  }
  KeyframeVoxelMap map;
  map.insert(featuresAt(boards), SE3());
  const std::size_t before = size(map);
  Points scan;
  for (int line = 0; line < 16; ++line) {
    for (float azimuth = -0.6F; azimuth < 0.6F; azimuth += 0.0035F) {
      const Eigen::Vector3f beam(1.0F, std::tan(azimuth), std::tan(0.0349F * (static_cast<float>(line) - 7.5F)));
      const float height = 4.0F * beam.z();
      const bool board = std::abs(height - 0.5F * std::round(height / 0.5F)) < 0.02F;
      scan.emplace_back((board ? 4.0F : 9.0F) * beam);
    }
  }
  map.forgetSeenThrough(scan, SE3());
  EXPECT_GT(static_cast<double>(size(map)), 0.8 * static_cast<double>(before));
}

}  // namespace
}  // namespace pcl_floam::test
