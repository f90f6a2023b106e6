#include <pcl_floam/evaluation/map_sharpness.h>

#include "common/parameter_check.h"

#include <pcl/common/centroid.h>
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

namespace pcl_floam {

namespace {

using MapOctree = pcl::octree::OctreePointCloudSearch<pcl::PointXYZ>;

/// ln(2 pi e)
constexpr double kLog2PiE = 2.8378770664093454836;

/// m^2: no lidar measures to less than a millimetre, and the entropy of what lies exactly in a plane is none.
constexpr double kSmallestVariance = 1e-6;

/// Radii from the first sensor to the end of the map: beyond, float32 no longer tells neighbours apart, and the
/// octree's keys overflow.
constexpr double kFarthestRadii = 1e6;

/// Of the neighbourhoods that are judged.
class SharpnessSums {
public:
  SharpnessSums(const pcl::PointCloud<pcl::PointXYZ>& map, const std::vector<std::size_t>& ends,
                const MapSharpnessParameters& parameters)
      : map_(map), ends_(ends), fewest_(parameters.neighbors)
  {
  }

  void add(const pcl::Indices& neighbors)
  {
    if (neighbors.size() < fewest_ || !isOfTwoScans(neighbors)) {
      return;
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    Eigen::Vector4d centroid;
    pcl::computeMeanAndCovarianceMatrix(map_, neighbors, covariance, centroid);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
    const Eigen::Array3d variances = solver.eigenvalues().array();
    entropy_ += 0.5 * (3.0 * kLog2PiE + variances.max(kSmallestVariance).log().sum());
    variance_ += std::max(variances[0], 0.0);
    ++count_;
  }

  [[nodiscard]] MapSharpness mean() const
  {
    const double n = count_ > 0 ? static_cast<double>(count_) : 1.0;
    return {entropy_ / n, variance_ / n, count_};
  }

private:
  /// The points lie scan by scan in the map.
  [[nodiscard]] bool isOfTwoScans(const pcl::Indices& neighbors) const
  {
    const auto [first, last] = std::minmax_element(neighbors.begin(), neighbors.end());
    return static_cast<std::size_t>(*last) >=
           *std::upper_bound(ends_.begin(), ends_.end(), static_cast<std::size_t>(*first));
  }

  const pcl::PointCloud<pcl::PointXYZ>& map_;
  const std::vector<std::size_t>& ends_;
  std::size_t fewest_;
  double entropy_ = 0.0;
  double variance_ = 0.0;
  std::size_t count_ = 0;
};

pcl::PointCloud<pcl::PointXYZ>::Ptr mapCloud(const std::vector<Eigen::Vector3f>& points)
{
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    cloud->push_back({point.x(), point.y(), point.z()});
  }
  return cloud;
}

}  // namespace

double MapSharpness::spreadAcrossPlanes() const
{
  return std::sqrt(mean_plane_variance);
}

MapSharpnessEstimation::MapSharpnessEstimation(const MapSharpnessParameters& parameters) : parameters_(parameters)
{
  const ParameterCheck check("map sharpness");
  check.above("radius", parameters.radius, 0.0);
  check.atLeast("neighbors", static_cast<double>(parameters.neighbors), 4.0);
  check.atLeast("min_range", parameters.min_range, 0.0);
  check.above("max_range", parameters.max_range, parameters.min_range);
  check.range("max_range", parameters.max_range, 0.0, kFarthestRadii * parameters.radius);
  check.atLeast("points", static_cast<double>(parameters.points), 1.0);
}

void MapSharpnessEstimation::addScan(const std::vector<Eigen::Vector3f>& scan, const SE3& pose)
{
  first_T_world_ = ends_.empty() ? pose.inverse() : first_T_world_;
  const SE3 first_T_sensor = first_T_world_ * pose;
  if (!(first_T_sensor.isFinite() && first_T_sensor.translation.norm() <= kFarthestRadii * parameters_.radius)) {
    throw std::invalid_argument("map sharpness: pose " + std::to_string(ends_.size()) +
                                " is not finite, or too far from the first one for this radius");
  }
  // Not every n-th point: of columns of lasers that might be always the same lasers.
  const double part = static_cast<double>(parameters_.points) / static_cast<double>(scan.size());
  for (const Eigen::Vector3f& point : scan) {
    const double range = point.cast<double>().norm();
    // Nor one in each voxel: points off a surface have voxels of their own, and would count more. Ranges refuse NaN.
    if (static_cast<double>(random_()) <= part * std::mt19937::max() && range >= parameters_.min_range &&
        range <= parameters_.max_range) {
      points_.emplace_back((first_T_sensor * point.cast<double>().eval()).cast<float>());
    }
  }
  ends_.push_back(points_.size());
}

MapSharpness MapSharpnessEstimation::compute() const
{
  if (points_.empty()) {
    return {};
  }
  const pcl::PointCloud<pcl::PointXYZ>::Ptr map = mapCloud(points_);
  MapOctree octree(0.5 * parameters_.radius);
  octree.setInputCloud(map);
  octree.defineBoundingBox();
  octree.addPointsFromInputCloud();
  SharpnessSums sums(*map, ends_, parameters_);
  pcl::Indices neighbors;
  std::vector<float> squared_distances;
  for (auto voxel = octree.leaf_depth_begin(); voxel != octree.leaf_depth_end(); ++voxel) {
    const auto centre = voxel.getLeafContainer().getPointIndicesVector().front();
    octree.radiusSearch((*map)[static_cast<std::size_t>(centre)], parameters_.radius, neighbors, squared_distances);
    sums.add(neighbors);
  }
  return sums.mean();
}

MapSharpness mapSharpness(const std::vector<std::vector<Eigen::Vector3f>>& scans, const std::vector<SE3>& poses,
                          const MapSharpnessParameters& parameters)
{
  if (scans.size() != poses.size()) {
    throw std::invalid_argument("there are " + std::to_string(scans.size()) + " scans and " +
                                std::to_string(poses.size()) + " poses");
  }
  MapSharpnessEstimation estimation(parameters);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    estimation.addScan(scans[i], poses[i]);
  }
  return estimation.compute();
}

}  // namespace pcl_floam
