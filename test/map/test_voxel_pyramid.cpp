// The pyramid of voxels: what it takes in, what it calls a shape, and what it forgets.
#include "map/voxel_pyramid.h"

#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <vector>

namespace pcl_floam {

namespace {

constexpr double kSide = 0.5;  // m

/// \return whether it was taken in
bool insert(VoxelPyramid& map, const Eigen::Vector3d& place, std::uint32_t laser)
{
  const std::size_t before = map.size();
  map.insert(&place, &laser, 1);
  return map.size() > before;
}

Surface surfaceAt(const VoxelPyramid& map, const Eigen::Vector3d& place)
{
  Surface surface;
  map.find(&place, 1, &surface);
  return surface;
}

/// Points of the plane z = height within a square about \p center, those of one row by one laser.
void addFloor(VoxelPyramid& map, const Eigen::Vector3d& center, double half, double step, std::uint32_t lasers)
{
  std::uint32_t row = 0;
  for (double y = -half; y <= half; y += step, ++row) {
    for (double x = -half; x <= half; x += step) {
      insert(map, center + Eigen::Vector3d(x, y, 0.0), row % lasers);
    }
  }
}

}  // namespace

TEST(VoxelPyramid, TakesNoPointThatIsNearerThanTheSpacing)
{
  VoxelPyramid map(kSide);
  const Eigen::Vector3d place(0.25, 0.25, 0.25);
  const double spacing = kSide / std::sqrt(20.0);
  EXPECT_TRUE(insert(map, place, 0));
  EXPECT_FALSE(insert(map, place + Eigen::Vector3d(0.9 * spacing, 0.0, 0.0), 1));
  EXPECT_TRUE(insert(map, place + Eigen::Vector3d(1.1 * spacing, 0.0, 0.0), 1));
  EXPECT_EQ(map.size(), 2U);
}

TEST(VoxelPyramid, ACellHoldsTwentyPoints)
{
  VoxelPyramid map(kSide);
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d inside(test::uniform(random, 0.24), test::uniform(random, 0.24), test::uniform(random, 0.24));
    insert(map, Eigen::Vector3d::Constant(0.25) + inside, static_cast<std::uint32_t>(i));
  }
  EXPECT_EQ(map.size(), static_cast<std::size_t>(VoxelPyramid::kPointsPerLeaf));
}

TEST(VoxelPyramid, RefusesWhatIsNotFinite)
{
  VoxelPyramid map(kSide);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(insert(map, {nan, 0.0, 0.0}, 0));
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(surfaceAt(map, {0.0, nan, 0.0}).kind, SurfaceKind::unknown);
}

TEST(VoxelPyramid, FindsThePlaneOfAFloorWhereverItIs)
{
  for (const double origin : {0.0, 1e5, -1e6}) {
    VoxelPyramid map(kSide);
    const Eigen::Vector3d center(origin, -origin, 10.25);
    addFloor(map, center, 3.0, 0.12, 8);
    const Surface floor = surfaceAt(map, center + Eigen::Vector3d(0.3, 0.2, 0.05));
    ASSERT_EQ(floor.kind, SurfaceKind::plane);
    EXPECT_NEAR(std::abs(floor.direction.z()), 1.0, 1e-6);
    EXPECT_NEAR(floor.center.z(), 10.25, 1e-5);
    EXPECT_LT(floor.thickness, 1e-8);
  }
}

TEST(VoxelPyramid, PointsOfOneLaserAreNoSurface)
{
  VoxelPyramid map(kSide);
  addFloor(map, {0.0, 0.0, 0.25}, 3.0, 0.12, 1);
  EXPECT_EQ(surfaceAt(map, {0.3, 0.2, 0.25}).kind, SurfaceKind::unknown);
}

TEST(VoxelPyramid, WhatFillsItsCellEvenlyTellsNothingOfTheWayAlong)
{
  VoxelPyramid map(kSide);
  // Floor and wall meet along x.
  std::mt19937 random(3);
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const double x = test::uniform(random, 2.0);
    const double out = 0.15 + 0.3 + test::uniform(random, 0.3);
    insert(map, i % 2 == 0 ? Eigen::Vector3d(x, out, 0.15) : Eigen::Vector3d(x, 0.15, out), i % 8);
  }
  const Surface edge = surfaceAt(map, {0.25, 0.2, 0.2});
  ASSERT_EQ(edge.kind, SurfaceKind::point);
  EXPECT_LT(edge.observability(0, 0), 0.3);
  EXPECT_GT(edge.observability(1, 1) + edge.observability(2, 2), 3.0 * edge.observability(0, 0));
}

