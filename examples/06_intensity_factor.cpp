// A factor of one's own that learns from the scans: returns are as bright as the map is where they fall.
//
//   ./06_intensity_factor SCANS
// prints
//   after 1.26 m moved by brightness: 0.215 mm
#include "brightness_factor.h"

#include <pcl_floam/io/scan_source.h>

#include <iomanip>
#include <iostream>
#include <memory>

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  pcl_floam::OdometryParameters parameters;
  parameters.pose_instant = pcl_floam::PoseInstant::middle;  // as factors are asked
  pcl_floam::OdometryPipeline without(parameters), with(parameters);
  const auto brightness = std::make_shared<BrightnessFactor>();
  pcl_floam::OdometryComponents components;
  components.factors = {brightness};
  with.setComponents(components);

  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    brightness->scan = pcl_floam::viewOf(scan);
    without.track(brightness->scan, scans.stamp(i));
    with.track(brightness->scan, scans.stamp(i));
    brightness->learn(with.report().world_T_sensor);
  }
  const Eigen::Vector3d place = with.report().world_T_sensor.translation;
  const Eigen::Vector3d move = place - without.report().world_T_sensor.translation;
  std::cout << std::setprecision(3) << "after " << place.norm() << " m moved by brightness: " << 1000.0 * move.norm()
            << " mm\n";
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
