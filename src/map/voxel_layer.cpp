#include "map/voxel_layer.h"

#include "common/prefetch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_floam {

namespace {

constexpr std::int32_t kNone = VoxelBlock::kNone;

std::uint32_t tagOf(std::uint64_t hash)
{
  return static_cast<std::uint32_t>(hash);
}

/// The product's high bits depend on all of the key.
std::size_t placeOf(std::uint64_t hash, std::size_t mask)
{
  return static_cast<std::size_t>(hash >> 32) & mask;
}

std::uint64_t hashOf(const BlockKey& key)
{
  // Three odd 64-bit constants; the high bits, which depend on all of the input, are folded onto the low ones.
  std::uint64_t h = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.x)) * 0x9E3779B97F4A7C15ULL;
  h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.y)) * 0xC2B2AE3D27D4EB4FULL;
  h ^= static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.z)) * 0x165667B19E3779F9ULL;
  h ^= h >> 32;
  return h * 0x9E3779B97F4A7C15ULL;
}

/// Block numbers stay below this, with room to step to neighbours: 32 bits hold twice as many.
constexpr double kMaxBlockNumber = 1e9;

/// As many voxels along a block's edge as make it a metre: neighbours are searched about that far.
int voxelsPerAxis(double voxel_size)
{
  constexpr double kBlock = 1.0;  // m
  constexpr double kMost = 64.0;
  return static_cast<int>(std::clamp(std::ceil(kBlock / voxel_size - 1e-6), 1.0, kMost));
}

}  // namespace

VoxelLayer::VoxelLayer(double voxel_size)
    : voxels_per_axis_(voxelsPerAxis(voxel_size)),
      voxel_size_(static_cast<float>(voxel_size)),
      block_size_(voxel_size * voxels_per_axis_)
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
  return {key, (query - block_size_ * Eigen::Vector3d(key.x, key.y, key.z)).cast<float>(), 0.0F};
}

std::uint32_t VoxelLayer::voxelAt(const Eigen::Vector3f& offset) const
{
  int voxel = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const int cell = static_cast<int>(offset[axis] / voxel_size_);
    voxel = voxel * voxels_per_axis_ + std::clamp(cell, 0, voxels_per_axis_ - 1);
  }
  return static_cast<std::uint32_t>(voxel);
}

std::int32_t VoxelLayer::findBlock(const BlockKey& key) const
{
  const std::size_t mask = table_.size() - 1;
  const std::uint64_t hash = hashOf(key);
  for (std::size_t place = placeOf(hash, mask);; place = (place + 1) & mask) {
    const Entry& entry = table_[place];
    if (entry.block == kNone ||
        (entry.tag == tagOf(hash) && blocks_[static_cast<std::size_t>(entry.block)].key == key)) {
      return entry.block;
    }
  }
}

void VoxelLayer::prefetchEntry(const BlockKey& key) const
{
  prefetch(&table_[placeOf(hashOf(key), table_.size() - 1)], 1);
}

void VoxelLayer::enterInTable(std::int32_t block)
{
  const std::size_t mask = table_.size() - 1;
  const std::uint64_t hash = hashOf(blocks_[static_cast<std::size_t>(block)].key);
  std::size_t place = placeOf(hash, mask);
  while (table_[place].block != kNone) {
    place = (place + 1) & mask;
  }
  table_[place] = {tagOf(hash), block};
}

void VoxelLayer::rebuildTable(std::size_t capacity)
{
  table_.assign(capacity, Entry());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    enterInTable(static_cast<std::int32_t>(b));
  }
}

void VoxelLayer::link(std::int32_t block)
{
  VoxelBlock& self = blocks_[static_cast<std::size_t>(block)];
  std::size_t place = 0;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx, ++place) {
        const std::int32_t other = findBlock({self.key.x + dx, self.key.y + dy, self.key.z + dz});
        self.around[place] = other;
        if (other != kNone) {
          blocks_[static_cast<std::size_t>(other)].around[VoxelBlock::kAround - 1 - place] = block;
        }
      }
    }
  }
}

