// What a pyramid of voxels has at a place.
#include "common/prefetch.h"
#include "map/voxel_pyramid.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// Which of a cell's eight children holds an offset from its centre.
unsigned octantOf(const Eigen::Vector3f& offset)
{
  return (offset.x() >= 0.0F ? 1U : 0U) | (offset.y() >= 0.0F ? 2U : 0U) | (offset.z() >= 0.0F ? 4U : 0U);
}

/// From a cell's centre to that of its child, in halves of the child's side.
Eigen::Vector3f towards(unsigned octant)
{
  return {(octant & 1U) != 0U ? 1.0F : -1.0F, (octant & 2U) != 0U ? 1.0F : -1.0F, (octant & 4U) != 0U ? 1.0F : -1.0F};
}

}  // namespace

/// From that of the block.
Eigen::Vector3f VoxelPyramid::centerOf(const Place& place, int level) const
{
  constexpr int kAcross = 1 << (kLevels - 1);  // finest cells
  const auto within = [&](std::int32_t v) { return ((v & (kAcross - 1)) >> level) + 0.5; };
  const Eigen::Vector3d cells(within(place.key.x), within(place.key.y), within(place.key.z));
  return (sideOf(level) * cells - Eigen::Vector3d::Constant(0.5 * sideOf(kLevels - 1))).cast<float>();
}

/// What is neither plane nor line is fitted again when the cell around it has taken points in: whether a fit is of now.
bool VoxelPyramid::isOfNow(const VoxelCells::Cell& cell, std::uint8_t state) const
{
  constexpr auto kPoint = static_cast<std::uint8_t>(VoxelCells::kKnown + static_cast<std::uint8_t>(SurfaceKind::point));
  return state >= VoxelCells::kKnown &&
         (state != kPoint || cell.around.load(std::memory_order_acquire) == versionAround(cell));
}

std::uint8_t VoxelPyramid::versionAround(const VoxelCells::Cell& cell) const
{
  return static_cast<std::uint8_t>(cell.parent != 0 ? cells_[cell.parent].count : 0);
}

/// A thread that finds a fit in the making works it out for itself rather than wait.
/// \param own room for it then
VoxelPyramid::Fit VoxelPyramid::fitOf(Found found, CellFit& own) const
{
  const VoxelCells::Cell& cell = cells_[found.cell];
  const VoxelCells::Content& content = cells_.content(found.cell);
  std::uint8_t state = cell.state.load(std::memory_order_acquire);
  if (isOfNow(cell, state)) {
    return {static_cast<SurfaceKind>(state - VoxelCells::kKnown), cell.shape, content.along};
  }
  const CellSums* around = cell.parent != 0 ? &cells_.content(cell.parent).sums : nullptr;
  own = pcl_floam::fitOf(content.sums, sideOf(found.level), around);
  if (state != VoxelCells::kBeingMade && cell.state.compare_exchange_strong(state, VoxelCells::kBeingMade)) {
    if (!isOfNow(cell, state)) {  // else another thread has made it meanwhile
      cell.shape = own.shape;
      content.along = own.along;
      cell.around.store(versionAround(cell), std::memory_order_release);
    }
    cell.state.store(static_cast<std::uint8_t>(VoxelCells::kKnown + static_cast<std::uint8_t>(own.kind)),
                     std::memory_order_release);
  }
  return {own.kind, own.shape, own.along};
}

void VoxelPyramid::surfaceAt(const Place& place, Found found, Surface& surface) const
{
  CellFit own;
  surface.kind = SurfaceKind::unknown;
  for (; found.cell != 0; found.cell = cells_[found.cell].parent, ++found.level) {
    const Fit fit = fitOf(found, own);
    if (fit.kind != SurfaceKind::unknown) {
      surfaceIn(found, place, fit, surface);
      return;
    }
  }
}

