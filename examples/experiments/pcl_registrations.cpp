#include "pcl_registrations.h"

#include <pcl/features/normal_3d.h>
#include <pcl/filters/filter.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ndt.h>

#include <stdexcept>

namespace pcl_floam::experiments {

namespace {

constexpr double kTranslationEpsilon = 1e-6;  // m^2, as PCL compares squares
constexpr int kNormalNeighbors = 10;

/// Positions are all that ICP, GICP and NDT need.
const Cloud::Ptr& prepared(const Cloud::Ptr& scan, const pcl::PointXYZ& /*type*/)
{
  return scan;
}

/// Point-to-plane ICP wants normals.
pcl::PointCloud<pcl::PointNormal>::Ptr prepared(const Cloud::Ptr& scan, const pcl::PointNormal& /*type*/)
{
  pcl::PointCloud<pcl::PointNormal>::Ptr result(new pcl::PointCloud<pcl::PointNormal>);
  pcl::copyPointCloud(*scan, *result);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(scan);
  estimation.setKSearch(kNormalNeighbors);
  pcl::PointCloud<pcl::PointNormal> normals;
  estimation.compute(normals);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    result->points[i].getNormalVector3fMap() = normals[i].getNormalVector3fMap();
  }
  // A point whose neighbours define no plane has a NaN normal, which PCL's solver would take for a number.
  pcl::Indices kept;
  pcl::removeNaNNormalsFromPointCloud(*result, *result, kept);
  return result;
}

template <typename Registration, typename Point>
class Matcher : public ScanMatcher {
public:
  Registration& registration() { return registration_; }

  void start(const Cloud::Ptr& scan) override { last_ = prepared(scan, Point()); }

  bool match(const Cloud::Ptr& scan, const Eigen::Matrix4f& guess, Eigen::Matrix4f& result) override
  {
    const auto current = prepared(scan, Point());
    registration_.setInputSource(current);
    registration_.setInputTarget(last_);
    pcl::PointCloud<Point> moved;
    registration_.align(moved, guess);
    result = registration_.getFinalTransformation();
    last_ = current;
    return registration_.hasConverged() && result.allFinite();
  }

private:
  Registration registration_;
  typename pcl::PointCloud<Point>::Ptr last_;
};

template <typename Registration, typename Point>
std::unique_ptr<Matcher<Registration, Point>> make(const RegistrationSettings& settings)
{
  auto matcher = std::make_unique<Matcher<Registration, Point>>();
  matcher->registration().setMaximumIterations(settings.iterations);
  matcher->registration().setTransformationEpsilon(kTranslationEpsilon);
  return matcher;
}

template <typename Registration, typename Point>
std::unique_ptr<ScanMatcher> makeWithDistance(const RegistrationSettings& settings)
{
  auto matcher = make<Registration, Point>(settings);
  matcher->registration().setMaxCorrespondenceDistance(settings.max_distance);
  return matcher;
}

std::unique_ptr<ScanMatcher> makeNdt(const RegistrationSettings& settings)
{
  // Values of PCL's tutorial on NDT.
  constexpr double kStepSize = 0.1;  // m
  constexpr double kEpsilon = 0.01;
  auto matcher = make<pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ>, pcl::PointXYZ>(settings);
  matcher->registration().setTransformationEpsilon(kEpsilon * kEpsilon);
  matcher->registration().setStepSize(kStepSize);
  matcher->registration().setResolution(static_cast<float>(settings.resolution));
  return matcher;
}

}  // namespace

std::unique_ptr<ScanMatcher> makeScanMatcher(const std::string& method, const RegistrationSettings& settings)
{
  using pcl::PointNormal;
  using pcl::PointXYZ;
  if (method == "icp") {
    return makeWithDistance<pcl::IterativeClosestPoint<PointXYZ, PointXYZ>, PointXYZ>(settings);
  }
  if (method == "icp-plane") {
    return makeWithDistance<pcl::IterativeClosestPointWithNormals<PointNormal, PointNormal>, PointNormal>(settings);
  }
  if (method == "gicp") {
    return makeWithDistance<pcl::GeneralizedIterativeClosestPoint<PointXYZ, PointXYZ>, PointXYZ>(settings);
  }
  if (method == "ndt") {
    return makeNdt(settings);
  }
  throw std::invalid_argument("unknown method '" + method + "'");
}

const std::vector<std::string>& scanMatcherNames()
{
  static const std::vector<std::string> names{"icp", "icp-plane", "gicp", "ndt"};
  return names;
}

}  // namespace pcl_floam::experiments
