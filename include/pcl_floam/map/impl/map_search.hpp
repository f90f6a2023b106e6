#pragma once

namespace pcl_floam {

template <typename PointT>
void MapSearch<PointT>::setMap(const KeyframeVoxelMap& map, FeatureKind kind)
{
  // Filled here, not by the map: memory of a cloud is to be allocated by code of the flags that will free it.
  auto cloud = pcl::make_shared<PointCloud>();
  for (const Eigen::Vector3d& position : map.points(kind)) {
    PointT point;
    point.getVector3fMap() = position.cast<float>();
    cloud->push_back(point);
  }
  if (cloud->empty()) {  // PCL's tree cannot be built of it, and says so on the terminal
    pcl::search::Search<PointT>::setInputCloud(cloud);
  } else {
    this->setInputCloud(cloud);
  }
}

template <typename PointT>
int MapSearch<PointT>::nearestKSearch(const PointT& point, int k, pcl::Indices& indices,
                                      std::vector<float>& distances) const
{
  if (isEmpty()) {
    indices.clear();
    distances.clear();
    return 0;
  }
  return FiniteSearch<PointT>::nearestKSearch(point, k, indices, distances);
}

template <typename PointT>
int MapSearch<PointT>::radiusSearch(const PointT& point, double radius, pcl::Indices& indices,
                                    std::vector<float>& distances, unsigned int max_nn) const
{
  if (isEmpty()) {
    indices.clear();
    distances.clear();
    return 0;
  }
  return FiniteSearch<PointT>::radiusSearch(point, radius, indices, distances, max_nn);
}

}  // namespace pcl_floam