std::int32_t VoxelLayer::findOrAddBlock(const BlockKey& key)
{
  const std::int32_t found = findBlock(key);
  if (found != kNone) {
    return found;
  }
  const auto added = static_cast<std::int32_t>(blocks_.size());
  blocks_.emplace_back(key);
  if (blocks_.size() * 2 > table_.size()) {
    rebuildTable(table_.size() * 2);
  } else {
    enterInTable(added);
  }
  link(added);
  return added;
}

void VoxelLayer::insert(const Eigen::Vector3d& point)
{
  insertEach(&point, 1);
}

void VoxelLayer::insertMean(const Eigen::Vector3d& point, float intensity)
{
  if (isRepresentable(point)) {
    const BlockQuery place = blockQuery(point);
    VoxelBlock& block = blocks_[static_cast<std::size_t>(findOrAddBlock(place.key))];
    size_ += block.add(voxelAt(place.offset), place.offset, intensity, VoxelBlock::kMaxAveraged) ? 1 : 0;
  }
}

void VoxelLayer::insertEach(const Eigen::Vector3d* points, std::size_t count, int threads, const float* intensities)
{
  if (threads > 1) {
    insertShared(points, intensities, count, threads);
  } else {
    insertInTurn(points, intensities, count);
  }
}

void VoxelLayer::insertShared(const Eigen::Vector3d* points, const float* intensities, std::size_t count, int threads)
{
  constexpr std::int32_t kNowhere = kNone - 1;
  constexpr std::size_t kAhead = 8;
  std::vector<BlockQuery> places(count);
  std::vector<std::int32_t> blocks(count);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(count); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const bool representable = isRepresentable(points[i]);
    places[i] = representable ? blockQuery(points[i]) : BlockQuery{};
    places[i].intensity = intensities != nullptr ? intensities[i] : 0.0F;
    blocks[i] = representable ? findBlock(places[i].key) : kNowhere;
  }
  for (std::size_t i = 0; i < count; ++i) {
    blocks[i] = blocks[i] == kNone ? findOrAddBlock(places[i].key) : blocks[i];
  }
  // Each block belongs to one thread, which takes the block's points in their order.
  std::vector<std::int32_t> owners(count);
  std::transform(blocks.begin(), blocks.end(), owners.begin(),
                 [threads](std::int32_t block) { return block >= 0 ? block % threads : kNone; });
  std::size_t added = 0;
#pragma omp parallel for num_threads(threads) schedule(static, 1) reduction(+ : added)
  for (int thread = 0; thread < threads; ++thread) {
    for (std::size_t i = 0; i < count; ++i) {
      if (i + kAhead < count && owners[i + kAhead] == thread) {
        prefetch(&blocks_[static_cast<std::size_t>(blocks[i + kAhead])], sizeof(VoxelBlock));
      }
      if (owners[i] == thread) {
        VoxelBlock& block = blocks_[static_cast<std::size_t>(blocks[i])];
        added += block.add(voxelAt(places[i].offset), places[i].offset, places[i].intensity) ? 1 : 0;
      }
    }
  }
  size_ += added;
}

void VoxelLayer::insertInTurn(const Eigen::Vector3d* points, const float* intensities, std::size_t count)
{
  constexpr std::size_t kTogether = 16;
  std::array<BlockQuery, kTogether> places;
  std::array<std::int32_t, kTogether> blocks;
  for (std::size_t first = 0; first < count; first += kTogether) {
    std::size_t together = 0;
    for (std::size_t i = first; i < std::min(first + kTogether, count); ++i) {
      if (isRepresentable(points[i])) {
        places[together] = blockQuery(points[i]);
        places[together].intensity = intensities != nullptr ? intensities[i] : 0.0F;
        prefetchEntry(places[together].key);
        ++together;
      }
    }
    for (std::size_t i = 0; i < together; ++i) {
      blocks[i] = findBlock(places[i].key);
      if (blocks[i] != kNone) {
        prefetch(&blocks_[static_cast<std::size_t>(blocks[i])], sizeof(VoxelBlock));
      }
    }
    for (std::size_t i = 0; i < together; ++i) {
      // One that was not there may have been added for a point just before.
      const std::int32_t block = blocks[i] != kNone ? blocks[i] : findOrAddBlock(places[i].key);
      const BlockQuery& place = places[i];
      size_ += blocks_[static_cast<std::size_t>(block)].add(voxelAt(place.offset), place.offset, place.intensity);
    }
  }
}

