// A user's code compiled with -march=native against the library compiled without: what crosses the border between the
// two has the same layout and is allocated and freed alike, whatever alignment Eigen takes on either side.
// PointXYZIRT is no type of PCL's own.
#define PCL_NO_PRECOMPILE
#include "support/random_motion.h"
#include "support/synthetic_cloud.h"
#include "support/temporary_folder.h"

#include <pcl_floam/filters/feature_extraction.h>
#include <pcl_floam/filters/motion_compensation.h>
#include <pcl_floam/io/map_io.h>
#include <pcl_floam/map/map_search.h>
#include <pcl_floam/odometry/odometry.h>
#include <pcl_floam/registration/edge_plane_registration.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

using Cloud = pcl::PointCloud<PointXYZIRT>;

const SE3 kMoved = exp((Vector6() << 0.2, -0.1, 0.02, 0.01, -0.01, 0.03).finished());

Cloud::Ptr scanAt(const SE3& world_T_sensor)
{
  return pcl::make_shared<Cloud>(toCloud(sweepRoom(Room(), Lidar(), world_T_sensor)));
}

TEST(OtherAlignment, OdometryTracks)
{
  OdometryParameters parameters;
  parameters.compensation = CompensationMode::none;
  Odometry<PointXYZIRT> odometry(parameters);
  odometry.track(*scanAt(SE3()));
  const OdometryReport report = odometry.track(*scanAt(kMoved));
  EXPECT_EQ(report.state, TrackingState::tracked);
  EXPECT_LT((report.world_T_sensor.translation - kMoved.translation).norm(), 0.02);
  const Odometry<PointXYZIRT> copy = odometry;
  EXPECT_EQ(copy.map().size(FeatureKind::plane), odometry.map().size(FeatureKind::plane));
}

TEST(OtherAlignment, RegistrationAligns)
{
  EdgePlaneRegistration<PointXYZIRT, PointXYZIRT> registration;
  registration.setInputSource(scanAt(kMoved));
  registration.setInputTarget(scanAt(SE3()));
  Cloud aligned;
  registration.align(aligned);
  EXPECT_TRUE(registration.hasConverged());
  EXPECT_LT((registration.getFinalTransformation() - kMoved.matrix<float>()).norm(), 0.03F);
  EXPECT_LT(registration.getFitnessScore(), 0.1);
}

TEST(OtherAlignment, FiltersFilter)
{
  const auto scan = scanAt(SE3());
  MotionCompensation<PointXYZIRT> compensation;
  compensation.setInputCloud(scan);
  compensation.setMotion(kMoved);
  Cloud undistorted;
  compensation.filter(undistorted);
  EXPECT_EQ(undistorted.size(), scan->size());
  FeatureExtraction<PointXYZIRT> extraction;
  extraction.setInputCloud(scan);
  Cloud edges;
  extraction.filter(edges);
  EXPECT_FALSE(edges.empty());
}

TEST(OtherAlignment, MapsGoOutAndIn)
{
  KeyframeVoxelMap map;
  std::mt19937 random(1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1000; ++i) {
    points.emplace_back(uniform(random, 10.0), uniform(random, 10.0), uniform(random, 2.0));
  }
  map.insertPoints(FeatureKind::plane, points);
  const std::vector<Eigen::Vector3d> out = map.points(FeatureKind::plane);
  EXPECT_EQ(out.size(), map.size(FeatureKind::plane));
  const auto cloud = map.cloud(FeatureKind::plane);
  EXPECT_EQ(cloud->size(), out.size());
  for (int i = 0; i < 5000; ++i) {  // until the memory of its first points is given back
    cloud->push_back(pcl::PointXYZ(1.0F, 2.0F, 3.0F));
  }
  const MapSearch<pcl::PointXYZ> search(map, FeatureKind::plane);
  EXPECT_EQ(search.getInputCloud()->size(), out.size());
  const TemporaryFolder folder;
  saveMap(map, folder.path());
  EXPECT_EQ(loadMap(folder.path()).size(FeatureKind::plane), out.size());
}

}  // namespace
}  // namespace pcl_floam::test
