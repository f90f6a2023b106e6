// Registers one PCD scan with another, exactly as with pcl::IterativeClosestPoint.
//
//   ./02_register_a_pair source.pcd target.pcd
#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/io/pcd_io.h>

#include <iostream>

int main(int argc, char** argv)
{
  if (argc != 3) {
    std::cerr << "usage: " << argv[0] << " source.pcd target.pcd\n";
    return 2;
  }
  auto source = pcl::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  auto target = pcl::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  if (pcl::io::loadPCDFile(argv[1], *source) < 0 || pcl::io::loadPCDFile(argv[2], *target) < 0) {
    return 2;
  }

  pcl_floam::EdgePlaneRegistration<pcl::PointXYZI, pcl::PointXYZI> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  pcl::PointCloud<pcl::PointXYZI> aligned;
  registration.align(aligned);

  const pcl_floam::RegistrationReport& report = registration.report();
  std::cout << toString(report.termination) << " after " << report.iterations << " iterations, "
            << report.edge_correspondences << " edge and " << report.plane_correspondences
            << " plane correspondences, residual " << report.residual_rms << " m\n"
            << registration.getFinalTransformation() << '\n'
            << "standard deviations (x y z in m, then in rad): " << report.covariance.diagonal().cwiseSqrt().transpose()
            << '\n';
  return registration.hasConverged() ? 0 : 1;
}
