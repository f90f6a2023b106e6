// The line through the edges nearest to a place.
#include "map/edge_lines.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_floam::test {
namespace {

Surface lineAt(const EdgeLines& map, const Eigen::Vector3d& place)
{
  Surface surface;
  map.find(&place, 1, &surface);
  return surface;
}

/// Where rings that are so far apart cross a post.
std::vector<Eigen::Vector3d> post(const Eigen::Vector3d& foot, const Eigen::Vector3d& direction, double apart)
{
  std::vector<Eigen::Vector3d> edges;
  for (int ring = 0; ring < 6; ++ring) {
    edges.emplace_back(foot + ring * apart * direction);
  }
  return edges;
}

void insert(EdgeLines& map, const std::vector<Eigen::Vector3d>& edges)
{
  map.insert(edges.data(), edges.size());
}

EdgeLines mapOf(const std::vector<Eigen::Vector3d>& edges)
{
  EdgeLines map;
  insert(map, edges);
  return map;
}

/// A post that is seen from 8 m by rings two degrees apart, beside another: whatever the grid is, wherever they stand.
TEST(EdgeLines, FindsAPostAmongOthersWhereRingsAreFarApart)
{
  std::mt19937 random(5);
  for (int n = 0; n < 50; ++n) {
    const Eigen::Vector3d foot(uniform(random, 50.0), uniform(random, 50.0), uniform(random, 50.0));
    const Eigen::Vector3d up = expSO3(randomVector(random, 1.5)) * Eigen::Vector3d::UnitZ();
    std::vector<Eigen::Vector3d> edges = post(foot, up, 0.28);
    for (const Eigen::Vector3d& edge : post(foot + 0.65 * up.unitOrthogonal(), up, 0.28)) {
      edges.push_back(edge);
    }
    const Eigen::Vector3d off = -0.05 * up.unitOrthogonal();
    const Surface line = lineAt(mapOf(edges), foot + 0.7 * up + off);
    ASSERT_EQ(line.kind, SurfaceKind::line);
    EXPECT_GT(std::abs(line.direction.dot(up)), 1.0 - 1e-6);
    EXPECT_NEAR(up.cross(line.center - foot).norm(), 0.0, 1e-4);
    EXPECT_NEAR(line.thickness, 0.0, 1e-6);
  }
}

TEST(EdgeLines, FewOrScatteredOrFarEdgesAreNoLine)
{
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::vector<Eigen::Vector3d> edges = post(Eigen::Vector3d::Zero(), up, 0.2);
  EXPECT_EQ(lineAt(mapOf(edges), {1.5, 0.0, 0.5}).kind, SurfaceKind::unknown);
  edges.resize(3);
  EXPECT_EQ(lineAt(mapOf(edges), {0.0, 0.0, 0.3}).kind, SurfaceKind::unknown);
  EXPECT_EQ(lineAt(EdgeLines(), {0.0, 0.0, 0.3}).kind, SurfaceKind::unknown);
  const std::vector<Eigen::Vector3d> cross = {{0.3, 0.05, 0.0}, {-0.3, 0.05, 0.0}, {0.05, 0.3, 0.0}, {0.05, -0.3, 0.0}};
  EXPECT_EQ(lineAt(mapOf(cross), {0.0, 0.0, 0.1}).kind, SurfaceKind::unknown);
}

/// On both sides of the walls of voxels, millimetres apart: noise would make any line of them.
TEST(EdgeLines, EdgesThatAreInOnePlaceAreNoLine)
{
  const std::vector<Eigen::Vector3d> blob = {
      {0.009, 0.001, 0.001}, {-0.009, 0.001, 0.001}, {-0.009, -0.001, 0.001}, {0.009, -0.001, -0.001}};
  EXPECT_EQ(lineAt(mapOf(blob), {0.1, 0.0, 0.0}).kind, SurfaceKind::unknown);
}

TEST(EdgeLines, EachOfManyPlacesHasItsOwnLine)
{
  constexpr std::size_t kPosts = 37;
  EdgeLines map;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < kPosts; ++i) {
    places.emplace_back(5.0 * static_cast<double>(i), 0.0, 0.4);
    insert(map, post({places[i].x(), 0.1, 0.0}, Eigen::Vector3d::UnitZ(), 0.2));
  }
  places.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  std::vector<Surface> surfaces(places.size());
  map.find(places.data(), places.size(), surfaces.data());
  for (std::size_t i = 0; i < kPosts; ++i) {
    ASSERT_EQ(surfaces[i].kind, SurfaceKind::line);
    EXPECT_NEAR((surfaces[i].center - places[i]).head<2>().norm(), 0.1, 1e-5);
  }
  EXPECT_EQ(surfaces[kPosts].kind, SurfaceKind::unknown);
}

TEST(EdgeLines, ACopyIsAMapOfItsOwn)
{
  const std::vector<Eigen::Vector3d> edges = post(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 0.2);
  const EdgeLines map = mapOf(edges);
  EdgeLines other = map;
  other.crop({100.0, 0.0, 0.0}, 10.0);
  EXPECT_TRUE(other.empty());
  EXPECT_EQ(lineAt(map, {0.0, 0.0, 0.5}).kind, SurfaceKind::line);
  other = map;
  EXPECT_EQ(lineAt(other, {0.0, 0.0, 0.5}).kind, SurfaceKind::line);
  other.clear();
  EXPECT_TRUE(other.empty());
}

}  // namespace
}  // namespace pcl_floam::test
