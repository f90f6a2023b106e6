/// \file keyframe_voxel_map.h
/// The global map: an edge layer and a plane layer of down-sampled points around the sensor.
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/core/feature_kind.h>
#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/map/core/neighbor_search.h>

#include <pcl/memory.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace pcl_floam {

/// The search structure that serves the nearest neighbours. Both give the same neighbours.
enum class SearchMethod : std::uint8_t {
  voxel,  ///< the map's own hashed voxels: nothing to build
  kdtree  ///< FLANN's KD-tree (the paper's), rebuilt after each keyframe
};

[[nodiscard]] const char* toString(SearchMethod method);

/// Settings of \ref KeyframeVoxelMap.
struct MapParameters {
  double voxel_size = 0.2;  ///< m, > 0: one plane point per voxel; edges' are half as wide. Reasonable: 0.1 to 1
  double horizon = 150.0;   ///< m, > 0: points farther from the sensor are forgotten
  /// m, >= 0: up to so far away, places that later scans see through are forgotten: cars and people that have gone.
  /// 0: never. Reasonable: 10 to 50
  double see_through_range = 40.0;
  SearchMethod search = SearchMethod::voxel;
};

/// \throws std::invalid_argument naming the first setting that is out of its range.
void validate(const MapParameters& parameters);

/// The paper's global edge map and global plane map.
///
/// Points lie in 64-bit hashed voxels, as single-precision offsets from their voxel: the map is as precise
/// a thousand kilometres from its origin as at it. A voxel's point is the mean of the points that fell into
/// it.
///
/// Reading is const and safe from several threads; writing needs exclusive access.
class KeyframeVoxelMap {
public:
  using Ptr = pcl::shared_ptr<KeyframeVoxelMap>;
  using ConstPtr = pcl::shared_ptr<const KeyframeVoxelMap>;

  /// \throws std::invalid_argument if a parameter is out of its range.
  explicit KeyframeVoxelMap(const MapParameters& parameters = {});
  KeyframeVoxelMap(const KeyframeVoxelMap& other);
  KeyframeVoxelMap(KeyframeVoxelMap&& other) noexcept;
  KeyframeVoxelMap& operator=(const KeyframeVoxelMap& other);
  KeyframeVoxelMap& operator=(KeyframeVoxelMap&& other) noexcept;
  ~KeyframeVoxelMap();

  /// Adds the features of one keyframe and forgets what lies beyond the horizon around it.
  /// \param features      in the sensor's frame, undistorted; their `time` is not used
  /// \param world_T_sensor finite
  /// \param threads       >= 1; the map does not depend on it
  void insert(const FeatureSet& features, const SE3& world_T_sensor, int threads = 1);

  /// Adds a cloud to a layer, as one keyframe; points that are not finite are left out.
  /// \param cloud in the sensor's frame, m, undistorted
  template <typename PointT>
  void addPointCloud(const pcl::PointCloud<PointT>& cloud, FeatureKind kind = FeatureKind::plane,
                     const SE3& world_T_sensor = {}, int threads = 1);

  /// Adds points to a layer, as they are in a saved map: each stands for many, and is forgotten only once two scans
  /// have seen through it. World frame, m; points that are not finite are left out.
  /// \param intensities one of each point, or none: then they are 0
  /// \throws std::invalid_argument if there are as many neither as points nor as none
  void insertPoints(FeatureKind kind, const std::vector<Eigen::Vector3d>& points,
                    const std::vector<float>& intensities = {});

  /// Takes weight from the voxels that a scan sees through, up to `see_through_range` from the sensor, and forgets
  /// those that have none left: at once where one was hit once or a few times, else after some scans.
  /// \param points         of one scan, in the sensor's frame, m, undistorted; left out where not finite
  /// \param world_T_sensor finite
  /// \param threads        >= 1; the map does not depend on it
  void forgetSeenThrough(const std::vector<Eigen::Vector3f>& points, const SE3& world_T_sensor, int threads = 1);

  /// Forgets all points farther than the horizon from \p center.
  void crop(const Eigen::Vector3d& center);

  void clear();

  [[nodiscard]] std::size_t size(FeatureKind kind) const;
  [[nodiscard]] bool empty() const { return size(FeatureKind::edge) == 0 && size(FeatureKind::plane) == 0; }

  /// The layer's nearest-neighbour search, by the method of the parameters.
  [[nodiscard]] const NeighborSearch& search(FeatureKind kind) const;

  /// All points of a layer in the world frame, in m, in an order that depends on what was inserted and forgotten alone.
  [[nodiscard]] std::vector<Eigen::Vector3d> points(FeatureKind kind) const;

  /// Their intensities, in the same order: means of what fell into each voxel; 0 where scans have none.
  [[nodiscard]] std::vector<float> intensities(FeatureKind kind) const;

  /// As \ref points, as a cloud that PCL can save, show and filter, with intensities where the point type has them.
  /// Single precision.
  ///
  /// Here and not in the library: a cloud's memory must be freed by code of the flags that allocated it, as Eigen
  /// allocates in another way where -march or -mavx are given.
  template <typename PointT = pcl::PointXYZ>
  [[nodiscard]] typename pcl::PointCloud<PointT>::Ptr cloud(FeatureKind kind) const;

  [[nodiscard]] const MapParameters& getParameters() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pcl_floam

#include <pcl_floam/map/impl/keyframe_voxel_map.hpp>