/// How many rings a cell happens to hold is no sign of where a surface ends.
TEST(VoxelPyramid, ACornerThatRingsCrossTellsNothingOfTheWayUp)
{
  int corners = 0;
  for (double step = 0.4 * kSide; step < 0.9 * kSide; step += 0.05 * kSide) {
    VoxelPyramid map(kSide);
    std::mt19937 random(5);
    std::uint32_t ring = 0;
    for (double up = -3.0; up <= 3.0; up += step, ++ring) {
      for (int i = 0; i < 300; ++i) {
        const double out = 0.1 + 0.5 * (1.0 + test::uniform(random, 1.0));
        insert(map, i % 2 == 0 ? Eigen::Vector3d(0.1, out, up) : Eigen::Vector3d(out, 0.1, up), ring);
      }
    }
    for (double up = -2.0; up <= 2.0; up += 0.1) {
      const Surface corner = surfaceAt(map, {0.15, 0.15, up});
      if (corner.kind == SurfaceKind::point) {
        ++corners;
        EXPECT_LT(corner.observability(2, 2), 0.2) << "rings " << step << " apart, at " << up;
      }
    }
  }
  EXPECT_GT(corners, 100);
}

/// Whoever asked before, and when.
TEST(VoxelPyramid, WhatIsNeitherPlaneNorLineFollowsWhatComesInBesideIt)
{
  VoxelPyramid asked(kSide);
  VoxelPyramid never(kSide);
  std::mt19937 random(7);
  const auto insertInBoth = [&](double x, double y, std::uint32_t laser) {
    const Eigen::Vector3d place(x, y, 0.25 + test::uniform(random, 0.2));
    insert(asked, place, laser);
    insert(never, place, laser);
  };
  for (std::uint32_t i = 0; i < 200; ++i) {
    insertInBoth(0.25 + test::uniform(random, 0.1), 0.25 + test::uniform(random, 0.2), i);
  }
  const Surface before = surfaceAt(asked, {0.2, 0.3, 0.27});
  ASSERT_EQ(before.kind, SurfaceKind::point);
  for (std::uint32_t i = 0; i < 200; ++i) {
    insertInBoth(0.75 + test::uniform(random, 0.24), 0.5 + test::uniform(random, 0.49), i);
  }
  const Surface after = surfaceAt(asked, {0.2, 0.3, 0.27});
  EXPECT_NE(after.observability, before.observability);
  EXPECT_EQ(after.observability, surfaceAt(never, {0.2, 0.3, 0.27}).observability);
}

TEST(VoxelPyramid, LooksAtAWiderScaleWhereTheFinestShowsOneLaser)
{
  VoxelPyramid map(kSide);
  // Rings 1.2 m apart: each fine cell sees one laser at most, wider ones several.
  for (std::uint32_t laser = 0; laser < 6; ++laser) {
    for (double x = -4.0; x <= 4.0; x += 0.12) {
      insert(map, {x, 1.2 * laser - 3.0, 0.25}, laser);
    }
  }
  const Surface floor = surfaceAt(map, {0.3, 0.6, 0.25});
  ASSERT_EQ(floor.kind, SurfaceKind::plane);
  EXPECT_GT(floor.extent, kSide * kSide / 12.0);  // that of what fills a finest cell
  EXPECT_NEAR(std::abs(floor.direction.z()), 1.0, 1e-6);
}

TEST(VoxelPyramid, LooksAtAWiderScaleWhereNoiseHidesTheShape)
{
  VoxelPyramid map(0.1);
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.02);  // m: a fifth of a cell
  for (std::uint32_t i = 0; i < 20000; ++i) {
    insert(map, {test::uniform(random, 2.0), test::uniform(random, 2.0), 0.05 + noise(random)}, i % 8);
  }
  for (double x = -1.0; x < 1.0; x += 0.13) {
    const Surface floor = surfaceAt(map, {x, 0.3, 0.05});
    ASSERT_EQ(floor.kind, SurfaceKind::plane) << x;
    EXPECT_GT(floor.extent, 0.1 * 0.1 / 12.0);
    EXPECT_GT(std::abs(floor.direction.z()), 0.99);
  }
}

