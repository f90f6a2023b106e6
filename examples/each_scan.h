// What examples 05 to 07 have in common: the scans of a folder or a recording, one after the other.
#pragma once

#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <utility>

/// Tracks each scan by `track(view, stamp)`, which gives the report, and prints what came of it.
/// \return the program's exit status
template <typename Track>
int trackEachScan(int argc, char** argv, Track track)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const pcl_floam::OdometryReport& report = track(pcl_floam::viewOf(scan), scans.stamp(i));
    std::cout << std::fixed << std::setprecision(2) << scans.name(i) << ": " << toString(report.state) << ", at "
              << report.world_T_sensor.translation.transpose() << " m\n";
  }
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}

/// The same by an odometry with objects of one's own.
inline int trackEachScan(int argc, char** argv, const pcl_floam::OdometryComponents& components)
{
  pcl_floam::OdometryPipeline odometry;
  odometry.setComponents(components);
  return trackEachScan(argc, argv, [&](const auto& scan, const auto& stamp) { return odometry.track(scan, stamp); });
}
