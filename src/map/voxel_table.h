/// \file voxel_table.h
/// Voxels of several sizes by their integer coordinates: 64-bit keys, open addressing.
#pragma once

#include "common/hash.h"
#include "common/prefetch.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

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
class VoxelTable {
public:
  VoxelTable() : slots_(kFirst) {}

  [[nodiscard]] std::uint32_t find(std::uint64_t key) const
  {
    std::size_t i = start(key);
    while (slots_[i].key != 0 && slots_[i].key != key) {
      i = next(i);
    }
    return slots_[i].value;
  }

  /// Lets the processor fetch what \ref find will look at.
  void expect(std::uint64_t key) const { prefetch(&slots_[start(key)], sizeof(Slot)); }

  /// The key must not be there yet.
  void insert(std::uint64_t key, std::uint32_t value)
  {
    if (2 * (used_ + 1) > slots_.size()) {
      std::vector<Slot> old(2 * slots_.size());
      old.swap(slots_);
      --shift_;
      for (const Slot& slot : old) {
        if (slot.key != 0) {
          place(slot);
        }
      }
    }
    place({key, value});
    ++used_;
  }

  /// The key must be there. What had to make way for it moves up.
  void erase(std::uint64_t key)
  {
    std::size_t hole = start(key);
    while (slots_[hole].key != key) {
      hole = next(hole);
    }
    for (std::size_t i = next(hole); slots_[i].key != 0; i = next(i)) {
      const std::size_t mask = slots_.size() - 1;
      if (((i - start(slots_[i].key)) & mask) >= ((i - hole) & mask)) {
        slots_[hole] = slots_[i];
        hole = i;
      }
    }
    slots_[hole] = {};
    --used_;
  }

  void clear()
  {
    slots_.assign(slots_.size(), {});
    used_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return used_; }

private:
  static constexpr std::size_t kFirst = 1024;
  static constexpr unsigned kFirstShift = 64 - 10;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t value = 0;
  };

  [[nodiscard]] std::size_t start(std::uint64_t key) const { return hashOf(key, shift_); }
  [[nodiscard]] std::size_t next(std::size_t i) const { return (i + 1) & (slots_.size() - 1); }
  void place(const Slot& slot)
  {
    std::size_t i = start(slot.key);
    while (slots_[i].key != 0) {
      i = next(i);
    }
    slots_[i] = slot;
  }

  std::vector<Slot> slots_;
  unsigned shift_ = kFirstShift;  // leaves as many bits as number the slots
  std::size_t used_ = 0;
};

}  // namespace pcl_floam
