/// \file voxel_block.h
/// The points of one block of voxels, laid out for the nearest-neighbour search.
#pragma once

#include "common/prefetch.h"
#include "map/nearest_so_far.h"
#include "map/point_group.h"
#include "map/voxel_table.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <utility>
#include <vector>

namespace pcl_floam {

/// One mean point per occupied voxel, relative to the block's lowest corner. Containers of blocks hand their memory on
/// to them.
class VoxelBlock {
public:
  using allocator_type = std::pmr::polymorphic_allocator<std::byte>;
  static constexpr std::int32_t kNone = -1;
  /// Places of the blocks around this one, itself in the middle; x fastest.
  static constexpr std::size_t kAround = 27;
  static constexpr std::size_t kItself = 13;

  VoxelBlock(const VoxelKey& block_key, const allocator_type& memory) : key(block_key), groups_(memory), voxels_(memory)
  {
    around.fill(kNone);
  }
  VoxelBlock(const VoxelBlock& other, const allocator_type& memory)
      : key(other.key), around(other.around), groups_(other.groups_, memory), voxels_(other.voxels_, memory)
  {
  }
  VoxelBlock(VoxelBlock&& other, const allocator_type& memory) noexcept
      : key(other.key),
        around(other.around),
        groups_(std::move(other.groups_), memory),
        voxels_(std::move(other.voxels_), memory)
  {
  }

  VoxelKey key;
  std::array<std::int32_t, kAround> around;

  /// Whether it is a block of the layer, which knows itself; else its place waits for one.
  [[nodiscard]] bool isUsed() const { return around[kItself] != kNone; }
  void clear()
  {
    around.fill(kNone);
    voxels_.clear();
    groups_.clear();
  }

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  [[nodiscard]] Eigen::Vector3f point(std::size_t i) const { return groups_[i / kLanes].point(i % kLanes); }

  [[nodiscard]] float intensity(std::size_t i) const { return voxels_[i].intensity; }

  void prefetchPoints() const
  {
    prefetch(groups_.data(), std::min<std::size_t>(groups_.size(), 8) * sizeof(PointGroup));
  }

  /// A mean takes in no more points than this: later ones keep moving it, so that it can follow the world.
  static constexpr float kMaxAveraged = 20.0F;

  /// Averages a point, and its intensity, into its voxel. \return true if the voxel was empty
  /// \param weight points that it stands for, if the voxel was
  bool add(std::uint32_t voxel, const Eigen::Vector3f& offset, float intensity, float weight = 1.0F)
  {
    for (std::size_t i = 0; i < voxels_.size(); ++i) {
      if (voxels_[i].number == voxel) {
        average(i, offset, intensity);
        return false;
      }
    }
    constexpr std::size_t kFew = 8;  // most blocks have more
    if (voxels_.empty()) {
      voxels_.reserve(kFew);
      groups_.reserve(kFew / kLanes);
    }
    if (voxels_.size() % kLanes == 0) {
      groups_.emplace_back();
    }
    voxels_.push_back({voxel, weight, intensity});
    set(voxels_.size() - 1, offset);
    return true;
  }

  /// Takes \p weight from voxel \p i; one without any left is no longer occupied, and the last takes its place.
  /// \return false then
  bool weaken(std::size_t i, float weight)
  {
    voxels_[i].count -= weight;
    if (voxels_[i].count > 0.0F) {
      return true;
    }
    const std::size_t last = voxels_.size() - 1;
    set(i, point(last));
    voxels_[i] = voxels_[last];
    set(last, {std::numeric_limits<float>::infinity(), 0.0F, 0.0F});
    voxels_.pop_back();
    if (voxels_.size() % kLanes == 0) {
      groups_.pop_back();
    }
    return false;
  }

  /// \param corner of the block, seen from the query
  void search(const Eigen::Vector3f& corner, NearestSoFar& nearest) const
  {
    nearest.enter({corner, this});
    float limit = nearest.limit();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const PointGroup::Lanes squared = groups_[g].squaredDistances(-corner);
      if (PointGroup::leastOf(squared) > limit) {
        continue;
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (squared[lane] <= limit) {
          nearest.add(squared[lane], g * kLanes + lane);
        }
      }
      limit = nearest.limit();
    }
  }

private:
  static constexpr std::size_t kLanes = PointGroup::kLanes;

  struct Voxel {
    std::uint32_t number;  ///< within the block
    float count;           ///< points averaged so far, up to a limit
    float intensity;
  };

  void set(std::size_t i, const Eigen::Vector3f& offset) { groups_[i / kLanes].set(i % kLanes, offset); }

  void average(std::size_t i, const Eigen::Vector3f& offset, float intensity)
  {
    Voxel& voxel = voxels_[i];
    voxel.count = std::min(voxel.count + 1.0F, kMaxAveraged);
    voxel.intensity += (intensity - voxel.intensity) / voxel.count;
    set(i, point(i) + (offset - point(i)) / voxel.count);
  }

  std::pmr::vector<PointGroup> groups_;
  std::pmr::vector<Voxel> voxels_;
};

}  // namespace pcl_floam