TEST(VoxelPyramid, FindsALineThatThreeLasersSee)
{
  const auto pole = [](std::uint32_t lasers) {
    VoxelPyramid map(kSide);
    for (int i = 0; i < 40; ++i) {
      insert(map, {0.25, 0.25, 0.115 * i}, static_cast<std::uint32_t>(i) % lasers);
    }
    return surfaceAt(map, {0.3, 0.25, 0.25});
  };
  const Surface line = pole(3);
  ASSERT_EQ(line.kind, SurfaceKind::line);
  EXPECT_NEAR(std::abs(line.direction.z()), 1.0, 1e-6);
  EXPECT_NE(pole(2).kind, SurfaceKind::line);
}

TEST(VoxelPyramid, GivesTheNearestPointOfWhatIsNeitherLineNorPlane)
{
  VoxelPyramid map(kSide);
  std::mt19937 random(2);
  std::vector<Eigen::Vector3d> bush;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d inside(test::uniform(random, 0.24), test::uniform(random, 0.24), test::uniform(random, 0.24));
    const Eigen::Vector3d place = Eigen::Vector3d::Constant(0.25) + inside;
    if (insert(map, place, static_cast<std::uint32_t>(i) % 63)) {
      bush.push_back(place);
    }
  }
  const Eigen::Vector3d query(0.2, 0.3, 0.27);
  double nearest = 1.0;
  for (const Eigen::Vector3d& place : bush) {
    nearest = std::min(nearest, (place - query).norm());
  }
  const Surface surface = surfaceAt(map, query);
  ASSERT_EQ(surface.kind, SurfaceKind::point);
  EXPECT_NEAR((surface.center - query).norm(), nearest, 1e-6);
}

TEST(VoxelPyramid, ForgetsBlocksBeyondTheHorizonAndReusesTheirRoom)
{
  VoxelPyramid map(kSide);
  addFloor(map, {0.0, 0.0, 0.25}, 3.0, 0.12, 8);
  const std::size_t near = map.size();
  addFloor(map, {100.0, 0.0, 0.25}, 3.0, 0.12, 8);
  map.crop({0.0, 0.0, 0.0}, 50.0);
  EXPECT_EQ(map.size(), near);
  EXPECT_EQ(surfaceAt(map, {100.3, 0.2, 0.25}).kind, SurfaceKind::unknown);
  EXPECT_EQ(surfaceAt(map, {0.3, 0.2, 0.25}).kind, SurfaceKind::plane);
  addFloor(map, {-40.0, 0.0, 0.25}, 3.0, 0.12, 8);
  EXPECT_EQ(surfaceAt(map, {-39.7, 0.2, 0.25}).kind, SurfaceKind::plane);
}

TEST(VoxelPyramid, ACopyGoesItsOwnWay)
{
  VoxelPyramid map(kSide);
  addFloor(map, {0.0, 0.0, 0.25}, 1.0, 0.12, 8);
  const VoxelPyramid copy = map;
  map.clear();
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(surfaceAt(copy, {0.3, 0.2, 0.25}).kind, SurfaceKind::plane);
}

TEST(VoxelPyramid, ThreadsThatAskAtOnceGetTheSame)
{
  VoxelPyramid map(kSide);
  addFloor(map, {0.0, 0.0, 0.25}, 3.0, 0.12, 8);
  const VoxelPyramid untouched = map;
  std::vector<Eigen::Vector3d> places;
  for (double x = -2.5; x < 2.5; x += 0.1) {
    places.emplace_back(x, 0.3 * x, 0.25);
  }
  std::vector<std::vector<Surface>> found(4, std::vector<Surface>(places.size()));
  std::vector<std::thread> threads;
  for (auto& surfaces : found) {
    threads.emplace_back([&] { map.find(places.data(), places.size(), surfaces.data()); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Surface expected = surfaceAt(untouched, places[i]);
    for (const auto& surfaces : found) {
      EXPECT_EQ(surfaces[i].kind, expected.kind);
      EXPECT_EQ(surfaces[i].center, expected.center);
      EXPECT_EQ(surfaces[i].direction, expected.direction);
    }
  }
}

}  // namespace pcl_floam
