#include "map/voxel_layer.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// A voxel's mean takes in no more points than this: later ones keep moving it, so that it can follow the world.
constexpr float kMaxAveraged = 20.0F;

std::size_t hashOf(const BlockKey& key)
{
  // Three odd 64-bit constants; the high bits, which depend on all of the input, are folded onto the low ones.
  std::uint64_t h = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.x)) * 0x9E3779B97F4A7C15ULL;
  h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.y)) * 0xC2B2AE3D27D4EB4FULL;
  h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.z)) * 0x165667B19E3779F9ULL;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

/// Block numbers stay below this, with room to step to neighbours: 32 bits hold twice as many.
constexpr double kMaxBlockNumber = 1e9;

/// Squared distance along one axis from a coordinate to the interval [low, low + size].
float squaredGap(float coordinate, float low, float size)
{
  const float gap = std::max({low - coordinate, coordinate - low - size, 0.0F});
  return gap * gap;
}

}  // namespace

VoxelLayer::VoxelLayer(double voxel_size)
    : block_size_(voxel_size * kVoxelsPerAxis), voxel_size_(static_cast<float>(voxel_size))
{
  rebuildTable(1024);
}

bool VoxelLayer::isRepresentable(const Eigen::Vector3d& point) const
{
  return (point.array().abs() < kMaxBlockNumber * block_size_).all();  // false for NaN, too
}

BlockKey VoxelLayer::keyOf(const Eigen::Vector3d& point) const
{
  return {static_cast<std::int32_t>(std::floor(point.x() / block_size_)),
          static_cast<std::int32_t>(std::floor(point.y() / block_size_)),
          static_cast<std::int32_t>(std::floor(point.z() / block_size_))};
}

VoxelLayer::BlockQuery VoxelLayer::blockQuery(const Eigen::Vector3d& query) const
{
  const BlockKey key = keyOf(query);
  // In double: the subtraction takes away the kilometres, what is left fits a float.
  return {key, (query - block_size_ * Eigen::Vector3d(key.x, key.y, key.z)).cast<float>()};
}

std::int32_t VoxelLayer::findBlock(const BlockKey& key) const
{
  const std::size_t mask = table_.size() - 1;
  for (std::size_t place = hashOf(key) & mask;; place = (place + 1) & mask) {
    const std::int32_t block = table_[place];
    if (block == kEmpty || blocks_[static_cast<std::size_t>(block)].key == key) {
      return block;
    }
  }
}

void VoxelLayer::rebuildTable(std::size_t capacity)
{
  table_.assign(capacity, kEmpty);
  const std::size_t mask = capacity - 1;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    std::size_t place = hashOf(blocks_[b].key) & mask;
    while (table_[place] != kEmpty) {
      place = (place + 1) & mask;
    }
    table_[place] = static_cast<std::int32_t>(b);
  }
}

std::int32_t VoxelLayer::findOrAddBlock(const BlockKey& key)
{
  const std::int32_t found = findBlock(key);
  if (found != kEmpty) {
    return found;
  }
  blocks_.emplace_back();
  blocks_.back().key = key;
  blocks_.back().slot.fill(kEmpty);
  if (blocks_.size() * 2 > table_.size()) {
    rebuildTable(table_.size() * 2);
  } else {
    const std::size_t mask = table_.size() - 1;
    std::size_t place = hashOf(key) & mask;
    while (table_[place] != kEmpty) {
      place = (place + 1) & mask;
    }
    table_[place] = static_cast<std::int32_t>(blocks_.size()) - 1;
  }
  return static_cast<std::int32_t>(blocks_.size()) - 1;
}

void VoxelLayer::insert(const Eigen::Vector3d& point)
{
  if (!isRepresentable(point)) {
    return;
  }
  const BlockQuery place = blockQuery(point);
  Block& block = blocks_[static_cast<std::size_t>(findOrAddBlock(place.key))];
  int voxel = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const int cell = static_cast<int>(place.offset[axis] / voxel_size_);
    voxel = voxel * kVoxelsPerAxis + std::clamp(cell, 0, kVoxelsPerAxis - 1);
  }
  std::int8_t& slot = block.slot[static_cast<std::size_t>(voxel)];
  if (slot == kEmpty) {
    slot = static_cast<std::int8_t>(block.points.size());
    block.points.push_back({place.offset.x(), place.offset.y(), place.offset.z(), 1.0F});
    ++size_;
    return;
  }
  VoxelPoint& mean = block.points[static_cast<std::size_t>(slot)];
  mean.count = std::min(mean.count + 1.0F, kMaxAveraged);
  mean.x += (place.offset.x() - mean.x) / mean.count;
  mean.y += (place.offset.y() - mean.y) / mean.count;
  mean.z += (place.offset.z() - mean.z) / mean.count;
}

void VoxelLayer::crop(const Eigen::Vector3d& center, double radius)
{
  const auto isFar = [&](const Block& block) {
    const Eigen::Vector3d middle =
        block_size_ * (Eigen::Vector3d(block.key.x, block.key.y, block.key.z).array() + 0.5).matrix();
    return (middle - center).squaredNorm() > radius * radius;
  };
  const auto far_begin = std::remove_if(blocks_.begin(), blocks_.end(), isFar);
  if (far_begin == blocks_.end()) {
    return;
  }
  blocks_.erase(far_begin, blocks_.end());
  size_ = 0;
  for (const Block& block : blocks_) {
    size_ += block.points.size();
  }
  rebuildTable(table_.size());
}

