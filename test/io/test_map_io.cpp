#include "support/random_motion.h"
#include "support/temporary_folder.h"

#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace pcl_floam {
namespace {

using test::TemporaryFolder;
using test::uniform;

std::vector<Eigen::Vector3d> scattered(std::size_t count, const Eigen::Vector3d& middle)
{
  std::mt19937 random(5);
  std::vector<Eigen::Vector3d> points(count);
  for (Eigen::Vector3d& point : points) {
    point = middle + Eigen::Vector3d(uniform(random, 80.0), uniform(random, 80.0), uniform(random, 10.0));
  }
  return points;
}

KeyframeVoxelMap mapAround(const Eigen::Vector3d& middle)
{
  KeyframeVoxelMap map;
  map.insertPoints(FeatureKind::edge, scattered(300, middle));
  map.insertPoints(FeatureKind::plane, scattered(500, middle));
  return map;
}

/// Largest distance of a point of one set to the nearest of the other.
double farthest(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to)
{
  double largest = 0.0;
  for (const Eigen::Vector3d& point : from) {
    double nearest = 1e9;
    for (const Eigen::Vector3d& other : to) {
      nearest = std::min(nearest, (point - other).norm());
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

void expectSameMap(const KeyframeVoxelMap& a, const KeyframeVoxelMap& b, double tolerance)
{
  for (const FeatureKind kind : {FeatureKind::edge, FeatureKind::plane}) {
    EXPECT_EQ(a.size(kind), b.size(kind));
    EXPECT_LT(farthest(a.points(kind), b.points(kind)), tolerance);
    EXPECT_LT(farthest(b.points(kind), a.points(kind)), tolerance);
  }
}

TEST(MapIo, AMapReadsBackAsPreciselyFarFromTheOriginAsNearIt)
{
  const TemporaryFolder folder;
  for (const double away : {0.0, 4000.0, 20000.0, 1234567.0}) {
    const KeyframeVoxelMap map = mapAround({away, -0.7 * away, 30.0});
    saveMap(map, folder.path());
    expectSameMap(loadMap(folder.path()), map, away == 4000.0 ? 5e-4 : 2e-5);
  }
}

TEST(MapIo, IntensitiesAreKept)
{
  const TemporaryFolder folder;
  const std::vector<Eigen::Vector3d> points = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  KeyframeVoxelMap map;
  map.insertPoints(FeatureKind::plane, points, {7.0F, 8.0F});
  saveMap(map, folder.path());
  EXPECT_EQ(loadMap(folder.path()).intensities(FeatureKind::plane), map.intensities(FeatureKind::plane));
  pcl::PointCloud<pcl::PointXYZI> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile((folder.path() / kMapPlanesFile).string(), cloud), 0);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud[0].intensity + cloud[1].intensity, 15.0F);
}

TEST(MapIo, NearTheOriginOtherProgramsSeeWorldCoordinates)
{
  const TemporaryFolder folder;
  const KeyframeVoxelMap map = mapAround({100.0, 200.0, 0.0});
  saveMap(map, folder.path());
  pcl::PointCloud<pcl::PointXYZ> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile((folder.path() / kMapPlanesFile).string(), cloud), 0);
  EXPECT_TRUE(cloud.sensor_origin_.head<3>().isZero());
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : cloud) {
    points.push_back(point.getVector3fMap().cast<double>());
  }
  EXPECT_LT(farthest(map.points(FeatureKind::plane), points), 1e-4);
}

TEST(MapIo, FarFromItTheViewpointSaysWhereTheMapIs)
{
  const TemporaryFolder folder;
  const KeyframeVoxelMap map = mapAround({50000.0, 0.0, 0.0});
  saveMap(map, folder.path());
  pcl::PointCloud<pcl::PointXYZ> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile((folder.path() / kMapEdgesFile).string(), cloud), 0);
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : cloud) {
    points.push_back((point.getVector3fMap() + cloud.sensor_origin_.head<3>()).cast<double>());
  }
  EXPECT_LT(farthest(map.points(FeatureKind::edge), points), 0.01);  // the sum is in single precision here
}

TEST(MapIo, AnEmptyMapReadsBackEmpty)
{
  const TemporaryFolder folder;
  const auto fresh = folder.path() / "new" / "folder";
  saveMap(KeyframeVoxelMap(), fresh);
  EXPECT_TRUE(loadMap(fresh).empty());
}

TEST(MapIo, AMapThatIsNowhereIsAnError)
{
  const TemporaryFolder folder;
  saveMap(mapAround({50000.0, 0.0, 0.0}), folder.path());
  std::string text = test::contentOf(folder.path() / kMapEdgesFile);
  const std::size_t begin = text.find("VIEWPOINT ") + 10;
  folder.write(kMapEdgesFile, text.replace(begin, text.find(' ', begin) - begin, "nan"));
  try {
    (void)loadMap(folder.path());
    ADD_FAILURE() << "loaded";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("VIEWPOINT"), std::string::npos) << error.what();
  }
}

TEST(MapIo, MissingAndUnwritableFilesAreErrors)
{
  const TemporaryFolder folder;
  EXPECT_THROW((void)loadMap(folder.path()), FileError);
  EXPECT_THROW(saveMap(KeyframeVoxelMap(), folder.write("file", "x")), FileError);
}

}  // namespace
}  // namespace pcl_floam
