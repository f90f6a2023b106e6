#include "map/voxel_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {

namespace {

/// Which of a cell's eight children holds an offset from its centre.
unsigned octant(const Eigen::Vector3d& offset)
{
  return (offset.x() >= 0.0 ? 1U : 0U) | (offset.y() >= 0.0 ? 2U : 0U) | (offset.z() >= 0.0 ? 4U : 0U);
}

/// From a cell's centre to that of its child, in halves of the child's side.
Eigen::Vector3d towards(unsigned octant)
{
  return {(octant & 1U) != 0U ? 1.0 : -1.0, (octant & 2U) != 0U ? 1.0 : -1.0, (octant & 4U) != 0U ? 1.0 : -1.0};
}

}  // namespace

VoxelPyramid::VoxelPyramid(double side) : side_(side), squared_spacing_(side * side / kPointsPerLeaf) {}

Eigen::Vector3d VoxelPyramid::centerOf(const BlockKey& key) const
{
  return sideOf(kLevels - 1) * Eigen::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5);
}

VoxelPyramid::Place VoxelPyramid::placeOf(const Eigen::Vector3d& point) const
{
  const BlockKey key = keyOf(point, 1.0 / sideOf(kLevels - 1));
  return {key, point - centerOf(key)};
}

VoxelPyramid::Path VoxelPyramid::makePathTo(const Place& place)
{
  Path path;
  const std::uint64_t key = place.key.packed();
  path.cell[kLevels - 1] = table_.find(key);
  if (path.cell[kLevels - 1] == 0) {
    path.cell[kLevels - 1] = cells_.take();
    table_.insert(key, path.cell[kLevels - 1]);
    blocks_.push_back({place.key, path.cell[kLevels - 1]});
  }
  Eigen::Vector3d offset = place.offset;
  for (std::size_t level = kLevels - 1; level > 0; --level) {
    const unsigned child = octant(offset);
    offset -= 0.5 * sideOf(static_cast<int>(level) - 1) * towards(child);
    std::uint32_t next = cells_[path.cell[level]].child[child];
    if (next == 0) {
      next = cells_.take();
      cells_[path.cell[level]].child[child] = next;
    }
    path.cell[level - 1] = next;
  }
  std::uint32_t& leaf = cells_[path.cell[0]].child[0];
  leaf = leaf == 0 ? leaves_.take() : leaf;
  return path;
}

bool VoxelPyramid::insert(const Eigen::Vector3d& point, std::uint32_t laser)
{
  if (!point.allFinite()) {
    return false;
  }
  const Place place = placeOf(point);
  const Path path = makePathTo(place);
  Leaf& leaf = leaves_[cells_[path.cell[0]].child[0]];
  if (leaf.count >= kPointsPerLeaf ||
      (leaf.count > 0 && (nearestIn(leaf, place.offset) - place.offset).squaredNorm() < squared_spacing_)) {
    return false;
  }
  const Eigen::Vector3f p = place.offset.cast<float>();
  leaf.point[leaf.count++] = {p.x(), p.y(), p.z(), laser};
  ++points_;
  for (const std::uint32_t cell : path.cell) {
    cells_[cell].sums.add(static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()), laser);
    cells_[cell].fit.state.store(CachedFit::stale, std::memory_order_relaxed);
  }
  return true;
}

/// A thread that finds a fit in the making works it out for itself rather than wait.
CellFit VoxelPyramid::fitOf(const Cell& cell)
{
  std::uint8_t state = cell.fit.state.load(std::memory_order_acquire);
  if (state == CachedFit::ready) {
    return cell.fit.fit;
  }
  const CellFit fit = pcl_floam::fitOf(cell.sums);
  if (state == CachedFit::stale && cell.fit.state.compare_exchange_strong(state, CachedFit::being_made)) {
    cell.fit.fit = fit;
    cell.fit.state.store(CachedFit::ready, std::memory_order_release);
  }
  return fit;
}

VoxelPyramid::Path VoxelPyramid::pathTo(const Place& place) const
{
  Path path;
  path.cell[kLevels - 1] = table_.find(place.key.packed());
  Eigen::Vector3d offset = place.offset;
  for (std::size_t level = kLevels - 1; level > 0 && path.cell[level] != 0; --level) {
    const unsigned child = octant(offset);
    offset -= 0.5 * sideOf(static_cast<int>(level) - 1) * towards(child);
    path.cell[level - 1] = cells_[path.cell[level]].child[child];
  }
  return path;
}

Surface VoxelPyramid::surfaceAt(const Eigen::Vector3d& point) const
{
  Surface surface;
  if (!point.allFinite()) {
    return surface;
  }
  const Place place = placeOf(point);
  const Path path = pathTo(place);
  for (std::size_t level = 0; level < kLevels && surface.kind == SurfaceKind::unknown; ++level) {
    if (path.cell[level] == 0) {
      continue;
    }
    const Cell& cell = cells_[path.cell[level]];
    const CellFit fit = fitOf(cell);
    // Single points are the same again only where they lie close together: in wider cells the nearest one is a point of
    // the same laser's pattern, which moves along with the sensor.
    if (fit.kind == SurfaceKind::point && level > 0) {
      continue;
    }
    const Eigen::Vector3d center = centerOf(place.key);
    surface.kind = fit.kind;
    surface.count = cell.sums.count;
    surface.size = sideOf(static_cast<int>(level));
    surface.center = center + Eigen::Vector3f(fit.mean.data()).cast<double>();
    surface.direction = Eigen::Vector3f(fit.direction.data()).cast<double>();
    surface.thickness = static_cast<double>(fit.thickness);
    surface.extent = static_cast<double>(fit.extent);
    if (fit.kind == SurfaceKind::point) {
      surface.center = center + nearestIn(leaves_[cell.child[0]], place.offset);
      surface.thickness = squared_spacing_;
    }
  }
  return surface;
}

Eigen::Vector3d VoxelPyramid::nearestIn(const Leaf& leaf, const Eigen::Vector3d& offset)
{
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
  double squared = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const Eigen::Vector3d p(leaf.point[i].x, leaf.point[i].y, leaf.point[i].z);
    if ((p - offset).squaredNorm() < squared) {
      squared = (p - offset).squaredNorm();
      nearest = p;
    }
  }
  return nearest;
}

void VoxelPyramid::find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const
{
  for (std::size_t i = 0; i < count; ++i) {
    surfaces[i] = surfaceAt(places[i]);
  }
}

void VoxelPyramid::release(std::uint32_t number, int level)
{
  if (level == 0) {
    points_ -= leaves_[cells_[number].child[0]].count;
    leaves_.release(cells_[number].child[0]);
  } else {
    for (const std::uint32_t child : cells_[number].child) {
      if (child != 0) {
        release(child, level - 1);
      }
    }
  }
  cells_.release(number);
}

void VoxelPyramid::crop(const Eigen::Vector3d& center, double radius)
{
  std::size_t kept = 0;
  for (const Block& block : blocks_) {
    if ((centerOf(block.key) - center).norm() > radius) {
      release(block.root, kLevels - 1);
    } else {
      blocks_[kept++] = block;
    }
  }
  if (kept == blocks_.size()) {
    return;
  }
  blocks_.resize(kept);
  table_.clear();
  for (const Block& block : blocks_) {
    table_.insert(block.key.packed(), block.root);
  }
}

void VoxelPyramid::clear()
{
  points_ = 0;
  cells_.clear();
  leaves_.clear();
  table_.clear();
  blocks_.clear();
}

}  // namespace pcl_floam
