// MapSearch: what its templates do.
#pragma once

namespace pcl_floam {

template <typename PointT>
void MapSearch<PointT>::setMap(const KeyframeVoxelMap& map, FeatureKind kind)
{
  map_ = map.cloud<PointT>(kind);
  if (map_->empty()) {  // PCL's tree cannot be built of it, and says so on the terminal
    pcl::search::Search<PointT>::setInputCloud(map_);
  } else {
    this->setInputCloud(map_);
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
