#include "map/voxel_pyramid.h"

#include "common/prefetch.h"

#include <algorithm>

namespace pcl_floam {

VoxelPyramid::VoxelPyramid(double side)
    : side_(side), inverse_side_(1.0 / side), squared_spacing_(static_cast<float>(side * side / kPointsPerLeaf))
{
}

Eigen::Vector3d VoxelPyramid::centerOfBlock(const VoxelKey& block) const
{
  return sideOf(kLevels - 1) * Eigen::Vector3d(block.x + 0.5, block.y + 0.5, block.z + 0.5);
}

/// \return false where no map reaches
bool VoxelPyramid::findPlace(const Eigen::Vector3d& point, Place& place) const
{
  if (!findKey(point, inverse_side_, place.key)) {
    return false;
  }
  place.offset = point - centerOfBlock(place.block());
  return true;
}

/// Some at a time, as in \ref find.
void VoxelPyramid::insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count)
{
  std::array<Place, kAtOnce> place;
  std::array<std::uint32_t, kAtOnce> laser{};
  std::array<std::uint32_t, kAtOnce> cell{};
  for (std::size_t begin = 0; begin < count; begin += kAtOnce) {
    std::size_t n = 0;
    for (std::size_t i = begin; i < std::min(count, begin + kAtOnce); ++i) {
      if (findPlace(places[i], place[n])) {
        cells_.expect(place[n].key);
        laser[n++] = lasers[i];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      cell[i] = cells_.find(place[i].key, 0);
      if (cell[i] != 0) {
        prefetch(&cells_[cell[i]], sizeof(VoxelCells::Cell));
        prefetch(&cells_.content(cell[i]).child[0], sizeof(std::uint32_t));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (cell[i] != 0 && cells_[cell[i]].count < kPointsPerLeaf) {
        prefetch(&cells_.leaf(cell[i]), sizeof(Leaf));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      insert(place[i], cell[i] != 0 ? cell[i] : cells_.find(place[i].key, 0), laser[i]);
    }
  }
}

/// \param cell the finest one there; 0: there is none yet
void VoxelPyramid::insert(const Place& place, std::uint32_t cell, std::uint32_t laser)
{
  if (cell == 0) {
    cell = cells_.make(place.key);
  }
  const Eigen::Vector3f point = place.offset.cast<float>();
  if (cells_[cell].count < kPointsPerLeaf && !isNear(cells_.leaf(cell), point)) {
    cells_.add(cell, point, laser);
    ++points_;
  }
}

void VoxelPyramid::crop(const Eigen::Vector3d& center, double radius)
{
  points_ -= cells_.drop([&](const VoxelKey& block) { return (centerOfBlock(block) - center).norm() > radius; });
}

void VoxelPyramid::clear()
{
  points_ = 0;
  cells_.clear();
}

}  // namespace pcl_floam
