/// \file voxel_table.h
/// Voxels of several sizes by their integer coordinates.
#pragma once

#include "common/hash.h"

#include <Eigen/Core>

#include <cstdint>

namespace pcl_floam {

/// Integer coordinates of a voxel, in sides of its own level.
struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;

  friend bool operator==(const VoxelKey& a, const VoxelKey& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

  /// Of the voxel that many levels farther up, whose side is twice as long with each.
  [[nodiscard]] VoxelKey above(int levels) const { return {x >> levels, y >> levels, z >> levels}; }

  /// All of it in one number, never 0: 20 bits of each coordinate, so that voxels are told apart of which a map has no
  /// more than a million in a row.
  [[nodiscard]] std::uint64_t packed(int level) const
  {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 20U) - 1;
    const auto bits = [](std::int32_t v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)) & kMask; };
    return (bits(x) << 44U | bits(y) << 24U | bits(z) << 4U) | static_cast<std::uint64_t>(level + 1);
  }
};

/// The voxel of side 1/\p inverse_side that holds a place. \return false if there is none that integers can name
inline bool findKey(const Eigen::Vector3d& place, double inverse_side, VoxelKey& key)
{
  constexpr double kReach = 1 << 30;  // sides; makes all coordinates positive, of which the integer part is the floor
  const Eigen::Vector3d scaled = (place * inverse_side).array() + kReach;
  if (!(scaled.x() > 0.0 && scaled.y() > 0.0 && scaled.z() > 0.0 && scaled.x() < 2.0 * kReach - 1.0 &&
        scaled.y() < 2.0 * kReach - 1.0 && scaled.z() < 2.0 * kReach - 1.0)) {
    return false;  // what is not a number, too
  }
  constexpr std::int32_t kOrigin = 1 << 30;
  key = {static_cast<std::int32_t>(scaled.x()) - kOrigin, static_cast<std::int32_t>(scaled.y()) - kOrigin,
         static_cast<std::int32_t>(scaled.z()) - kOrigin};
  return true;
}

/// Which number belongs to a packed key; 0 stands for none.
using VoxelTable = HashTable<std::uint32_t>;

}  // namespace pcl_floam
