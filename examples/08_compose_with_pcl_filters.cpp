// PCL's filters and this library's in one chain: cut away the robot, undistort the sweep, keep its plane points.
//
//   ./08_compose_with_pcl_filters sweep.pcd planes.pcd VX      (VX: forward speed in m per sweep)
// prints
//   28800 -> 28800 points
//   28800 -> 28800 points
//   28800 -> 1695 points
#include <pcl_floam/filters/feature_extraction.h>
#include <pcl_floam/filters/motion_compensation.h>

#include <pcl/filters/crop_box.h>
#include <pcl/io/pcd_io.h>

#include <cstdlib>
#include <iostream>
#include <vector>

using Point = pcl::PointXYZI;
using Cloud = pcl::PointCloud<Point>;

int main(int argc, char** argv)
{
  auto cloud = pcl::make_shared<Cloud>();
  if (argc != 4 || pcl::io::loadPCDFile(argv[1], *cloud) < 0) {
    std::cerr << "usage: " << argv[0] << " sweep.pcd planes.pcd VX\n";
    return 2;
  }

  auto robot = pcl::make_shared<pcl::CropBox<Point>>();
  robot->setMin({-1.5F, -1.0F, -2.0F, 1.0F});
  robot->setMax({1.5F, 1.0F, 1.0F, 1.0F});
  robot->setNegative(true);

  auto compensation = pcl::make_shared<pcl_floam::MotionCompensation<Point>>();
  pcl_floam::Vector6 twist = pcl_floam::Vector6::Zero();
  twist[0] = std::atof(argv[3]);
  compensation->setTwist(twist);

  auto extraction = pcl::make_shared<pcl_floam::FeatureExtraction<Point>>();
  extraction->setFeatureKind(pcl_floam::FeatureKind::plane);

  for (const pcl::Filter<Point>::Ptr& filter : std::vector<pcl::Filter<Point>::Ptr>{robot, compensation, extraction}) {
    auto output = pcl::make_shared<Cloud>();
    filter->setInputCloud(cloud);
    filter->filter(*output);
    std::cout << cloud->size() << " -> " << output->size() << " points\n";
    cloud = output;
  }
  return pcl::io::savePCDFileBinary(argv[2], *cloud) < 0 ? 1 : 0;
}
