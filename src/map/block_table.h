/// \file block_table.h
/// Voxels by their integer coordinates: 64-bit keys, open addressing.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Integer coordinates of a voxel, 21 bits each: two million voxels either way.
struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;

  friend bool operator==(const VoxelKey& a, const VoxelKey& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

  /// All of it in one number, never 0.
  [[nodiscard]] std::uint64_t packed() const
  {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 21U) - 1;
    const auto bits = [](std::int32_t v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)) & kMask; };
    return (bits(x) << 42U | bits(y) << 21U | bits(z)) | std::uint64_t{1} << 63U;
  }
};

/// The voxel of side 1/\p inverse_side that holds a place.
inline VoxelKey keyOf(const Eigen::Vector3d& place, double inverse_side)
{
  return {static_cast<std::int32_t>(std::floor(place.x() * inverse_side)),
          static_cast<std::int32_t>(std::floor(place.y() * inverse_side)),
          static_cast<std::int32_t>(std::floor(place.z() * inverse_side))};
}

/// Which number belongs to a key; 0 stands for none.
class BlockTable {
public:
  BlockTable() : slots_(kFirst) {}

  [[nodiscard]] std::uint32_t find(std::uint64_t key) const
  {
    std::size_t i = start(key);
    while (slots_[i].key != 0 && slots_[i].key != key) {
      i = (i + 1) & (slots_.size() - 1);
    }
    return slots_[i].value;
  }

  /// The key must not be there yet.
  void insert(std::uint64_t key, std::uint32_t value)
  {
    if (2 * (used_ + 1) > slots_.size()) {
      std::vector<Slot> old(2 * slots_.size());
      old.swap(slots_);
      for (const Slot& slot : old) {
        if (slot.key != 0) {
          place(slot);
        }
      }
    }
    place({key, value});
    ++used_;
  }

  void clear()
  {
    slots_.assign(slots_.size(), {});
    used_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return used_; }

private:
  static constexpr std::size_t kFirst = 1024;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t value = 0;
  };

  [[nodiscard]] std::size_t start(std::uint64_t key) const
  {
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio: spreads all bits upwards
    return static_cast<std::size_t>((key * kGolden) >> 32U) & (slots_.size() - 1);
  }
  void place(const Slot& slot)
  {
    std::size_t i = start(slot.key);
    while (slots_[i].key != 0) {
      i = (i + 1) & (slots_.size() - 1);
    }
    slots_[i] = slot;
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace pcl_floam