void VoxelLayer::crop(const Eigen::Vector3d& center, double radius)
{
  const auto isFar = [&](const VoxelBlock& block) {
    const Eigen::Vector3d middle =
        block_size_ * (Eigen::Vector3d(block.key.x, block.key.y, block.key.z).array() + 0.5).matrix();
    return (middle - center).squaredNorm() > radius * radius;
  };
  // Where each block goes; those that stay keep their order.
  std::vector<std::int32_t> moved(blocks_.size(), kNone);
  std::int32_t kept = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!isFar(blocks_[b])) {
      moved[b] = kept++;
    }
  }
  if (static_cast<std::size_t>(kept) == blocks_.size()) {
    return;
  }
  blocks_.erase(std::remove_if(blocks_.begin(), blocks_.end(), isFar), blocks_.end());
  rebuildTable(table_.size());
  size_ = 0;
  for (VoxelBlock& block : blocks_) {
    size_ += block.size();
    for (std::int32_t& other : block.around) {
      other = other == kNone ? kNone : moved[static_cast<std::size_t>(other)];
    }
  }
}

std::size_t VoxelLayer::weakenSeenThrough(const RangeImage& scan, const SE3& world_T_sensor, double radius, int threads)
{
  // A voxel that was hit often, as that of a car that was parked for a while, takes more than one such scan.
  constexpr float kWeight = 10.0F;
  const SE3 sensor_T_world = world_T_sensor.inverse();
  const Eigen::Matrix3f rotation = sensor_T_world.rotation.cast<float>();
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(static_cast<float>(0.5 * block_size_));
  std::size_t forgotten = 0;
#pragma omp parallel for num_threads(std::max(threads, 1)) schedule(dynamic, 64) reduction(+ : forgotten)
  for (std::ptrdiff_t b = 0; b < static_cast<std::ptrdiff_t>(blocks_.size()); ++b) {
    VoxelBlock& block = blocks_[static_cast<std::size_t>(b)];
    const Eigen::Vector3d corner = block_size_ * Eigen::Vector3d(block.key.x, block.key.y, block.key.z);
    const Eigen::Vector3d middle = corner.array() + 0.5 * block_size_;
    if ((middle - world_T_sensor.translation).squaredNorm() > radius * radius) {
      continue;
    }
    const Eigen::Vector3f corner_in_sensor = (sensor_T_world * corner).cast<float>();
    if (!scan.maySeeThrough(corner_in_sensor + rotation * half, half.norm())) {
      continue;
    }
    for (std::size_t i = 0; i < block.size();) {
      const bool stays = !scan.seesThrough(corner_in_sensor + rotation * block.point(i)) || block.weaken(i, kWeight);
      i += stays ? 1 : 0;
      forgotten += stays ? 0 : 1;
    }
  }
  size_ -= forgotten;
  return forgotten;
}

void VoxelLayer::clear()
{
  blocks_.clear();
  size_ = 0;
  rebuildTable(1024);
}

std::vector<float> VoxelLayer::intensities() const
{
  std::vector<float> intensities;
  intensities.reserve(size_);
  for (const VoxelBlock& block : blocks_) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      intensities.push_back(block.intensity(i));
    }
  }
  return intensities;
}

std::vector<Eigen::Vector3d> VoxelLayer::points() const
{
  std::vector<Eigen::Vector3d> points;
  points.reserve(size_);
  for (const VoxelBlock& block : blocks_) {
    const Eigen::Vector3d corner = block_size_ * Eigen::Vector3d(block.key.x, block.key.y, block.key.z);
    for (std::size_t i = 0; i < block.size(); ++i) {
      points.push_back(corner + block.point(i).cast<double>());
    }
  }
  return points;
}

}  // namespace pcl_floam
