// The odometry at work: the present scan (red), the map (grey) and the way so far (green). Q closes the window.
//
//   ./09_live_view SCANS [PICTURE.png]     (save what was seen last, and end)
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <pcl/common/transforms.h>
#include <pcl/conversions.h>
#include <pcl/visualization/pcl_visualizer.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include <iostream>
#include <string>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Colour = pcl::visualization::PointCloudColorHandlerCustom<pcl::PointXYZ>;

/// Adds a cloud, or replaces the one of the same name.
static void show(pcl::visualization::PCLVisualizer& viewer, const Cloud::ConstPtr& cloud, const Colour& colour,
                 const std::string& name, double size)
{
  if (!viewer.updatePointCloud<pcl::PointXYZ>(cloud, colour, name)) {
    viewer.addPointCloud<pcl::PointXYZ>(cloud, colour, name);
    viewer.setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, size, name);
  }
}

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  pcl_floam::OdometryPipeline odometry;
  pcl::visualization::PCLVisualizer viewer("pcl_floam");
  viewer.getRenderWindow()->GetInteractor()->CreateRepeatingTimer(10);  // else PCL 1.13 waits there for the user
  auto path = pcl::make_shared<Cloud>();
  pcl::PCLPointCloud2 blob;
  for (std::size_t i = 0; i < scans.size() && !viewer.wasStopped(); ++i) {
    scans.read(i, blob);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(blob), scans.stamp(i));

    Cloud sensed;
    pcl::fromPCLPointCloud2(blob, sensed);
    auto scan = pcl::make_shared<Cloud>();
    pcl::transformPointCloud(sensed, *scan, report.world_T_sensor.matrix<float>());
    for (std::size_t n = 0, count = report.corrected_poses.size(); n < count; ++n) {
      (*path)[path->size() - count + n].getVector3fMap() = report.corrected_poses[n].translation.cast<float>();
    }
    path->push_back(pcl::PointXYZ());
    path->back().getVector3fMap() = report.world_T_sensor.translation.cast<float>();
    if (report.keyframe) {
      const auto map = odometry.map().cloud(pcl_floam::FeatureKind::plane);
      show(viewer, map, Colour(map, 150, 150, 150), "map", 1.0);
    }
    show(viewer, scan, Colour(scan, 255, 80, 60), "scan", 1.0);
    show(viewer, path, Colour(path, 60, 255, 90), "path", 4.0);
    const Eigen::Vector3d& at = report.world_T_sensor.translation;  // as a kite sees it
    viewer.setCameraPosition(at.x() - 15.0, at.y(), at.z() + 25.0, at.x(), at.y(), at.z(), 0.0, 0.0, 1.0);
    viewer.spinOnce(1, true);
  }
  if (argc > 2) {
    viewer.saveScreenshot(argv[2]);
  }
  while (argc <= 2 && !viewer.wasStopped()) {  // all seen: stay open
    viewer.spinOnce(1, true);
  }
  return 0;
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
