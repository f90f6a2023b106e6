// A map of one's own under the odometry: cells of one size, as NDT has them, each with the plane of its points.
//
//   ./07_own_map SCANS
// prints
//   000019.pcd: tracked, at 1.31 0.00 0.00 m
#include "ndt_map.h"

#include <pcl_floam/io/scan_source.h>

#include <iomanip>
#include <iostream>
#include <memory>

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  pcl_floam::OdometryComponents components;
  components.map = std::make_shared<NdtMap>();
  pcl_floam::OdometryPipeline odometry;
  odometry.setComponents(components);

  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i));
    std::cout << std::fixed << std::setprecision(2) << scans.name(i) << ": " << toString(report.state) << ", at "
              << report.world_T_sensor.translation.transpose() << " m\n";
  }
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
