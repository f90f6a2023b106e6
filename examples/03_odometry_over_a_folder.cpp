// The whole paper over a folder of scans or a recording (mcap, rosbag, pcap), in a few lines.
//
//   ./03_odometry_over_a_folder FOLDER|RECORDING [TOPIC]
// prints
//   000019.pcd: tracked, at 1.31 0.00 0.00 m
//   20 scans, 1.31 m
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <vector>

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".", argc > 2 ? argv[2] : "");
  pcl_floam::OdometryPipeline odometry;  // for a known point type: pcl_floam::Odometry<PointT>
  std::vector<pcl_floam::SE3> trajectory;
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i));
    std::cout << std::fixed << std::setprecision(2) << scans.name(i) << ": " << toString(report.state) << ", at "
              << report.world_T_sensor.translation.transpose() << " m\n";
    // After a start among traffic, and where the sensor has come to rest, poses are known better later: here are those
    // just before this one.
    const std::vector<pcl_floam::SE3>& corrected = report.corrected_poses;
    std::copy(corrected.begin(), corrected.end(), std::prev(trajectory.end(), static_cast<long>(corrected.size())));
    trajectory.push_back(report.world_T_sensor);
  }
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].translation - trajectory[i - 1].translation).norm();
  }
  std::cout << trajectory.size() << " scans, " << length << " m\n";
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
