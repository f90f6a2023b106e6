/// \file voxel_layer.h
/// One layer of the map: down-sampled points in hashed voxels, and the nearest neighbours among them.
#pragma once

#include "common/array_pool.h"
#include "map/range_image.h"
#include "map/voxel_block.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/map/core/neighbor_search.h>

#include <Eigen/Core>

#include <cstdint>
#include <memory_resource>
#include <vector>

namespace pcl_floam {

/// Points in a two-level grid: blocks of about a metre, found by hashing, hold one mean point per occupied voxel.
///
/// A block knows the blocks around it, so that one look-up leads to all that is near a query; nothing has to be built
/// when points are added.
class VoxelLayer : public NeighborSearch {
public:
  /// \param voxel_size m, > 0
  explicit VoxelLayer(double voxel_size);
  VoxelLayer(const VoxelLayer& other);
  VoxelLayer& operator=(const VoxelLayer& other) = delete;
  ~VoxelLayer() override = default;

  /// Adds points in the world frame, in their order; those of one voxel are averaged. One that is not finite, or more
  /// than a billion blocks away, is left out. Blocks that are a million apart in a row, hundreds of kilometres, are
  /// taken for one. Fetches for the later ones while it works on the first.
  /// \param threads >= 1; the layer does not depend on it
  /// \param intensities \p count of them; nullptr: zeros
  void insertEach(const Eigen::Vector3d* points, std::size_t count, int threads = 1,
                  const float* intensities = nullptr);

  /// Adds a point that stands for many, as those of a saved map do.
  void insertMean(const Eigen::Vector3d& point, float intensity = 0.0F);

  /// Forgets the blocks whose centre is farther than \p radius from \p center.
  void crop(const Eigen::Vector3d& center, double radius);

  /// Takes weight from the voxels within \p radius that a scan sees through; those that have none left are forgotten.
  /// \param threads >= 1; the layer does not depend on it
  /// \return how many were
  std::size_t weakenSeenThrough(const RangeImage& scan, const SE3& world_T_sensor, double radius, int threads = 1);

  void clear();

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const override { return size_ == 0; }

  /// The voxels' points, block by block.
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;
  /// Theirs, in the same order.
  [[nodiscard]] std::vector<float> intensities() const;

  void nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const override;
  void nearestOfEach(const Eigen::Vector3d* queries, std::size_t count, int k, double radius,
                     Neighbors* neighbors) const override;

private:
  /// A query in the frame of one block: where blocks and their points are seen from it.
  struct BlockQuery {
    VoxelKey key;                                      ///< of the block that holds the query
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< of the query from that block's corner
    float intensity = 0.0F;                            ///< of a point that is inserted
  };

  [[nodiscard]] Eigen::Vector3d cornerOf(const VoxelKey& key) const
  {
    return block_size_ * Eigen::Vector3d(key.x, key.y, key.z);
  }
  /// \return whether there can be one: finite, and within a billion blocks of the origin
  bool findPlace(const Eigen::Vector3d& point, BlockQuery& place) const;
  [[nodiscard]] std::uint32_t voxelAt(const Eigen::Vector3f& offset) const;

  [[nodiscard]] std::int32_t findBlock(const VoxelKey& key) const;
  std::int32_t findOrAddBlock(const VoxelKey& key);
  /// Makes a block and those around it known to each other.
  void link(std::int32_t block);
  void release(std::int32_t block);

  /// The k nearest, where the blocks around the query's own reach as far as the search does.
  /// \param home the query's own block, or kNone
  void searchAround(const BlockQuery& query, std::int32_t home, NearestSoFar& nearest) const;

  /// The k nearest, farther than that: among all blocks within \p radius, nearest ring first.
  void searchWide(const BlockQuery& query, double radius, NearestSoFar& nearest) const;

  int voxels_per_axis_;
  float inverse_voxel_size_;
  double block_size_;
  double inverse_block_size_;
  ArrayPool memory_;
  std::pmr::vector<VoxelBlock> blocks_{&memory_};
  VoxelTable numbers_;               ///< of the blocks, from 1
  std::vector<std::int32_t> free_;   ///< blocks that were forgotten
  std::vector<BlockQuery> places_;   ///< of the last points that were inserted ...
  std::vector<std::int32_t> homes_;  ///< ... and their blocks
  std::size_t size_ = 0;
};

}  // namespace pcl_floam
