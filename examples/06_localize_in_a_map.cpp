// Where is the sensor in a map that was saved earlier? Each scan is registered with the map from where it is expected.
//
//   ./06_localize_in_a_map MAP SCANS [X Y Z YAW]     (pose of the first scan, in m and degrees; default: the origin)
//
// MAP is a folder with map_edges.pcd and map_planes.pcd, as pcl_floam_odometry leaves one. The scans are taken as they
// are: without compensation of the motion a pose is about that of the sweep's middle.
#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/conversions.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

namespace {

Eigen::Matrix4f startingPose(char** argv)
{
  Eigen::Affine3f pose = Eigen::Affine3f::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    pose.translation()[axis] = static_cast<float>(std::atof(argv[3 + axis]));
  }
  pose.rotate(Eigen::AngleAxisf(static_cast<float>(std::atof(argv[6]) * M_PI / 180.0), Eigen::Vector3f::UnitZ()));
  return pose.matrix();
}

}  // namespace

int main(int argc, char** argv)
try {
  if (argc != 3 && argc != 7) {
    std::cerr << "usage: " << argv[0] << " MAP SCANS [X Y Z YAW]\n";
    return 2;
  }
  pcl_floam::EdgePlaneRegistration<pcl::PointXYZI, pcl::PointXYZI> registration;
  registration.setInputTargetMap(pcl::make_shared<pcl_floam::KeyframeVoxelMap>(pcl_floam::loadMap(argv[1])));

  const pcl_floam::ScanSource scans(argv[2]);
  Eigen::Matrix4f pose = argc == 7 ? startingPose(argv) : Eigen::Matrix4f::Identity();
  Eigen::Matrix4f step = Eigen::Matrix4f::Identity();
  int lost = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    pcl::PCLPointCloud2 blob;
    scans.read(i, blob);
    auto scan = pcl::make_shared<Cloud>();
    pcl::fromPCLPointCloud2(blob, *scan);

    registration.setInputSource(scan);
    Cloud aligned;
    const Eigen::Matrix4f expected = pose * step;
    registration.align(aligned, expected);
    if (registration.hasConverged()) {
      step = i == 0 ? step : Eigen::Matrix4f(pose.inverse() * registration.getFinalTransformation());
      pose = registration.getFinalTransformation();
    } else {
      ++lost;
      pose = expected;
    }
    std::cout << scans.path(i).filename().string() << ": " << toString(registration.report().termination) << ", at "
              << pose.topRightCorner<3, 1>().transpose() << '\n';
  }
  std::cout << scans.size() - lost << " of " << scans.size() << " scans localised\n";
  return lost == 0 ? 0 : 1;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
