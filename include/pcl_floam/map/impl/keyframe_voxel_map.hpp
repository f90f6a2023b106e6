// KeyframeVoxelMap: clouds of any point type in and out.
#pragma once

#include <pcl/common/point_tests.h>

namespace pcl_floam {

template <typename PointT>
void KeyframeVoxelMap::addPointCloud(const pcl::PointCloud<PointT>& cloud, FeatureKind kind, const SE3& world_T_sensor,
                                     int threads)
{
  FeatureSet features;
  std::vector<Feature>& layer = kind == FeatureKind::edge ? features.edges : features.planes;
  for (const PointT& point : cloud) {
    if (pcl::isXYZFinite(point)) {
      layer.push_back({point.x, point.y, point.z});
      if constexpr (pcl::traits::has_intensity_v<PointT>) {
        layer.back().intensity = static_cast<float>(point.intensity);
      }
    }
  }
  insert(features, world_T_sensor, threads);
}

template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr KeyframeVoxelMap::cloud(FeatureKind kind) const
{
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  for (const Eigen::Vector3d& position : points(kind)) {
    PointT point;
    point.getVector3fMap() = position.cast<float>();
    cloud->push_back(point);
  }
  if constexpr (pcl::traits::has_intensity_v<PointT>) {
    const std::vector<float> brightness = intensities(kind);
    for (std::size_t i = 0; i < brightness.size(); ++i) {
      (*cloud)[i].intensity = brightness[i];
    }
  }
  return cloud;
}

}  // namespace pcl_floam