void VoxelLayer::clear()
{
  blocks_.clear();
  size_ = 0;
  rebuildTable(1024);
}

std::vector<Eigen::Vector3d> VoxelLayer::points() const
{
  std::vector<Eigen::Vector3d> points;
  points.reserve(size_);
  for (const Block& block : blocks_) {
    const Eigen::Vector3d corner = block_size_ * Eigen::Vector3d(block.key.x, block.key.y, block.key.z);
    for (const VoxelPoint& point : block.points) {
      points.push_back(corner + Eigen::Vector3d(point.x, point.y, point.z));
    }
  }
  return points;
}

template <typename Visit>
void VoxelLayer::visitBlocks(const Eigen::Vector3d& query, double radius, const float& squared_limit,
                             Visit&& visit) const
{
  const BlockQuery center = blockQuery(query);
  const auto size = static_cast<float>(block_size_);
  const auto cornerOf = [&](double dx, double dy, double dz) {
    return Eigen::Vector3f(static_cast<float>(dx) * size, static_cast<float>(dy) * size, static_cast<float>(dz) * size);
  };
  const auto isNear = [&](const Eigen::Vector3f& corner) {
    return squaredGap(center.offset.x(), corner.x(), size) + squaredGap(center.offset.y(), corner.y(), size) +
               squaredGap(center.offset.z(), corner.z(), size) <=
           squared_limit;
  };
  const double reach = std::ceil(radius / block_size_);
  if (std::pow(2.0 * reach + 1.0, 3.0) >= static_cast<double>(blocks_.size())) {
    for (const Block& block : blocks_) {  // fewer blocks than places where one could be
      const Eigen::Vector3f corner =
          cornerOf(static_cast<double>(block.key.x) - center.key.x, static_cast<double>(block.key.y) - center.key.y,
                   static_cast<double>(block.key.z) - center.key.z);
      if (isNear(corner)) {
        visit(Eigen::Vector3f(corner - center.offset), block);
      }
    }
    return;
  }
  const auto visitOne = [&](int dx, int dy, int dz) {
    const Eigen::Vector3f corner = cornerOf(dx, dy, dz);
    if (!isNear(corner)) {
      return;
    }
    const std::int32_t block = findBlock({center.key.x + dx, center.key.y + dy, center.key.z + dz});
    if (block != kEmpty) {
      visit(Eigen::Vector3f(corner - center.offset), blocks_[static_cast<std::size_t>(block)]);
    }
  };
  visitOne(0, 0, 0);
  for (int ring = 1; ring <= static_cast<int>(reach); ++ring) {
    for (int dz = -ring; dz <= ring; ++dz) {
      for (int dy = -ring; dy <= ring; ++dy) {
        // Inside the shell's faces only the two ends of the row belong to this ring.
        const bool on_face = std::abs(dz) == ring || std::abs(dy) == ring;
        for (int dx = -ring; dx <= ring; dx += on_face ? 1 : 2 * ring) {
          visitOne(dx, dy, dz);
        }
      }
    }
  }
}

void VoxelLayer::nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const
{
  neighbors.count = 0;
  if (!isRepresentable(query)) {
    return;
  }
  auto limit = static_cast<float>(radius * radius);
  visitBlocks(query, radius, limit, [&](const Eigen::Vector3f& corner, const Block& block) {
    for (const VoxelPoint& point : block.points) {
      const Eigen::Vector3f offset(corner.x() + point.x, corner.y() + point.y, corner.z() + point.z);
      const float distance2 = offset.squaredNorm();
      if (distance2 > limit || (neighbors.count == k && distance2 == limit)) {
        continue;
      }
      int place = neighbors.count < k ? neighbors.count++ : k - 1;
      for (; place > 0 && neighbors[place - 1].squared_distance > distance2; --place) {
        neighbors.neighbor[static_cast<std::size_t>(place)] = neighbors[place - 1];
      }
      neighbors.neighbor[static_cast<std::size_t>(place)] = {offset, distance2};
      if (neighbors.count == k) {
        limit = neighbors[k - 1].squared_distance;
      }
    }
  });
}

void VoxelLayer::within(const Eigen::Vector3d& query, double radius, std::vector<Neighbor>& neighbors) const
{
  neighbors.clear();
  if (!isRepresentable(query)) {
    return;
  }
  const auto limit = static_cast<float>(radius * radius);
  visitBlocks(query, radius, limit, [&](const Eigen::Vector3f& corner, const Block& block) {
    for (const VoxelPoint& point : block.points) {
      const Eigen::Vector3f offset(corner.x() + point.x, corner.y() + point.y, corner.z() + point.z);
      if (offset.squaredNorm() <= limit) {
        neighbors.push_back({offset, offset.squaredNorm()});
      }
    }
  });
}

}  // namespace pcl_floam
