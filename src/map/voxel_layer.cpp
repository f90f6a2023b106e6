#include "map/voxel_layer.h"

#include "common/prefetch.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

constexpr std::int32_t kNone = VoxelBlock::kNone;

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
      inverse_voxel_size_(static_cast<float>(1.0 / voxel_size)),
      block_size_(voxel_size * voxels_per_axis_),
      inverse_block_size_(1.0 / block_size_)
{
}

VoxelLayer::VoxelLayer(const VoxelLayer& other)
    : voxels_per_axis_(other.voxels_per_axis_),
      inverse_voxel_size_(other.inverse_voxel_size_),
      block_size_(other.block_size_),
      inverse_block_size_(other.inverse_block_size_),
      blocks_(other.blocks_, &memory_),
      numbers_(other.numbers_),
      free_(other.free_),
      size_(other.size_)
{
}

bool VoxelLayer::findPlace(const Eigen::Vector3d& point, BlockQuery& place) const
{
  if (!findKey(point, inverse_block_size_, place.key)) {
    return false;
  }
  // In double: the subtraction takes away the kilometres, what is left fits a float.
  place.offset = (point - cornerOf(place.key)).cast<float>();
  return true;
}

std::uint32_t VoxelLayer::voxelAt(const Eigen::Vector3f& offset) const
{
  int voxel = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const int cell = static_cast<int>(offset[axis] * inverse_voxel_size_);
    voxel = voxel * voxels_per_axis_ + std::clamp(cell, 0, voxels_per_axis_ - 1);
  }
  return static_cast<std::uint32_t>(voxel);
}

std::int32_t VoxelLayer::findBlock(const VoxelKey& key) const
{
  return static_cast<std::int32_t>(numbers_.find(key.packed(0))) - 1;
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

std::int32_t VoxelLayer::findOrAddBlock(const VoxelKey& key)
{
  const std::int32_t found = findBlock(key);
  if (found != kNone) {
    return found;
  }
  auto added = static_cast<std::int32_t>(blocks_.size());
  if (free_.empty()) {
    blocks_.emplace_back(key);
  } else {
    added = free_.back();
    free_.pop_back();
    blocks_[static_cast<std::size_t>(added)].key = key;
  }
  numbers_[key.packed(0)] = static_cast<std::uint32_t>(added) + 1;
  link(added);
  return added;
}

void VoxelLayer::insertMean(const Eigen::Vector3d& point, float intensity)
{
  BlockQuery place;
  if (findPlace(point, place)) {
    VoxelBlock& block = blocks_[static_cast<std::size_t>(findOrAddBlock(place.key))];
    size_ += block.add(voxelAt(place.offset), place.offset, intensity, VoxelBlock::kMaxAveraged) ? 1 : 0;
  }
}

void VoxelLayer::insertEach(const Eigen::Vector3d* points, std::size_t count, int threads, const float* intensities)
{
  constexpr std::int32_t kNowhere = kNone - 1;
  constexpr std::size_t kAhead = 8;
  places_.resize(count);
  homes_.resize(count);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::size_t i = 0; i < count; ++i) {
    homes_[i] = findPlace(points[i], places_[i]) ? findBlock(places_[i].key) : kNowhere;
    places_[i].intensity = intensities != nullptr ? intensities[i] : 0.0F;
  }
  for (std::size_t i = 0; i < count; ++i) {
    homes_[i] = homes_[i] == kNone ? findOrAddBlock(places_[i].key) : homes_[i];
  }
  // Each block belongs to one thread, which takes the block's points in their order.
  const auto ownerOf = [threads](std::int32_t block) { return block >= 0 ? block % threads : kNone; };
  std::size_t added = 0;
#pragma omp parallel for num_threads(threads) schedule(static, 1) reduction(+ : added)
  for (int thread = 0; thread < threads; ++thread) {
    for (std::size_t i = 0; i < count; ++i) {
      if (i + kAhead < count && ownerOf(homes_[i + kAhead]) == thread) {
        prefetch(&blocks_[static_cast<std::size_t>(homes_[i + kAhead])], sizeof(VoxelBlock));
      }
      if (ownerOf(homes_[i]) == thread) {
        VoxelBlock& block = blocks_[static_cast<std::size_t>(homes_[i])];
        added += block.add(voxelAt(places_[i].offset), places_[i].offset, places_[i].intensity) ? 1 : 0;
      }
    }
  }
  size_ += added;
}

void VoxelLayer::crop(const Eigen::Vector3d& center, double radius)
{
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const VoxelKey& key = blocks_[b].key;
    const Eigen::Vector3d middle = block_size_ * (Eigen::Vector3d(key.x, key.y, key.z).array() + 0.5).matrix();
    if ((middle - center).squaredNorm() > radius * radius && blocks_[b].isUsed()) {
      release(static_cast<std::int32_t>(b));
    }
  }
}

void VoxelLayer::release(std::int32_t block)
{
  VoxelBlock& self = blocks_[static_cast<std::size_t>(block)];
  for (std::size_t place = 0; place < VoxelBlock::kAround; ++place) {
    const std::int32_t other = self.around[place];
    if (other != kNone) {
      blocks_[static_cast<std::size_t>(other)].around[VoxelBlock::kAround - 1 - place] = kNone;
    }
  }
  size_ -= self.size();
  numbers_.erase(self.key.packed(0));
  self.clear();
  free_.push_back(block);
}

std::size_t VoxelLayer::weakenSeenThrough(const RangeImage& scan, const SE3& world_T_sensor, double radius, int threads)
{
  // A voxel that was hit often, as that of a car that was parked for a while, takes more than one such scan.
  constexpr float kWeight = 10.0F;
  const SE3 sensor_T_world = world_T_sensor.inverse();
  const Eigen::Matrix3f rotation = sensor_T_world.rotation.cast<float>();
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(static_cast<float>(0.5 * block_size_));
  const std::size_t count = blocks_.size();
  std::size_t forgotten = 0;
#pragma omp parallel for num_threads(std::max(threads, 1)) schedule(dynamic, 64) reduction(+ : forgotten)
  for (std::size_t b = 0; b < count; ++b) {
    VoxelBlock& block = blocks_[b];
    const Eigen::Vector3d corner = cornerOf(block.key);
    const Eigen::Vector3d middle = corner.array() + 0.5 * block_size_;
    if (!block.isUsed() || (middle - world_T_sensor.translation).squaredNorm() > radius * radius) {
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
  free_.clear();
  size_ = 0;
  numbers_.clear();
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
    const Eigen::Vector3d corner = cornerOf(block.key);
    for (std::size_t i = 0; i < block.size(); ++i) {
      points.push_back(corner + block.point(i).cast<double>());
    }
  }
  return points;
}

}  // namespace pcl_floam
