/// \file nearest_so_far.h
/// The nearest points of a search in progress.
#pragma once

#include "common/sort_key.h"

#include <pcl_floam/map/core/neighbor_search.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace pcl_floam {

/// Points of a block of the map, seen from a query.
struct SeenPoints {
  Eigen::Vector3f corner;  ///< of the block, relative to the query
  const class VoxelBlock* block;
};

/// The k nearest points found so far, as numbers that sort by distance and then by the order in which they were found:
/// to take in a point is a few comparisons without a branch. Where the points are is looked up for the last k only.
class NearestSoFar {
public:
  NearestSoFar(int k, float squared_radius) : k_(static_cast<std::size_t>(k))
  {
    std::fill_n(keys_.begin(), k_, sortKey(squared_radius, kNobody));
  }

  /// Squared distance up to which a point counts, m^2.
  [[nodiscard]] float limit() const { return valueOf(keys_[k_ - 1]); }

  /// The points added from now on are \p seen.
  void enter(const SeenPoints& seen)
  {
    if (entered_ == kMostEntered) {
      forgetUnused();
    }
    seen_[entered_++] = seen;
  }

  /// \param point its number in the block entered last
  void add(float squared_distance, std::size_t point)
  {
    std::uint64_t key = sortKey(squared_distance, static_cast<std::uint32_t>((entered_ - 1) << kPointBits | point));
    for (std::size_t i = 0; i < k_; ++i) {
      // An exchange, or none, without a branch: which of them it is cannot be foreseen.
      const std::uint64_t difference =
          (keys_[i] ^ key) & (std::uint64_t{0} - static_cast<std::uint64_t>(key < keys_[i]));
      keys_[i] ^= difference;
      key ^= difference;
    }
  }

  /// \param pointOf gives the point of a number in a block
  template <typename PointOf>
  void write(Neighbors& neighbors, PointOf pointOf) const
  {
    neighbors.count = 0;
    for (std::size_t i = 0; i < k_ && numberOf(keys_[i]) != kNobody; ++i) {
      const SeenPoints& seen = seen_[numberOf(keys_[i]) >> kPointBits];
      const Eigen::Vector3f offset = seen.corner + (seen.block->*pointOf)(numberOf(keys_[i]) & kPointMask);
      neighbors.neighbor[i] = {offset, offset.squaredNorm()};
      ++neighbors.count;
    }
  }

private:
  static constexpr std::uint32_t kNobody = 0xFFFFFFFF;
  static constexpr std::uint32_t kPointBits = 18;  ///< blocks have at most 64^3 voxels
  static constexpr std::uint32_t kPointMask = (1U << kPointBits) - 1;
  static constexpr std::size_t kMostEntered = 64;

  static std::uint32_t numberOf(std::uint64_t key) { return static_cast<std::uint32_t>(key); }

  /// Of many blocks, keeps those of the nearest points.
  void forgetUnused()
  {
    std::array<bool, kMostEntered> used{};
    for (std::size_t i = 0; i < k_; ++i) {
      if (numberOf(keys_[i]) != kNobody) {
        used[numberOf(keys_[i]) >> kPointBits] = true;
      }
    }
    std::array<std::uint32_t, kMostEntered> place{};
    entered_ = 0;
    for (std::size_t b = 0; b < kMostEntered; ++b) {
      if (used[b]) {
        place[b] = static_cast<std::uint32_t>(entered_);
        seen_[entered_++] = seen_[b];
      }
    }
    for (std::size_t i = 0; i < k_; ++i) {
      const std::uint32_t number = numberOf(keys_[i]);
      if (number != kNobody) {
        keys_[i] = (keys_[i] >> 32 << 32) | (place[number >> kPointBits] << kPointBits) | (number & kPointMask);
      }
    }
  }

  std::size_t k_;
  std::size_t entered_ = 0;
  std::array<std::uint64_t, kMaxNeighbors> keys_;  // NOLINT(cppcoreguidelines-pro-type-member-init): the first k are
  std::array<SeenPoints, kMostEntered> seen_;      // NOLINT(cppcoreguidelines-pro-type-member-init): as entered
};

}  // namespace pcl_floam
