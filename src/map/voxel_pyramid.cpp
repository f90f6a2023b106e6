#include "map/voxel_pyramid.h"

#include <algorithm>
#include <cmath>

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

VoxelPyramid::VoxelPyramid(double side, SurfaceShapes shapes)
    : side_(side), squared_spacing_(side * side / kPointsPerLeaf), shapes_(shapes)
{
}

Eigen::Vector3d VoxelPyramid::centerOf(const VoxelKey& key) const
{
  return sideOf(kLevels - 1) * Eigen::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5);
}

VoxelPyramid::Place VoxelPyramid::placeOf(const Eigen::Vector3d& point) const
{
  const VoxelKey key = keyOf(point, 1.0 / sideOf(kLevels - 1));
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
  Nearest nearest;
  findNearest(leaf, place.offset, nearest);
  if (leaf.count >= kPointsPerLeaf || nearest.squared < squared_spacing_) {
    return false;
  }
  const Eigen::Vector3f p = place.offset.cast<float>();
  leaf.point[leaf.count++] = {p.x(), p.y(), p.z(), laser};
  ++points_;
  for (const std::uint32_t cell : path.cell) {
    cells_[cell].sums.add(static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()));
    cells_[cell].sums.support.add(laser, keyframe_);
    cells_[cell].fit.state.store(CachedFit::stale, std::memory_order_relaxed);
  }
  return true;
}

/// A thread that finds a fit in the making works it out for itself rather than wait, in \p own.
const CellFit& VoxelPyramid::fitOf(const Cell& cell, int level, CellFit& own) const
{
  std::uint8_t state = cell.fit.state.load(std::memory_order_acquire);
  if (state == CachedFit::ready) {
    return cell.fit.fit;
  }
  own = pcl_floam::fitOf(cell.sums, shapes_, sideOf(level));
  if (state == CachedFit::stale && cell.fit.state.compare_exchange_strong(state, CachedFit::being_made)) {
    cell.fit.fit = own;
    cell.fit.state.store(CachedFit::ready, std::memory_order_release);
  }
  return own;
}

VoxelPyramid::Path VoxelPyramid::pathTo(const Place& place) const
{
  Path path;
  path.cell[kLevels - 1] = table_.find(place.key.packed());
  path.center[kLevels - 1].setZero();
  for (std::size_t level = kLevels - 1; level > 0 && path.cell[level] != 0; --level) {
    const unsigned child = octant(place.offset - path.center[level]);
    path.center[level - 1] = path.center[level] + 0.5 * sideOf(static_cast<int>(level) - 1) * towards(child);
    path.cell[level - 1] = cells_[path.cell[level]].child[child];
  }
  return path;
}

/// A line of edge features is seen by three lasers; that is support enough.
bool VoxelPyramid::isSupported(const Cell& cell, std::uint32_t laser) const
{
  constexpr int kOthers = 2;
  return shapes_ == SurfaceShapes::lines || cell.sums.support.besides(laser, keyframe_) >= kOthers;
}

Surface VoxelPyramid::surfaceAt(const Eigen::Vector3d& point, std::uint32_t laser) const
{
  if (!point.allFinite()) {
    return {};
  }
  const Place place = placeOf(point);
  const Path path = pathTo(place);
  for (int level = 0; level < kLevels; ++level) {
    const std::uint32_t number = path.cell[static_cast<std::size_t>(level)];
    if (number == 0 || !isSupported(cells_[number], laser)) {
      continue;
    }
    CellFit own;
    const CellFit& fit = fitOf(cells_[number], level, own);
    if (fit.kind != SurfaceKind::unknown) {
      return surfaceIn(path, level, place, fit);
    }
  }
  return {};
}

Surface VoxelPyramid::surfaceIn(const Path& path, int level, const Place& place, const CellFit& fit) const
{
  const auto at = static_cast<std::size_t>(level);
  Surface surface;
  surface.kind = fit.kind;
  surface.count = cells_[path.cell[at]].sums.count;
  surface.size = sideOf(level);
  surface.center = centerOf(place.key) + Eigen::Vector3f(fit.mean.data()).cast<double>();
  surface.direction = Eigen::Vector3f(fit.direction.data()).cast<double>();
  surface.thickness = static_cast<double>(fit.thickness);
  surface.extent = static_cast<double>(fit.extent);
  if (fit.kind == SurfaceKind::point) {
    Nearest nearest;
    findNearest(path.cell[at], level, path.center[at], place.offset, nearest);
    surface.center = centerOf(place.key) + nearest.place;
    surface.thickness = squared_spacing_;
    surface.felt = feltIn(path, level, fit);
  }
  return surface;
}

/// Which displacements are felt among the points of a cell: what fills it evenly, or goes on in the next greater one as
/// in this, tells nothing of the way along it.
Eigen::Matrix3d VoxelPyramid::feltIn(const Path& path, int level, const CellFit& fit) const
{
  constexpr double kChance = 1.25;  // as few points vary by chance
  const Eigen::Matrix3d axes = Eigen::Map<const Eigen::Matrix3f>(fit.axes.data()).cast<double>();
  const auto along = [&](const CellFit& cell) {
    const auto& f = cell.filled;
    Eigen::Matrix3f filled;
    filled << f[0], f[1], f[2], f[1], f[3], f[4], f[2], f[4], f[5];
    return Eigen::Vector3d((axes.transpose() * filled.cast<double>() * axes).diagonal());
  };
  Eigen::Vector3d filled = along(fit);
  if (level + 1 < kLevels) {
    CellFit own;
    filled = filled.cwiseMax(along(fitOf(cells_[path.cell[static_cast<std::size_t>(level) + 1]], level + 1, own)));
  }
  const Eigen::Vector3d felt = (1.0 - kChance * filled.array()).max(0.0);
  return axes * felt.asDiagonal() * axes.transpose();
}

/// Nearest cells first; those that lie farther off than what was found are left out.
void VoxelPyramid::findNearest(std::uint32_t cell, int level, const Eigen::Vector3d& center,
                               const Eigen::Vector3d& offset, Nearest& nearest) const
{
  const Eigen::Vector3d outside = ((offset - center).cwiseAbs().array() - 0.5 * sideOf(level)).max(0.0);
  if (outside.squaredNorm() >= nearest.squared) {
    return;
  }
  if (level == 0) {
    findNearest(leaves_[cells_[cell].child[0]], offset, nearest);
    return;
  }
  const unsigned first = octant(offset - center);
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned child = first ^ i;
    const std::uint32_t number = cells_[cell].child[child];
    if (number != 0) {
      findNearest(number, level - 1, center + 0.5 * sideOf(level - 1) * towards(child), offset, nearest);
    }
  }
}

void VoxelPyramid::findNearest(const Leaf& leaf, const Eigen::Vector3d& offset, Nearest& nearest)
{
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const Eigen::Vector3d p(leaf.point[i].x, leaf.point[i].y, leaf.point[i].z);
    const double squared = (p - offset).squaredNorm();
    if (squared < nearest.squared) {
      nearest = {p, squared};
    }
  }
}

void VoxelPyramid::find(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count,
                        Surface* surfaces) const
{
  for (std::size_t i = 0; i < count; ++i) {
    surfaces[i] = surfaceAt(places[i], lasers[i]);
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
