/// \file range_image.h
/// How far a scan sees in each direction.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace pcl_floam {

/// The nearest return of a scan in each of a grid of directions, about 0.7 degrees apart.
class RangeImage {
public:
  /// Another scan, in the same memory.
  /// \param points in the sensor's frame, m; ones that are not finite are left out
  void take(const std::vector<Eigen::Vector3f>& points);

  /// True if a beam went through this place, in the sensor's frame, and on for clearly farther, and so did all beams
  /// around it. What no beam met, above all the directions without returns, is not seen through.
  [[nodiscard]] bool seesThrough(const Eigen::Vector3f& place) const;

  /// False only if no place within \p radius of this one is seen through: told at once for a whole block of the map.
  [[nodiscard]] bool maySeeThrough(const Eigen::Vector3f& center, float radius) const;

private:
  /// Azimuth as \ref pseudoAzimuth, and the tangent of the elevation.
  static constexpr int kColumns = 512;
  static constexpr int kRows = 208;
  static constexpr float kSteepest = 1.2F;  ///< 50 degrees up and down
  static constexpr int kPatch = 4;          ///< cells along the side of a patch

  struct Cell {
    int column;
    int row;  ///< out of [0, kRows) where it is steeper
  };

  /// The cells above and below one are looked at with it, so columns are what is contiguous.
  [[nodiscard]] static std::size_t placeOf(int column, int row, int rows)
  {
    return static_cast<std::size_t>(column) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row);
  }
  [[nodiscard]] static float clearlyBeyond(float range);
  [[nodiscard]] static Cell cellOf(const Eigen::Vector3f& direction);
  [[nodiscard]] bool allBeyond(int column, int row, float range) const;
  [[nodiscard]] bool nextBeyond(const Cell& cell, int up, float range) const;
  [[nodiscard]] float rangeAt(int column, int row) const { return nearest_[placeOf(column, row, kRows)]; }

  std::vector<float> nearest_;         ///< range of each cell's return; zero where there is none
  std::vector<Eigen::Vector3f> beam_;  ///< unit vectors to those returns; where there are none, anything
  std::vector<float> farthest_;        ///< range of each patch of cells; zero where there is no return
};

}  // namespace pcl_floam
