// PCL's "How to use iterative closest point" with one typedef changed.
//
//   ./02_swap_icp            a made-up cloud, moved
//   ./02_swap_icp a.pcd b.pcd
// prints
//   has converged: 1, score: 3.66672e-16
//   converged after 2 iterations, standard deviations 3.04753e-08 3.04826e-08 8.21714e-09
#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>
#include <pcl/io/pcd_io.h>

#include <iostream>

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;
// using Icp = pcl::IterativeClosestPoint<Point, Point>;
using Icp = pcl_floam::EdgePlaneRegistration<Point, Point>;

/// A wavy sheet with a step in it.
static Cloud::Ptr makeCloud()
{
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 100; ++j) {
      const float x = 0.01F * static_cast<float>(i), y = 0.01F * static_cast<float>(j);
      cloud->push_back(Point(x, y, 0.05F * std::sin(8.0F * x) * std::cos(5.0F * y) + (x > 0.6F ? 0.1F : 0.0F)));
    }
  }
  return cloud;
}

int main(int argc, char** argv)
{
  auto source = makeCloud();
  auto target = pcl::make_shared<Cloud>();
  if (argc == 3) {
    if (pcl::io::loadPCDFile(argv[1], *source) < 0 || pcl::io::loadPCDFile(argv[2], *target) < 0) {
      return 2;
    }
  } else {
    Eigen::Affine3f motion(Eigen::AngleAxisf(0.2F, Eigen::Vector3f::UnitZ()));
    motion.translation() << 0.1F, -0.05F, 0.02F;
    pcl::transformPointCloud(*source, *target, motion);
  }

  Icp icp;
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaximumIterations(50);
  Cloud aligned;
  icp.align(aligned);
  std::cout << "has converged: " << icp.hasConverged() << ", score: " << icp.getFitnessScore() << '\n'
            << icp.getFinalTransformation() << '\n';
  std::cout << toString(icp.report().termination) << " after " << icp.report().iterations  // what ICP does not tell
            << " iterations, standard deviations " << icp.report().covariance.diagonal().cwiseSqrt().transpose()
            << '\n';  // m, then rad
  return icp.hasConverged() ? 0 : 1;
}
