/// \file voxel_pyramid.h
/// A pyramid of voxels with running sums: shapes at every scale, and which lasers saw them.
#pragma once

#include "map/block_table.h"
#include "map/chunked_pool.h"
#include "map/surface_fit.h"

#include <pcl_floam/map/surface.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_floam {

/// A return in the map: an offset from the centre of its block, and the laser that saw it.
struct MapPoint {
  float x = 0.0F, y = 0.0F, z = 0.0F;  // m
  std::uint32_t laser = 0;
};

/// Cells of sides v, 2v, 4v, 8v and 16v. Those of the greatest side, the blocks, are found by a hash of 64 bits, all
/// others from their parent: an octree of four steps in each block. Each cell keeps the sums of its points and which
/// lasers they came from.
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

  [[nodiscard]] bool empty() const override { return points_ == 0; }
  void find(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count,
            Surface* surfaces) const override;

  /// The surface at a place that a laser sees: of the finest cell around it whose shape others support.
  [[nodiscard]] Surface surfaceAt(const Eigen::Vector3d& place, std::uint32_t laser) const;

  /// Drops the blocks whose centres are farther from \p center than \p radius.
  void crop(const Eigen::Vector3d& center, double radius);

  void clear();

private:
  struct Cell {
    std::array<std::uint32_t, 8> child{};  ///< of a finest cell the first is its points; 0: none
    CellSums sums;
    mutable CachedFit fit;
  };
  struct Leaf {
    std::array<MapPoint, kPointsPerLeaf> point;
    std::uint32_t count = 0;
  };
  struct Block {
    VoxelKey key;
    std::uint32_t root = 0;
  };
  struct Place {
    VoxelKey key;
    Eigen::Vector3d offset;  // from the block's centre
  };

  /// The cells around a place, by level; 0 where there is none. Their centres from that of the block.
  struct Path {
    std::array<std::uint32_t, kLevels> cell{};
    std::array<Eigen::Vector3d, kLevels> center;
  };
  struct Nearest {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double squared = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] Place placeOf(const Eigen::Vector3d& point) const;
  [[nodiscard]] Eigen::Vector3d centerOf(const VoxelKey& key) const;
  [[nodiscard]] Path pathTo(const Place& place) const;
  Path makePathTo(const Place& place);
  const CellFit& fitOf(const Cell& cell, int level, CellFit& own) const;
  [[nodiscard]] bool isSupported(const Cell& cell, std::uint32_t laser) const;
  [[nodiscard]] Surface surfaceIn(const Path& path, int level, const Place& place, const CellFit& fit) const;
  [[nodiscard]] Eigen::Matrix3d feltIn(const Path& path, int level, const CellFit& fit) const;
  void findNearest(std::uint32_t cell, int level, const Eigen::Vector3d& center, const Eigen::Vector3d& offset,
                   Nearest& nearest) const;
  static void findNearest(const Leaf& leaf, const Eigen::Vector3d& offset, Nearest& nearest);
  void release(std::uint32_t cell, int level);
  [[nodiscard]] double sideOf(int level) const { return side_ * (1 << level); }

  double side_;
  double squared_spacing_;
  SurfaceShapes shapes_;
  std::uint32_t keyframe_ = 0;
  std::size_t points_ = 0;
  ChunkedPool<Cell> cells_;
  ChunkedPool<Leaf> leaves_;
  BlockTable table_;
  std::vector<Block> blocks_;
};

}  // namespace pcl_floam