void VoxelPyramid::surfaceIn(Found found, const Place& place, const Fit& fit, Surface& surface) const
{
  const CellShape& shape = fit.shape;
  const Eigen::Vector3d block = centerOfBlock(place.block());
  surface.kind = fit.kind;
  surface.count = cells_[found.cell].count;
  if (fit.kind == SurfaceKind::point) {
    Nearest nearest;
    findNearest(found, centerOf(place, found.level), place.offset.cast<float>(), nearest);
    surface.center = block + nearest.place.cast<double>();
    surface.direction.setZero();
    surface.thickness = static_cast<double>(squared_spacing_);
    surface.extent = 0.0;
    surface.observability = Eigen::Map<const Eigen::Matrix3f>(fit.along.data()).cast<double>();
    return;
  }
  surface.center = block + Eigen::Vector3f(shape.mean.data()).cast<double>();
  surface.direction = Eigen::Vector3f(shape.direction.data()).cast<double>();
  surface.thickness = static_cast<double>(shape.thickness);
  surface.extent = static_cast<double>(shape.extent);
  if (fit.kind == SurfaceKind::plane) {
    surface.wide = Eigen::Vector3f(fit.along.data()).cast<double>();
    surface.width = static_cast<double>(fit.along[3]);
  }
}

/// Nearest cells first; those that lie farther off than what was found are left out.
void VoxelPyramid::findNearest(Found found, const Eigen::Vector3f& center, const Eigen::Vector3f& offset,
                               Nearest& nearest) const
{
  if (found.level == 0) {
    findNearest(cells_.leaf(found.cell), offset, nearest);
    return;
  }
  const std::array<std::uint32_t, 8>& children = cells_.content(found.cell).child;
  for (const std::uint32_t child : children) {
    if (child != 0) {
      prefetch(&cells_.content(child), sizeof(children));
    }
  }
  const float half = 0.25F * static_cast<float>(sideOf(found.level));  // of a child
  const Eigen::Array3f from_center = (offset - center).array();
  const Eigen::Array3f below = ((from_center + half).abs() - half).max(0.0F).square();
  const Eigen::Array3f above = ((from_center - half).abs() - half).max(0.0F).square();
  const unsigned first = octantOf(Eigen::Vector3f(offset - center));
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned child = first ^ i;
    if (children[child] == 0) {
      continue;
    }
    const float outside = ((child & 1U) != 0U ? above : below).x() + ((child & 2U) != 0U ? above : below).y() +
                          ((child & 4U) != 0U ? above : below).z();
    if (outside < nearest.squared) {
      findNearest({children[child], found.level - 1}, center + half * towards(child), offset, nearest);
    }
  }
}

/// Whether a point is nearer to one of a leaf than those of a full one are to each other.
bool VoxelPyramid::isNear(const Leaf& leaf, const Eigen::Vector3f& offset) const
{
  for (std::size_t g = 0; g < leaf.used(); ++g) {
    if (PointGroup::leastOf(leaf.groups[g].squaredDistances(offset)) < squared_spacing_) {
      return true;
    }
  }
  return false;
}

void VoxelPyramid::findNearest(const Leaf& leaf, const Eigen::Vector3f& offset, Nearest& nearest)
{
  for (std::size_t g = 0; g < leaf.used(); ++g) {
    const PointGroup::Lanes squared = leaf.groups[g].squaredDistances(offset);
    const float least = PointGroup::leastOf(squared);
    if (least < nearest.squared) {
      const auto lane = static_cast<std::size_t>(std::find(squared.begin(), squared.end(), least) - squared.begin());
      nearest = {leaf.point(g * Leaf::kLanes + lane), least};
    }
  }
}

/// Some at a time, each step of all before the next step: the memory of one comes while another is looked at.
void VoxelPyramid::find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const
{
  std::array<Place, kAtOnce> place;
  std::array<bool, kAtOnce> is_there{};
  std::array<Found, kAtOnce> found;
  for (std::size_t begin = 0; begin < count; begin += kAtOnce) {
    const std::size_t n = std::min(kAtOnce, count - begin);
    for (std::size_t i = 0; i < n; ++i) {
      is_there[i] = findPlace(places[begin + i], place[i]);
      if (is_there[i]) {
        cells_.expect(place[i].key);
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      found[i] = is_there[i] ? cells_.finestAt(place[i].key) : Found();
      if (found[i].cell != 0) {
        prefetch(&cells_[found[i].cell], sizeof(VoxelCells::Cell));
        prefetch(&cells_.content(found[i].cell), sizeof(std::uint64_t));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      surfaceAt(place[i], found[i], surfaces[begin + i]);
    }
  }
}

}  // namespace pcl_floam
