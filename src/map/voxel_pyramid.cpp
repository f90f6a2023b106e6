#include "map/voxel_pyramid.h"

#include "common/prefetch.h"

#include <algorithm>
#include <cmath>

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

/// Places that are looked up side by side.
constexpr std::size_t kAtOnce = 32;

Eigen::Vector3d middleOf(const VoxelKey& key)
{
  return {key.x + 0.5, key.y + 0.5, key.z + 0.5};
}

}  // namespace

VoxelPyramid::VoxelPyramid(double side, SurfaceShapes shapes)
    : side_(side),
      inverse_side_(1.0 / side),
      squared_spacing_(static_cast<float>(side * side / kPointsPerLeaf)),
      shapes_(shapes)
{
}

Eigen::Vector3d VoxelPyramid::centerOfBlock(const VoxelKey& block) const
{
  return sideOf(kLevels - 1) * middleOf(block);
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

/// From that of the block.
Eigen::Vector3f VoxelPyramid::centerOf(const Place& place, int level) const
{
  constexpr int kAcross = 1 << (kLevels - 1);  // finest cells
  const auto within = [&](std::int32_t v) { return ((v & (kAcross - 1)) >> level) + 0.5; };
  const Eigen::Vector3d cells(within(place.key.x), within(place.key.y), within(place.key.z));
  return (sideOf(level) * cells - Eigen::Vector3d::Constant(0.5 * sideOf(kLevels - 1))).cast<float>();
}

bool VoxelPyramid::insert(const Eigen::Vector3d& point, std::uint32_t laser)
{
  Place place;
  return findPlace(point, place) && insert(place, cells_.find(place.key, 0), laser);
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
bool VoxelPyramid::insert(const Place& place, std::uint32_t cell, std::uint32_t laser)
{
  if (cell == 0) {
    cell = cells_.make(place.key);
  }
  if (cells_[cell].count >= kPointsPerLeaf) {
    return false;
  }
  const Eigen::Vector3f point = place.offset.cast<float>();
  Nearest nearest;
  findNearest(cells_.leaf(cell), point, nearest);
  if (nearest.squared < squared_spacing_) {
    return false;
  }
  cells_.add(cell, point, laser, keyframe_);
  ++points_;
  return true;
}

/// A thread that finds a fit in the making works it out for itself rather than wait.
CellFit VoxelPyramid::fitOf(std::uint32_t number) const
{
  const VoxelCells::Cell& cell = cells_[number];
  const VoxelCells::Content& content = cells_.content(number);
  std::uint8_t state = cell.state.load(std::memory_order_acquire);
  if (state >= VoxelCells::kKnown) {
    const auto kind = static_cast<SurfaceKind>(state - VoxelCells::kKnown);
    return {kind, cell.shape, kind == SurfaceKind::point ? content.axes : std::array<float, 9>()};
  }
  const CellFit own = pcl_floam::fitOf(content.sums, shapes_);
  if (state == VoxelCells::kStale && cell.state.compare_exchange_strong(state, VoxelCells::kBeingMade)) {
    cell.shape = own.shape;
    content.axes = own.axes;
    cell.state.store(static_cast<std::uint8_t>(VoxelCells::kKnown + static_cast<std::uint8_t>(own.kind)),
                     std::memory_order_release);
  }
  return own;
}

Surface VoxelPyramid::surfaceAt(const Eigen::Vector3d& point, std::uint32_t laser) const
{
  Surface surface;
  find(&point, &laser, 1, &surface);
  return surface;
}

/// A line of edge features is seen by three lasers; that is support enough.
void VoxelPyramid::surfaceAt(const Place& place, Found found, std::uint32_t laser, Surface& surface) const
{
  surface.kind = SurfaceKind::unknown;
  for (; found.cell != 0; found.cell = cells_[found.cell].parent, ++found.level) {
    const VoxelCells::Cell& cell = cells_[found.cell];
    if (shapes_ != SurfaceShapes::lines && !cell.support.hasTwoBesides(laser, keyframe_)) {
      continue;
    }
    const CellFit fit = fitOf(found.cell);
    if (fit.kind != SurfaceKind::unknown) {
      surfaceIn(found, place, fit, surface);
      return;
    }
  }
}

void VoxelPyramid::surfaceIn(Found found, const Place& place, const CellFit& fit, Surface& surface) const
{
  const CellShape& shape = fit.shape;
  const Eigen::Vector3d block = centerOfBlock(place.block());
  surface.kind = fit.kind;
  surface.count = cells_[found.cell].count;
  surface.size = sideOf(found.level);
  if (fit.kind == SurfaceKind::point) {
    Nearest nearest;
    findNearest(found, centerOf(place, found.level), place.offset.cast<float>(), nearest);
    surface.center = block + nearest.place.cast<double>();
    surface.direction.setZero();
    surface.thickness = static_cast<double>(squared_spacing_);
    surface.extent = 0.0;
    surface.felt = feltIn(found, fit);
    return;
  }
  surface.center = block + Eigen::Vector3f(shape.mean.data()).cast<double>();
  surface.direction = Eigen::Vector3f(shape.direction.data()).cast<double>();
  surface.thickness = static_cast<double>(shape.thickness);
  surface.extent = static_cast<double>(shape.extent);
}

/// Which displacements are felt among the points of a cell: what fills it evenly, or goes on in the next greater one as
/// in this, tells nothing of the way along it.
Eigen::Matrix3d VoxelPyramid::feltIn(Found found, const CellFit& fit) const
{
  constexpr double kChance = 1.25;  // as few points vary by chance
  const Eigen::Matrix3d axes = Eigen::Map<const Eigen::Matrix3f>(fit.axes.data()).cast<double>();
  const auto along = [&](std::uint32_t cell, int level) {
    return Eigen::Vector3d((axes.transpose() * cells_.content(cell).sums.filled(sideOf(level)) * axes).diagonal());
  };
  Eigen::Vector3d filled = along(found.cell, found.level);
  const std::uint32_t parent = cells_[found.cell].parent;
  if (parent != 0) {
    filled = filled.cwiseMax(along(parent, found.level + 1));
  }
  const Eigen::Vector3d felt = (1.0 - kChance * filled.array()).max(0.0);
  return axes * felt.asDiagonal() * axes.transpose();
}

/// Nearest cells first; those that lie farther off than what was found are left out.
void VoxelPyramid::findNearest(Found found, const Eigen::Vector3f& center, const Eigen::Vector3f& offset,
                               Nearest& nearest) const
{
  const float half = 0.5F * static_cast<float>(sideOf(found.level));
  const Eigen::Vector3f outside = ((offset - center).cwiseAbs().array() - half).max(0.0F);
  if (outside.squaredNorm() >= nearest.squared) {
    return;
  }
  const std::array<std::uint32_t, 8>& children = cells_.content(found.cell).child;
  if (found.level == 0) {
    findNearest(cells_.leaf(found.cell), offset, nearest);
    return;
  }
  const unsigned first = octantOf(Eigen::Vector3f(offset - center));
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned child = first ^ i;
    if (children[child] != 0) {
      findNearest({children[child], found.level - 1}, center + 0.5F * half * towards(child), offset, nearest);
    }
  }
}

void VoxelPyramid::findNearest(const Leaf& leaf, const Eigen::Vector3f& offset, Nearest& nearest)
{
  constexpr std::size_t kInRegister = 4;  // whole ones are worked out
  static_assert(kPointsPerLeaf % kInRegister == 0, "a leaf fills registers");
  std::array<float, kPointsPerLeaf> squared;
  for (std::size_t i = 0; i < leaf.count; i += kInRegister) {
    for (std::size_t lane = i; lane < i + kInRegister; ++lane) {
      const float x = leaf.x[lane] - offset.x();
      const float y = leaf.y[lane] - offset.y();
      const float z = leaf.z[lane] - offset.z();
      squared[lane] = x * x + y * y + z * z;
    }
  }
  for (std::size_t i = 0; i < leaf.count; ++i) {
    if (squared[i] < nearest.squared) {
      nearest = {{leaf.x[i], leaf.y[i], leaf.z[i]}, squared[i]};
    }
  }
}

/// Some at a time, each step of all before the next step: the memory of one comes while another is looked at.
void VoxelPyramid::find(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count,
                        Surface* surfaces) const
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
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      surfaceAt(place[i], found[i], lasers[begin + i], surfaces[begin + i]);
    }
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
