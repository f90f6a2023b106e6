/// \file voxel_cells.h
/// The cells of a pyramid of voxels: where they are, and what came into them.
#pragma once

#include "map/chunked_pool.h"
#include "map/point_group.h"
#include "map/surface_fit.h"
#include "map/voxel_table.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Cells of several levels, each of twice the side of the one before, found by a hash of 64 bits; each knows its parent
/// and its children. They are told by number, from 1; 0 stands for none.
class VoxelCells {
public:
  static constexpr int kLevels = 5;
  static constexpr std::size_t kPointsPerLeaf = 20;

  /// What a lookup reads of a cell. Its shape is worked out when it is first asked for, by whichever thread asks.
  struct alignas(64) Cell {
    std::uint32_t parent = 0;  ///< 0: none, it is a block of the greatest side
    std::uint16_t count = 0;   ///< of its points, as far as it goes
    mutable std::atomic<std::uint8_t> state{kStale};
    mutable std::atomic<std::uint8_t> around{0};  ///< of a `point`: the parent's count when it was fitted, its low bits
    mutable CellShape shape;

    Cell() = default;
    ~Cell() = default;
    Cell(const Cell& other) : Cell() { *this = other; }
    Cell& operator=(const Cell& other)
    {
      parent = other.parent;
      count = other.count;
      shape = other.shape;
      state.store(other.state.load());
      around.store(other.around.load());
      return *this;
    }
  };
  static_assert(sizeof(Cell) == 64, "of a cache line's size");
  /// Of its shape; the kinds of surface follow.
  enum State : std::uint8_t { kStale, kBeingMade, kKnown };

  /// What else there is to it; first what a search for the nearest point reads.
  struct alignas(64) Content {
    std::array<std::uint32_t, 8> child{};  ///< of a finest cell the first is its points; 0: none
    mutable std::array<float, 9> along{};  ///< \ref CellFit::along, known as the shape is
    CellSums sums;
  };
  /// The points of a finest cell, from the centre of its block, m. Those that are not there are infinitely far.
  struct alignas(64) Leaf {
    static constexpr std::size_t kLanes = PointGroup::kLanes;

    [[nodiscard]] std::size_t used() const { return (count + kLanes - 1) / kLanes; }
    [[nodiscard]] Eigen::Vector3f point(std::size_t i) const { return groups[i / kLanes].point(i % kLanes); }
    void add(const Eigen::Vector3f& point)
    {
      groups[count / kLanes].set(count % kLanes, point);
      ++count;
    }

    std::uint32_t count = 0;
    std::array<PointGroup, kPointsPerLeaf / kLanes> groups;
    static_assert(kPointsPerLeaf % kLanes == 0, "groups are full");
  };
  /// A cell around a place.
  struct Found {
    std::uint32_t cell = 0;
    int level = 0;
  };

  [[nodiscard]] const Cell& operator[](std::uint32_t cell) const { return cells_[cell]; }
  [[nodiscard]] const Content& content(std::uint32_t cell) const { return contents_[cell]; }
  /// The points of a finest cell.
  [[nodiscard]] const Leaf& leaf(std::uint32_t cell) const { return leaves_[contents_[cell].child[0]]; }

  /// Lets the processor fetch what \ref find will look at.
  void expect(const VoxelKey& key) const { table_.expect(key.packed(0)); }
  [[nodiscard]] std::uint32_t find(const VoxelKey& key, int level) const { return table_.find(key.packed(level)); }
  /// The finest one that there is around a finest voxel.
  [[nodiscard]] Found finestAt(const VoxelKey& finest) const;
  /// The finest cell of a key, which must not be there yet, with all above it that are not.
  std::uint32_t make(const VoxelKey& finest, int level = 0);
  /// Takes a point into a finest cell that is not full, and into all above it.
  void add(std::uint32_t cell, const Eigen::Vector3f& point, std::uint32_t laser);

  /// Drops the blocks, with all in them, that \p is_far holds for. \return the number of their points
  template <typename IsFar>
  std::size_t drop(const IsFar& is_far)
  {
    std::size_t kept = 0;
    std::size_t points = 0;
    for (const Block& block : blocks_) {
      if (is_far(block.key)) {
        points += static_cast<std::size_t>(contents_[block.root].sums.points.count());
        release(block.root, block.key, kLevels - 1);
      } else {
        blocks_[kept++] = block;
      }
    }
    blocks_.resize(kept);
    return points;
  }

  void clear();

private:
  /// A cell of the greatest side.
  struct Block {
    VoxelKey key;
    std::uint32_t root = 0;
  };

  void release(std::uint32_t cell, const VoxelKey& key, int level);

  ChunkedPool<Cell> cells_;
  ChunkedPool<Content> contents_;  ///< by the cells' numbers
  ChunkedPool<Leaf> leaves_;
  VoxelTable table_;
  std::vector<Block> blocks_;
};

}  // namespace pcl_floam
