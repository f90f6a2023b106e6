#include "benchmark/registration_methods.h"

#include "support/cloud_normals.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

#include <ctime>
#include <stdexcept>

namespace pcl_floam::benchmark {

namespace {

using PointN = pcl::PointXYZINormal;

// As a careful user would set them: enough iterations, thresholds that follow the scene's size.
constexpr int kIterations = 100;

template <typename Registration, typename PointT>
SE3 align(Registration& registration, const typename pcl::PointCloud<PointT>::Ptr& source,
          const typename pcl::PointCloud<PointT>::Ptr& target, const SE3& guess)
{
  registration.setInputSource(source);
  registration.setInputTarget(target);
  pcl::PointCloud<PointT> output;
  registration.align(output, guess.matrix<float>());
  return SE3(Eigen::Affine3f(registration.getFinalTransformation()));
}

SE3 runIcp(const CloudPair& pair, const SE3& guess)
{
  pcl::IterativeClosestPoint<Point, Point> icp;
  icp.setMaximumIterations(kIterations);
  icp.setTransformationEpsilon(std::pow(1e-5 * pair.extent, 2));
  return align<decltype(icp), Point>(icp, pair.source, pair.target, guess);
}

SE3 runPointToPlane(const CloudPair& pair, const SE3& guess)
{
  pcl::IterativeClosestPointWithNormals<PointN, PointN> icp;
  icp.setMaximumIterations(kIterations);
  icp.setTransformationEpsilon(std::pow(1e-5 * pair.extent, 2));
  return align<decltype(icp), PointN>(icp, test::withNormals<PointN>(pair.source),
                                      test::withNormals<PointN>(pair.target), guess);
}

SE3 runGicp(const CloudPair& pair, const SE3& guess)
{
  pcl::GeneralizedIterativeClosestPoint<Point, Point> gicp;
  gicp.setMaximumIterations(kIterations);
  gicp.setTransformationEpsilon(1e-5 * pair.extent);
  gicp.setRotationEpsilon(1e-5);
  gicp.setMaxCorrespondenceDistance(pair.extent);
  return align<decltype(gicp), Point>(gicp, pair.source, pair.target, guess);
}

SE3 runNdt(const CloudPair& pair, const SE3& guess)
{
  pcl::NormalDistributionsTransform<Point, Point> ndt;
  ndt.setMaximumIterations(kIterations);
  ndt.setResolution(static_cast<float>(pair.ndt_resolution));
  ndt.setStepSize(0.1 * pair.ndt_resolution);
  ndt.setTransformationEpsilon(1e-4 * pair.ndt_resolution);
  return align<decltype(ndt), Point>(ndt, pair.source, pair.target, guess);
}

SE3 runOurs(const CloudPair& pair, const SE3& guess)
{
  EdgePlaneRegistration<Point, Point> registration;
  return align<decltype(registration), Point>(registration, pair.source, pair.target, guess);
}

SE3 run(const std::string& method, const CloudPair& pair, const SE3& guess)
{
  const std::vector<std::string>& names = methodNames();
  if (method == names[0]) {
    return runOurs(pair, guess);
  }
  if (method == names[1]) {
    return runIcp(pair, guess);
  }
  if (method == names[2]) {
    return runPointToPlane(pair, guess);
  }
  if (method == names[3]) {
    return runGicp(pair, guess);
  }
  if (method == names[4]) {
    return runNdt(pair, guess);
  }
  throw std::invalid_argument("unknown method " + method);
}

}  // namespace

const std::vector<std::string>& methodNames()
{
  static const std::vector<std::string> kNames = {"ours", "ICP", "point-to-plane", "GICP", "NDT"};
  return kNames;
}

MethodResult runMethod(const std::string& method, const CloudPair& pair, const SE3& guess)
{
  const std::clock_t start = std::clock();
  MethodResult result;
  result.target_T_source = run(method, pair, guess);
  result.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

}  // namespace pcl_floam::benchmark
