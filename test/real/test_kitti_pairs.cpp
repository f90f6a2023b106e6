// Pairs of real scans, raw and thinned: skipped, and saying so, where they are not there.
#include "real/real_data.h"
#include "support/constants.h"

#include <pcl_floam/io/trajectory.h>
#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/filters/voxel_grid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <tuple>

namespace pcl_floam::test {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

std::filesystem::path folder()
{
  return dataFolder("kitti_raw_0001");
}

/// \param leaf m; 0: as it is
Cloud::Ptr scan(std::size_t number, float leaf)
{
  char name[16];
  std::snprintf(name, sizeof(name), "%010zu.bin", number);
  std::ifstream file(folder() / "velodyne" / name, std::ios::binary);
  auto cloud = pcl::make_shared<Cloud>();
  float point[4];
  while (file.read(reinterpret_cast<char*>(point), sizeof(point))) {
    cloud->push_back(Point(point[0], point[1], point[2]));
  }
  if (leaf > 0.0F) {
    pcl::VoxelGrid<Point> grid;
    grid.setLeafSize(leaf, leaf, leaf);
    grid.setInputCloud(cloud);
    auto thinned = pcl::make_shared<Cloud>();
    grid.filter(*thinned);
    return thinned;
  }
  return cloud;
}

class KittiPairs : public ::testing::Test {
protected:
  void SetUp() override
  {
    SKIP_WITHOUT(folder());
    for (const StampedPose& pose : readTrajectory(folder() / "poses.txt")) {
      poses.push_back(pose.world_T_sensor);
    }
  }

  [[nodiscard]] SE3 truth(std::size_t target, std::size_t source) const
  {
    return poses[target].inverse() * poses[source];
  }

  /// How far off the registration ends, m.
  double errorOf(std::size_t target, std::size_t source, float leaf, const SE3& guess)
  {
    registration.setInputSource(scan(source, leaf));
    registration.setInputTarget(scan(target, leaf));
    Cloud output;
    registration.align(output, guess.matrix<float>());
    EXPECT_TRUE(registration.hasConverged()) << target << " " << source;
    const Eigen::Matrix4d result = registration.getFinalTransformation().cast<double>();
    return (result.topRightCorner<3, 1>() - truth(target, source).translation).norm();
  }

  std::vector<SE3> poses;
  EdgePlaneRegistration<Point, Point> registration;
};

TEST_F(KittiPairs, ACoarseEpsilonCostsNoAccuracy)
{
  // As hdl_graph_slam sets a registration up.
  registration.setTransformationEpsilon(0.01);
  registration.setMaximumIterations(64);
  registration.setMaxCorrespondenceDistance(2.5);
  for (const std::size_t target : {15U, 30U, 45U, 90U}) {
    for (const float leaf : {0.2F, 0.0F}) {
      EXPECT_LT(errorOf(target, target + 1, leaf, SE3()), 0.08) << target << ", leaf " << leaf;
    }
  }
}

/// Three to four metres on, from the identity. Of thinned scans one pair takes the two sides of a thing that was passed
/// for one.
TEST_F(KittiPairs, ThirdNextScansAreFoundFromTheIdentity)
{
  constexpr double kRight = 0.3;  // m
  for (const auto& [leaf, most_wrong] : {std::pair(0.0F, 0), std::pair(0.25F, 1)}) {
    int wrong = 0;
    int pairs = 0;
    for (std::size_t target = 0; target + 3 < poses.size(); target += 4, ++pairs) {
      wrong += errorOf(target, target + 3, leaf, SE3()) > kRight ? 1 : 0;
    }
    EXPECT_EQ(pairs, 26);
    EXPECT_LE(wrong, most_wrong) << "leaf " << leaf;
  }
}

TEST_F(KittiPairs, ScansTwentyMetresApartAreFoundFromHalfAMetreAndThreeDegreesOff)
{
  const SE3 off(expSO3(3.0 / 180.0 * kPi * Eigen::Vector3d(1.0, 2.0, 2.0).normalized()),
                0.5 * Eigen::Vector3d(2.0, 1.0, 1.0).normalized());
  for (const auto& [target, source] : {std::pair(0U, 16U), std::pair(30U, 48U), std::pair(60U, 83U)}) {
    EXPECT_LT(errorOf(target, source, 0.3F, truth(target, source) * off), 0.2) << target;
  }
}

}  // namespace
}  // namespace pcl_floam::test
