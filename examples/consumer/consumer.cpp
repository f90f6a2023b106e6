// Tracks two identical scans of a made-up room: compiles, links and runs against the installed library.
#include <pcl_floam/common/point_types.h>
#include <pcl_floam/odometry/odometry.h>

#include <cmath>
#include <iostream>

namespace {

/// A square room seen by a sensor with 16 beams.
pcl::PointCloud<pcl_floam::PointXYZIRT> makeScan()
{
  pcl::PointCloud<pcl_floam::PointXYZIRT> scan;
  for (int column = 0; column < 1800; ++column) {
    const double azimuth = -2.0 * M_PI * column / 1800.0;
    const double wall = 5.0 / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
    for (int ring = 0; ring < 16; ++ring) {
      const double slope = std::tan((-15.0 + 2.0 * ring) * M_PI / 180.0);
      const double distance = slope < 0.0 ? std::min(wall, -1.0 / slope) : wall;  // the floor is 1 m below
      scan.push_back({static_cast<float>(distance * std::cos(azimuth)),
                      static_cast<float>(distance * std::sin(azimuth)), static_cast<float>(distance * slope), 0.0F,
                      static_cast<std::uint16_t>(ring), static_cast<float>(0.1 * column / 1800.0)});
    }
  }
  return scan;
}

}  // namespace

int main()
{
  pcl_floam::Odometry<pcl_floam::PointXYZIRT> odometry;
  odometry.track(makeScan());
  const pcl_floam::OdometryReport& report = odometry.track(makeScan());
  std::cout << toString(report.state) << ", moved " << report.world_T_sensor.translation.norm() << " m\n";
  return report.state == pcl_floam::TrackingState::tracked && report.world_T_sensor.translation.norm() < 0.01 ? 0 : 1;
}
