// The odometry at work: the present scan (red), the map (grey) and the way so far (green). Q closes the window.
//
//   ./09_live_view SCANS [PICTURE.png]     (save what was seen last, and end)
// prints
//   20 scans, 1.30821 m from where it began
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/odometry/odometry.h>

#include <pcl/common/transforms.h>
#include <pcl/conversions.h>
#include <pcl/visualization/pcl_visualizer.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Viewer = pcl::visualization::PCLVisualizer;

/// Adds a cloud, or replaces the one of the same name.
static void show(Viewer& viewer, const Cloud::ConstPtr& cloud, const char* name, double red, double green, double blue)
{
  const pcl::visualization::PointCloudColorHandlerCustom<pcl::PointXYZ> colour(cloud, red, green, blue);
  if (!viewer.updatePointCloud<pcl::PointXYZ>(cloud, colour, name)) {
    viewer.addPointCloud<pcl::PointXYZ>(cloud, colour, name);
  }
}

int main(int argc, char** argv)
try {
  const pcl_floam::ScanSource scans(argc > 1 ? argv[1] : ".");
  pcl_floam::OdometryPipeline odometry;
  Viewer viewer("pcl_floam");
  viewer.getRenderWindow()->GetInteractor()->CreateRepeatingTimer(10);  // else PCL 1.13 waits there for the user
  const auto path = pcl::make_shared<Cloud>();
  pcl::PCLPointCloud2 blob;
  for (std::size_t i = 0; i < scans.size() && !viewer.wasStopped(); ++i) {
    scans.read(i, blob);
    const pcl_floam::OdometryReport& report = odometry.track(pcl_floam::viewOf(blob), scans.stamp(i));
    for (std::size_t n = 0, count = report.corrected_poses.size(); n < count; ++n) {
      (*path)[path->size() - count + n].getVector3fMap() = report.corrected_poses[n].translation.cast<float>();
    }
    const Eigen::Vector3f at = report.world_T_sensor.translation.cast<float>();
    path->push_back(pcl::PointXYZ(at.x(), at.y(), at.z()));
    const auto scan = pcl::make_shared<Cloud>();
    pcl::fromPCLPointCloud2(blob, *scan);
    pcl::transformPointCloud(*scan, *scan, report.world_T_sensor.matrix<float>());
    show(viewer, scan, "scan", 255, 80, 60);
    show(viewer, path, "path", 60, 255, 90);
    if (report.keyframe) {
      show(viewer, odometry.map().cloud(pcl_floam::FeatureKind::plane), "map", 150, 150, 150);
    }
    viewer.setCameraPosition(at.x() - 15.0, at.y(), at.z() + 25.0, at.x(), at.y(), at.z(), 0.0, 0.0, 1.0);  // a kite's
    viewer.spinOnce(1, true);
  }
  std::cout << path->size() << " scans, " << odometry.getPose().translation.norm() << " m from where it began\n";
  argc > 2 ? viewer.saveScreenshot(argv[2]) : (viewer.wasStopped() ? void() : viewer.spin());
} catch (const pcl_floam::FileError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
