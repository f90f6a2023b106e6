/// \file map_search.h
/// A layer of the map as a search structure of PCL's.
#pragma once

#include <pcl_floam/map/core/finite_search.h>
#include <pcl_floam/map/keyframe_voxel_map.h>

namespace pcl_floam {

/// One layer of a map, as it was when it was asked for, for every PCL algorithm that takes a `pcl::search::Search`.
///
/// \code
/// auto search = pcl::make_shared<pcl_floam::MapSearch<pcl::PointXYZ>>(map, pcl_floam::FeatureKind::plane);
/// pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> normals;
/// normals.setInputCloud(scan);                          // where: any points in the world frame
/// normals.setSearchSurface(search->getInputCloud());    // among: the points of the map
/// normals.setSearchMethod(search);
/// \endcode
///
/// Results are indices into getInputCloud(): the layer's points in the world frame, in m, in the order of
/// KeyframeVoxelMap::points(), with intensity if \p PointT has it, and other fields as they are by default. Points that
/// are not finite have no neighbours.
///
/// It has a KD-tree of its own, although the map can search by itself: PCL's algorithms speak of points by their index
/// in a cloud, which the map's voxels do not have, and many of them set the input cloud again, with a part of its
/// indices, and expect the answers to follow. So it also stays as it is while the map grows; setMap() takes the map
/// anew.
template <typename PointT>
class MapSearch : public FiniteSearch<PointT> {
public:
  using Ptr = pcl::shared_ptr<MapSearch<PointT>>;
  using ConstPtr = pcl::shared_ptr<const MapSearch<PointT>>;
  using PointCloud = pcl::PointCloud<PointT>;

  /// Nothing to be found until setMap().
  MapSearch() = default;
  MapSearch(const KeyframeVoxelMap& map, FeatureKind kind) { setMap(map, kind); }

  /// Takes the present points of a layer as the input cloud. An empty layer has no neighbours.
  void setMap(const KeyframeVoxelMap& map, FeatureKind kind);
  /// The points that it took, whatever has been set as input cloud since; null before.
  [[nodiscard]] typename PointCloud::ConstPtr getMap() const { return map_; }

  using FiniteSearch<PointT>::nearestKSearch;
  using FiniteSearch<PointT>::radiusSearch;

  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices, std::vector<float>& distances) const override;
  int radiusSearch(const PointT& point, double radius, pcl::Indices& indices, std::vector<float>& distances,
                   unsigned int max_nn = 0) const override;

private:
  [[nodiscard]] bool isEmpty() const { return !this->input_ || this->input_->empty(); }

  typename PointCloud::ConstPtr map_;
};

}  // namespace pcl_floam

#include <pcl_floam/map/impl/map_search.hpp>
