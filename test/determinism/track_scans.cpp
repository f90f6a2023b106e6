// Tracks a folder of scans and writes the poses as pcl_floam_odometry does, for builds of the library alone.
//
//   track_scans SCANS poses.kitti.txt
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>
#include <pcl_floam/odometry/odometry.h>

#include <cstddef>

int main(int argc, char** argv)
{
  if (argc != 3) {
    return 2;
  }
  const pcl_floam::ScanSource scans(argv[1]);
  pcl_floam::OdometryPipeline odometry;
  pcl_floam::Trajectory trajectory;
  pcl::PCLPointCloud2 scan;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans.read(i, scan);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(scan), scans.stamp(i));
    auto corrected = trajectory.end() - static_cast<std::ptrdiff_t>(report.corrected_poses.size());
    for (const pcl_floam::SE3& pose : report.corrected_poses) {
      corrected++->world_T_sensor = pose;
    }
    trajectory.push_back({static_cast<double>(i), report.world_T_sensor});
  }
  pcl_floam::TrajectoryWriter(argv[2], pcl_floam::TrajectoryFormat::kitti).writeAgain(trajectory);
  return 0;
}
