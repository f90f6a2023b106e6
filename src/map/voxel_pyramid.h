/// \file voxel_pyramid.h
/// A pyramid of voxels with running sums: shapes at every scale, and which lasers saw them.
#pragma once

#include "map/surface_fit.h"
#include "map/voxel_cells.h"

#include <pcl_floam/map/core/surface_map.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>

namespace pcl_floam {

/// Cells of sides v, 2v, 4v, 8v and 16v, found by a hash of 64 bits: one lookup for the finest one around a place,
/// whose parents follow from it. Each keeps the sums of its points and which lasers they came from. What a lookup reads
/// lies in one cache line, all else beside it.
class VoxelPyramid : public SurfaceMap {
public:
  static constexpr int kLevels = VoxelCells::kLevels;
  static constexpr std::size_t kPointsPerLeaf = VoxelCells::kPointsPerLeaf;

  /// \param side m, of the finest cells
  explicit VoxelPyramid(double side);

  [[nodiscard]] double side() const { return side_; }
  [[nodiscard]] std::size_t size() const { return points_; }

  [[nodiscard]] std::unique_ptr<SurfaceMap> makeEmpty(double side) const override
  {
    return std::make_unique<VoxelPyramid>(side);
  }
  [[nodiscard]] std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<VoxelPyramid>(*this); }

  /// Takes each in unless its finest cell is full or has one nearer than the spacing of a full cell's points.
  void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count) override;

  [[nodiscard]] bool empty() const override { return points_ == 0; }

  /// At each place that of the finest cell around it that several lasers have seen a shape in.
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override;

  /// Drops the blocks whose centres are farther from \p center than \p radius.
  void crop(const Eigen::Vector3d& center, double radius) override;

  void clear() override;

private:
  static constexpr std::size_t kAtOnce = 32;  ///< places that are looked up side by side

  /// A place by its finest cell, and from the centre of the block that holds it.
  struct Place {
    VoxelKey key;
    Eigen::Vector3d offset;

    [[nodiscard]] VoxelKey block() const { return key.above(kLevels - 1); }
  };
  using Found = VoxelCells::Found;
  using Leaf = VoxelCells::Leaf;
  struct Nearest {
    Eigen::Vector3f place = Eigen::Vector3f::Zero();
    float squared = std::numeric_limits<float>::infinity();
  };
  /// Of a cell, or what was just worked out for it.
  struct Fit {
    SurfaceKind kind;
    const CellShape& shape;
    const std::array<float, 9>& along;
  };

  bool findPlace(const Eigen::Vector3d& point, Place& place) const;
  [[nodiscard]] Eigen::Vector3d centerOfBlock(const VoxelKey& block) const;
  [[nodiscard]] Eigen::Vector3f centerOf(const Place& place, int level) const;
  void insert(const Place& place, std::uint32_t finest, std::uint32_t laser);
  [[nodiscard]] bool isOfNow(const VoxelCells::Cell& cell, std::uint8_t state) const;
  [[nodiscard]] std::uint8_t versionAround(const VoxelCells::Cell& cell) const;
  Fit fitOf(Found found, CellFit& own) const;
  void surfaceAt(const Place& place, Found found, Surface& surface) const;
  void surfaceIn(Found found, const Place& place, const Fit& fit, Surface& surface) const;
  [[nodiscard]] bool isNear(const Leaf& leaf, const Eigen::Vector3f& offset) const;
  void findNearest(Found cell, const Eigen::Vector3f& center, const Eigen::Vector3f& offset, Nearest& nearest) const;
  static void findNearest(const Leaf& leaf, const Eigen::Vector3f& offset, Nearest& nearest);
  [[nodiscard]] double sideOf(int level) const { return side_ * (1 << level); }

  double side_;
  double inverse_side_;
  float squared_spacing_;
  std::size_t points_ = 0;
  VoxelCells cells_;
};

}  // namespace pcl_floam
