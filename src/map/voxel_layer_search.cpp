// Nearest neighbours in a layer of the map.
#include "map/voxel_layer.h"

#include "common/prefetch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace pcl_floam {

namespace {

/// Squared distance along one axis from a coordinate to the interval [low, low + size].
float squaredGap(float coordinate, float low, float size)
{
  const float gap = std::max({low - coordinate, coordinate - low - size, 0.0F});
  return gap * gap;
}

/// Squared distances along one axis from a query within a block to the block before, to its own, to the one after.
std::array<float, 3> squaredGaps(float offset, float size)
{
  const float after = std::max(size - offset, 0.0F);
  const float before = std::max(offset, 0.0F);
  return {before * before, 0.0F, after * after};
}

/// The steps -1, 0, 1 along one axis in the order of their distance.
std::array<int, 3> nearestFirst(float offset, float size)
{
  return 2.0F * offset < size ? std::array<int, 3>{0, -1, 1} : std::array<int, 3>{0, 1, -1};
}

}  // namespace

void VoxelLayer::searchAround(const BlockQuery& query, std::int32_t home, NearestSoFar& nearest) const
{
  const auto size = static_cast<float>(block_size_);
  const auto gap_x = squaredGaps(query.offset.x(), size);
  const auto gap_y = squaredGaps(query.offset.y(), size);
  const auto gap_z = squaredGaps(query.offset.z(), size);
  const auto step_x = nearestFirst(query.offset.x(), size);
  const auto step_y = nearestFirst(query.offset.y(), size);
  const auto step_z = nearestFirst(query.offset.z(), size);
  const auto along = [](const std::array<float, 3>& gaps, int step) {
    return gaps[static_cast<std::size_t>(1L + step)];
  };
  for (const int dz : step_z) {
    for (const int dy : step_y) {
      const float gap_yz = along(gap_y, dy) + along(gap_z, dz);
      if (gap_yz > nearest.limit()) {
        continue;
      }
      for (const int dx : step_x) {
        if (along(gap_x, dx) + gap_yz > nearest.limit()) {
          continue;
        }
        const auto place = static_cast<std::size_t>(13L + 9L * dz + 3L * dy + dx);
        const std::int32_t block = home != VoxelBlock::kNone
                                       ? blocks_[static_cast<std::size_t>(home)].around[place]
                                       : findBlock({query.key.x + dx, query.key.y + dy, query.key.z + dz});
        if (block != VoxelBlock::kNone) {
          const Eigen::Vector3f corner(static_cast<float>(dx) * size, static_cast<float>(dy) * size,
                                       static_cast<float>(dz) * size);
          blocks_[static_cast<std::size_t>(block)].search(corner - query.offset, nearest);
        }
      }
    }
  }
}

void VoxelLayer::searchWide(const BlockQuery& query, double radius, NearestSoFar& nearest) const
{
  const auto size = static_cast<float>(block_size_);
  const auto search = [&](const VoxelKey& key, const VoxelBlock* block) {
    const Eigen::Vector3f corner(static_cast<float>(static_cast<double>(key.x) - query.key.x) * size,
                                 static_cast<float>(static_cast<double>(key.y) - query.key.y) * size,
                                 static_cast<float>(static_cast<double>(key.z) - query.key.z) * size);
    if (squaredGap(query.offset.x(), corner.x(), size) + squaredGap(query.offset.y(), corner.y(), size) +
            squaredGap(query.offset.z(), corner.z(), size) >
        nearest.limit()) {
      return;
    }
    const std::int32_t found = block == nullptr ? findBlock(key) : VoxelBlock::kNone;
    if (found != VoxelBlock::kNone) {
      block = &blocks_[static_cast<std::size_t>(found)];
    }
    if (block != nullptr) {
      block->search(corner - query.offset, nearest);
    }
  };
  const double reach = std::ceil(radius / block_size_);
  if (std::pow(2.0 * reach + 1.0, 3.0) >= static_cast<double>(numbers_.size())) {
    for (const VoxelBlock& block : blocks_) {  // fewer blocks than places where one could be
      if (block.isUsed()) {
        search(block.key, &block);
      }
    }
    return;
  }
  for (int ring = 0; ring <= static_cast<int>(reach); ++ring) {
    for (int dz = -ring; dz <= ring; ++dz) {
      for (int dy = -ring; dy <= ring; ++dy) {
        // Inside the shell's faces only the two ends of the row belong to this ring.
        const bool on_face = std::abs(dz) == ring || std::abs(dy) == ring;
        for (int dx = -ring; dx <= ring; dx += on_face ? 1 : 2 * ring) {
          search({query.key.x + dx, query.key.y + dy, query.key.z + dz}, nullptr);
        }
      }
    }
  }
}

void VoxelLayer::nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const
{
  nearestOfEach(&query, 1, k, radius, &neighbors);
}

void VoxelLayer::nearestOfEach(const Eigen::Vector3d* queries, std::size_t count, int k, double radius,
                               Neighbors* neighbors) const
{
  // Most of a search's time is waiting for memory. So each step is taken for some queries at once, and asks for what
  // the next one will read.
  constexpr std::size_t kTogether = 16;
  std::array<BlockQuery, kTogether> places;
  std::array<bool, kTogether> is_there{};
  std::array<std::int32_t, kTogether> homes;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t together = std::min(kTogether, count - first);
    for (std::size_t i = 0; i < together; ++i) {
      is_there[i] = findPlace(queries[first + i], places[i]);
      numbers_.expect(places[i].key.packed(0));
    }
    for (std::size_t i = 0; i < together; ++i) {
      homes[i] = is_there[i] ? findBlock(places[i].key) : VoxelBlock::kNone;
      if (homes[i] != VoxelBlock::kNone) {
        prefetch(&blocks_[static_cast<std::size_t>(homes[i])], sizeof(VoxelBlock));
      }
    }
    for (std::size_t i = 0; i < together; ++i) {
      if (homes[i] != VoxelBlock::kNone) {
        blocks_[static_cast<std::size_t>(homes[i])].prefetchPoints();
      }
    }
    for (std::size_t i = 0; i < together; ++i) {
      neighbors[first + i].count = 0;
      if (is_there[i]) {
        NearestSoFar nearest(k, static_cast<float>(radius * radius));
        if (radius <= block_size_) {
          searchAround(places[i], homes[i], nearest);
        } else {
          searchWide(places[i], radius, nearest);
        }
        nearest.write(neighbors[first + i], &VoxelBlock::point);
      }
    }
  }
}

}  // namespace pcl_floam
