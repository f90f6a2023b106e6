// Where is the sensor in a map that was saved earlier? The map stays as it is, so that the error does not grow.
//
//   ./04_localize_in_a_map MAP SCANS [X Y Z YAW]     (pose of the first scan, in m and degrees; default: the origin)
// prints
//   000019.pcd: tracked, at  1.307 -0.001 -0.001 +- 0.005 m
//   20 of 20 scans localised
//
// MAP is a folder with map_edges.pcd and map_planes.pcd, as pcl_floam_odometry leaves one.
#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <iostream>

namespace {

pcl_floam::SE3 startingPose(char** argv)
{
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    pose.translation()[axis] = std::atof(argv[3 + axis]);
  }
  pose.rotate(Eigen::AngleAxisd(std::atof(argv[6]) * M_PI / 180.0, Eigen::Vector3d::UnitZ()));
  return pcl_floam::SE3(pose);
}

}  // namespace

int main(int argc, char** argv)
try {
  if (argc != 3 && argc != 7) {
    std::cerr << "usage: " << argv[0] << " MAP SCANS [X Y Z YAW]\n";
    return 2;
  }
  pcl_floam::OdometryPipeline odometry;  // for a known point type: pcl_floam::Odometry<PointT>
  odometry.localizeIn(pcl_floam::loadMap(argv[1]), argc == 7 ? startingPose(argv) : pcl_floam::SE3());

  const pcl_floam::ScanSource scans(argv[2]);
  pcl::PCLPointCloud2 scan;
  std::size_t localized = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i));
    localized += report.state == pcl_floam::TrackingState::tracked ? 1 : 0;
    const Eigen::Matrix3d position_covariance = report.covariance.topLeftCorner<3, 3>();
    std::cout << std::fixed << std::setprecision(3) << scans.name(i) << ": " << toString(report.state) << ", at "
              << report.world_T_sensor.translation.transpose() << " +- " << std::sqrt(position_covariance.trace())
              << " m\n";
  }
  std::cout << localized << " of " << scans.size() << " scans localised\n";
  return localized == scans.size() ? 0 : 1;
} catch (const std::exception& error) {  // a file that cannot be read, an empty map
  std::cerr << error.what() << '\n';
  return 2;
}
