#include "map/voxel_cells.h"

#include <algorithm>
#include <limits>

namespace pcl_floam {

namespace {

/// Which of its parent's eight children a cell is.
unsigned octantIn(const VoxelKey& key)
{
  return static_cast<unsigned>(key.x & 1) | static_cast<unsigned>(key.y & 1) << 1U |
         static_cast<unsigned>(key.z & 1) << 2U;
}

VoxelKey childOf(const VoxelKey& key, unsigned octant)
{
  const auto half = [octant](std::int32_t v, unsigned bit) {
    return 2 * v + static_cast<std::int32_t>((octant >> bit) & 1U);
  };
  return {half(key.x, 0), half(key.y, 1), half(key.z, 2)};
}

}  // namespace

VoxelCells::Found VoxelCells::finestAt(const VoxelKey& finest) const
{
  Found found;
  for (; found.level < kLevels; ++found.level) {
    found.cell = find(finest.above(found.level), found.level);
    if (found.cell != 0) {
      break;
    }
  }
  return found;
}

std::uint32_t VoxelCells::make(const VoxelKey& finest, int level)
{
  const VoxelKey key = finest.above(level);
  const std::uint32_t cell = cells_.take();
  contents_.take();  // of the same number: both pools are asked alike
  if (level == kLevels - 1) {
    blocks_.push_back({key, cell});
  } else {
    std::uint32_t parent = find(finest.above(level + 1), level + 1);
    parent = parent == 0 ? make(finest, level + 1) : parent;
    cells_[cell].parent = parent;
    contents_[parent].child[octantIn(key)] = cell;
  }
  if (level == 0) {
    contents_[cell].child[0] = leaves_.take();
  }
  table_[key.packed(level)] = cell;
  return cell;
}

void VoxelCells::add(std::uint32_t cell, const Eigen::Vector3f& point, std::uint32_t laser)
{
  leaves_[contents_[cell].child[0]].add(point);
  const Eigen::Vector3d p = point.cast<double>();
  for (; cell != 0; cell = cells_[cell].parent) {
    constexpr int kMost = std::numeric_limits<std::uint16_t>::max();
    CellSums& sums = contents_[cell].sums;
    sums.add(p, laser);
    cells_[cell].count = static_cast<std::uint16_t>(std::min(sums.points.count(), kMost));
    cells_[cell].state.store(kStale, std::memory_order_relaxed);
  }
}

void VoxelCells::release(std::uint32_t cell, const VoxelKey& key, int level)
{
  const std::array<std::uint32_t, 8>& children = contents_[cell].child;
  if (level == 0) {
    leaves_.release(children[0]);
  } else {
    for (unsigned i = 0; i < 8; ++i) {
      if (children[i] != 0) {
        release(children[i], childOf(key, i), level - 1);
      }
    }
  }
  table_.erase(key.packed(level));
  cells_.release(cell);
  contents_.release(cell);
}

void VoxelCells::clear()
{
  cells_.clear();
  contents_.clear();
  leaves_.clear();
  table_.clear();
  blocks_.clear();
}

}  // namespace pcl_floam
