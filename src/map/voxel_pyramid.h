/// \file voxel_pyramid.h
/// A pyramid of voxels with running sums: shapes at every scale, and which lasers saw them.
#pragma once

#include "map/chunked_pool.h"
#include "map/laser_support.h"
#include "map/surface_fit.h"
#include "map/voxel_table.h"

#include <pcl_floam/map/surface.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_floam {

/// Cells of sides v, 2v, 4v, 8v and 16v, found by a hash of 64 bits: one lookup for the finest one around a place,
/// whose parents follow from it. Each keeps the sums of its points and which lasers they came from. What a lookup reads
/// lies in one cache line, all else beside it.
class VoxelPyramid : public SurfaceSearch {
public:
  static constexpr int kLevels = 5;
  static constexpr int kPointsPerLeaf = 20;

  /// \param side m, of the finest cells
  explicit VoxelPyramid(double side, SurfaceShapes shapes = SurfaceShapes::all);

  [[nodiscard]] double side() const { return side_; }
  [[nodiscard]] std::size_t size() const { return points_; }
  [[nodiscard]] std::size_t cells() const { return cells_.used(); }

  /// What comes in from now on is of another keyframe.
  void beginKeyframe() { ++keyframe_; }

  /// Takes the point in unless its finest cell is full or has one nearer than the spacing of a full cell's points.
  bool insert(const Eigen::Vector3d& place, std::uint32_t laser);
  void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count);

  [[nodiscard]] bool empty() const override { return points_ == 0; }
  void find(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count,
            Surface* surfaces) const override;

  /// The surface at a place that a laser sees: of the finest cell around it whose shape others support.
  [[nodiscard]] Surface surfaceAt(const Eigen::Vector3d& place, std::uint32_t laser) const;

  /// Drops the blocks whose centres are farther from \p center than \p radius.
  void crop(const Eigen::Vector3d& center, double radius);

  void clear();

private:
  /// What a lookup reads of a cell. Its shape is worked out when it is first asked for, by whichever thread asks.
  struct alignas(64) Cell {
    LaserSupport support;
    std::uint32_t parent = 0;  ///< 0: none, it is a block of the greatest side
    std::uint16_t count = 0;   ///< of its points, as far as it goes
    mutable std::atomic<std::uint8_t> state{kStale};
    mutable CellShape shape;

    Cell() = default;
    ~Cell() = default;
    Cell(const Cell& other) : Cell() { *this = other; }
    Cell& operator=(const Cell& other)
    {
      support = other.support;
      parent = other.parent;
      count = other.count;
      shape = other.shape;
      state.store(other.state.load());
      return *this;
    }
  };
  static_assert(sizeof(Cell) == 64, "of a cache line's size");
  /// Of its shape; the kinds of surface follow.
  enum State : std::uint8_t { kStale, kBeingMade, kKnown };

  /// What else there is to it.
  struct CellContent {
    CellSums sums;
    std::array<std::uint32_t, 8> child{};  ///< of a finest cell the first is its points; 0: none
    mutable std::array<float, 9> axes{};
  };
  /// The points of a finest cell, from the centre of its block, m.
  struct Leaf {
    std::array<float, kPointsPerLeaf> x{}, y{}, z{};
    std::uint32_t count = 0;
  };
  struct Block {
    VoxelKey key;
    std::uint32_t root = 0;
  };

  /// A place by its finest cell, and from the centre of the block that holds it.
  struct Place {
    VoxelKey key;
    Eigen::Vector3d offset;

    [[nodiscard]] VoxelKey block() const { return key.above(kLevels - 1); }
  };
  /// A cell around a place.
  struct Found {
    std::uint32_t cell = 0;  ///< 0: none
    int level = 0;
  };
  struct Nearest {
    Eigen::Vector3f place = Eigen::Vector3f::Zero();
    float squared = std::numeric_limits<float>::infinity();
  };

  bool findPlace(const Eigen::Vector3d& point, Place& place) const;
  [[nodiscard]] Eigen::Vector3d centerOfBlock(const VoxelKey& block) const;
  [[nodiscard]] Eigen::Vector3f centerOf(const Place& place, int level) const;
  [[nodiscard]] Found finestAt(const VoxelKey& key) const;
  std::uint32_t makeCell(const VoxelKey& finest, int level);
  bool insert(const Place& place, std::uint32_t finest, std::uint32_t laser);
  CellFit fitOf(std::uint32_t cell) const;
  void surfaceAt(const Place& place, Found found, std::uint32_t laser, Surface& surface) const;
  void surfaceIn(Found found, const Place& place, const CellFit& fit, Surface& surface) const;
  [[nodiscard]] Eigen::Matrix3d feltIn(Found found, const CellFit& fit) const;
  void findNearest(Found cell, const Eigen::Vector3f& center, const Eigen::Vector3f& offset, Nearest& nearest) const;
  static void findNearest(const Leaf& leaf, const Eigen::Vector3f& offset, Nearest& nearest);
  void release(std::uint32_t cell, const VoxelKey& key, int level);
  [[nodiscard]] double sideOf(int level) const { return side_ * (1 << level); }

  double side_;
  double inverse_side_;
  float squared_spacing_;
  SurfaceShapes shapes_;
  std::uint32_t keyframe_ = 0;
  std::size_t points_ = 0;
  ChunkedPool<Cell> cells_;
  ChunkedPool<CellContent> contents_;  ///< by the cells' numbers
  ChunkedPool<Leaf> leaves_;
  VoxelTable table_;
  std::vector<Block> blocks_;
};

}  // namespace pcl_floam
