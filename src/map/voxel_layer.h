/// \file voxel_layer.h
/// One layer of the map: down-sampled points in hashed voxels, and the nearest neighbours among them.
#pragma once

#include <pcl_floam/map/neighbor_search.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Integer coordinates of a block of voxels.
struct BlockKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  bool operator==(const BlockKey& other) const { return x == other.x && y == other.y && z == other.z; }
};

/// Points in a two-level grid: blocks of 4x4x4 voxels, found by hashing, hold one mean point per occupied voxel.
///
/// Neighbours of a query lie in a handful of blocks, whose points are contiguous in memory; nothing has to be built
/// when points are added.
class VoxelLayer : public NeighborSearch {
public:
  /// \param voxel_size m, > 0
  explicit VoxelLayer(double voxel_size);

  /// Adds a point in the world frame; points of one voxel are averaged. One that is not finite, or more than a
  /// billion blocks away, is left out.
  void insert(const Eigen::Vector3d& point);

  /// Forgets the blocks whose centre is farther than \p radius from \p center.
  void crop(const Eigen::Vector3d& center, double radius);

  void clear();

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const override { return size_ == 0; }

  /// The voxels' points, block by block.
  [[nodiscard]] std::vector<Eigen::Vector3d> points() const;

  void nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const override;
  void within(const Eigen::Vector3d& query, double radius, std::vector<Neighbor>& neighbors) const override;

private:
  static constexpr int kVoxelsPerAxis = 4;
  static constexpr int kVoxels = kVoxelsPerAxis * kVoxelsPerAxis * kVoxelsPerAxis;
  static constexpr std::int32_t kEmpty = -1;

  /// Mean of a voxel's points, relative to the block's lowest corner.
  struct VoxelPoint {
    float x, y, z;
    float count;  ///< points averaged so far, up to a limit
  };

  struct Block {
    BlockKey key;
    std::array<std::int8_t, kVoxels> slot;  ///< voxel -> place in points, or kEmpty
    std::vector<VoxelPoint> points;
  };

  /// A query in the frame of one block: where blocks and their points are seen from it.
  struct BlockQuery {
    BlockKey key;            ///< of the block that holds the query
    Eigen::Vector3f offset;  ///< of the query from that block's corner
  };

  /// Finite, and its block's number fits 32 bits: within a billion blocks of the origin.
  [[nodiscard]] bool isRepresentable(const Eigen::Vector3d& point) const;
  [[nodiscard]] BlockKey keyOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] BlockQuery blockQuery(const Eigen::Vector3d& query) const;
  [[nodiscard]] std::int32_t findBlock(const BlockKey& key) const;
  std::int32_t findOrAddBlock(const BlockKey& key);
  void rebuildTable(std::size_t capacity);

  /// Calls \p visit(offset of the block's corner from the query, block) for the blocks within \p radius, nearest
  /// ring first; \p squared_limit is read anew before each block, so that the caller can narrow the search.
  template <typename Visit>
  void visitBlocks(const Eigen::Vector3d& query, double radius, const float& squared_limit, Visit&& visit) const;

  double block_size_;
  float voxel_size_;
  std::vector<Block> blocks_;
  std::vector<std::int32_t> table_;  ///< open addressing, a power of two; block numbers or kEmpty
  std::size_t size_ = 0;
};

}  // namespace pcl_floam
