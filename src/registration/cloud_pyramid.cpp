#include "registration/cloud_pyramid.h"

#include "registration/repeated_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {

namespace {

/// Voxels of the first thinned level, in spacings; each further level has voxels twice as large.
constexpr double kFirstVoxel = 2.5;

/// The coarsest level is the first to have fewer points than this: a few milliseconds for all its iterations.
constexpr std::size_t kCoarsestPoints = 1500;

/// Of a moved point whose coordinates are in single precision, as a share of the largest.
constexpr double kFloatRounding = 2.0 * static_cast<double>(std::numeric_limits<float>::epsilon());

/// Voxels of a thinned cloud, in extents.
constexpr double kRoughVoxel = 0.03;

/// Coordinates are bounded so that their squares stay finite in single precision.
constexpr float kLargest = 1e18F;

bool isFinite(const CloudView& cloud, std::size_t i)
{
  // NaN compares false.
  return std::abs(cloud.x(i)) < kLargest && std::abs(cloud.y(i)) < kLargest && std::abs(cloud.z(i)) < kLargest;
}

bool isZero(const CloudView& cloud, std::size_t i)
{
  return cloud.x(i) == 0.0F && cloud.y(i) == 0.0F && cloud.z(i) == 0.0F;
}

/// The points that take part. One point at the origin may be a model's corner; several stand for "no return".
std::vector<int> usablePoints(const CloudView& cloud, const std::vector<std::uint8_t>& selectable)
{
  std::vector<int> usable;
  usable.reserve(cloud.size);
  std::size_t zeros = 0;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    if (isFinite(cloud, i) && (selectable.empty() || selectable[i] != 0)) {
      usable.push_back(static_cast<int>(i));
      zeros += isZero(cloud, i) ? 1 : 0;
    }
  }
  if (zeros > 1 && zeros < usable.size()) {
    usable.erase(
        std::remove_if(usable.begin(), usable.end(), [&](int i) { return isZero(cloud, static_cast<std::size_t>(i)); }),
        usable.end());
  }
  return usable;
}

/// Without shapes.
CloudLevel bareLevel(const std::vector<Eigen::Vector3f>& points, const std::vector<int>& numbers)
{
  CloudLevel level;
  level.tree = PointTree(points);
  level.number.reserve(points.size());
  for (const int i : level.tree.order()) {
    level.number.push_back(numbers[static_cast<std::size_t>(i)]);
  }
  return level;
}

CloudLevel withShapes(CloudLevel level, int threads)
{
  LocalShapes shapes = findLocalShapes(level.tree, threads);
  level.shapes = std::move(shapes.shape);
  level.spacing = shapes.spacing;
  return level;
}

/// The number of a point's voxel in the lattice's order, and the point.
using VoxelMember = std::pair<std::uint64_t, int>;

std::vector<VoxelMember> sortIntoVoxels(const std::vector<Eigen::Vector3f>& points, double voxel_size)
{
  constexpr unsigned kBits = 21;
  constexpr double kHalf = 1U << (kBits - 1U);  // as many voxels on either side of the origin
  std::vector<VoxelMember> members(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t voxel = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = std::floor(static_cast<double>(points[i][axis]) / voxel_size);
      voxel = voxel << kBits | static_cast<std::uint64_t>(std::clamp(place, -kHalf, kHalf - 1.0) + kHalf);
    }
    members[i] = {voxel, static_cast<int>(i)};
  }
  std::sort(members.begin(), members.end());
  return members;
}

/// The members' mean and the one of them that is nearest to it.
std::pair<Eigen::Vector3f, int> summarize(const std::vector<Eigen::Vector3f>& points, const VoxelMember* first,
                                          const VoxelMember* last)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const VoxelMember* member = first; member != last; ++member) {
    sum += points[static_cast<std::size_t>(member->second)].cast<double>();
  }
  const Eigen::Vector3f mean = (sum / static_cast<double>(last - first)).cast<float>();
  const VoxelMember* nearest = std::min_element(first, last, [&](const VoxelMember& a, const VoxelMember& b) {
    return (points[static_cast<std::size_t>(a.second)] - mean).squaredNorm() <
           (points[static_cast<std::size_t>(b.second)] - mean).squaredNorm();
  });
  return {mean, nearest->second};
}

/// The means within voxels, and for each the number of the point nearest to it.
std::pair<std::vector<Eigen::Vector3f>, std::vector<int>> voxelMeans(const std::vector<Eigen::Vector3f>& points,
                                                                     const std::vector<int>& numbers, double voxel_size)
{
  const std::vector<VoxelMember> members = sortIntoVoxels(points, voxel_size);
  std::pair<std::vector<Eigen::Vector3f>, std::vector<int>> result;
  for (std::size_t first = 0; first < members.size();) {
    std::size_t last = first + 1;
    while (last < members.size() && members[last].first == members[first].first) {
      ++last;
    }
    const auto [mean, nearest] = summarize(points, &members[first], members.data() + last);
    result.first.push_back(mean);
    result.second.push_back(numbers[static_cast<std::size_t>(nearest)]);
    first = last;
  }
  return result;
}

CloudLevel bareThinned(const CloudLevel& finer, double voxel)
{
  const auto [means, numbers] = voxelMeans(finer.tree.points(), finer.number, voxel);
  CloudLevel level = bareLevel(means, numbers);
  level.rounding = finer.rounding;
  level.voxel = voxel;
  return level;
}

/// A thousand of the points, all over the cloud.
std::vector<Eigen::Vector3f> someOf(const std::vector<Eigen::Vector3f>& points)
{
  constexpr std::size_t kSome = 1000;
  std::vector<Eigen::Vector3f> some;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kSome) {
    some.push_back(points[i]);
  }
  return some;
}

/// A cloud that a sampling does not allow, in voxels as small as it does, each level with twice the size; itself if
/// none is allowed. \param allows takes the sampling of all points, and of those of the level
template <typename Allows>
CloudLevel thinnedUntil(CloudLevel all, std::size_t fewest, const Allows& allows)
{
  const std::vector<Eigen::Vector3f> places = someOf(all.tree.points());
  const Sampling sampling = findSampling(all.tree, places);
  if (allows(sampling, sampling)) {
    return all;
  }
  double voxel = kFirstVoxel * sampling.spacing;
  while (voxel > 0.0) {
    CloudLevel thinned = bareThinned(all, voxel);
    if (thinned.tree.size() < fewest) {
      break;
    }
    if (allows(sampling, findSampling(thinned.tree, places))) {
      return thinned;
    }
    voxel *= 2.0;
  }
  return all;
}

/// Lines that are gone from a cloud once it is thinned are the sensor's scan lines, and the points of one of these lie
/// on that laser's cone, whatever it hit. Then the thinned cloud takes the place of the one given.
CloudLevel withoutScanLines(CloudLevel all)
{
  return thinnedUntil(std::move(all), kCoarsestPoints,
                      [](const Sampling& /*all*/, const Sampling& s) { return !s.in_lines; });
}

/// What is a surface once it is thinned was hidden by noise: its neighbourhoods are as thick as wide, so that each
/// point would hold the pose in all directions.
CloudLevel withoutNoise(CloudLevel all)
{
  return thinnedUntil(std::move(all), kFewPoints, [](const Sampling& all_points, const Sampling& s) {
    constexpr double kMostShapeless = 1.0 / 3.0;  // of all places: scattered scenes have as many, whatever the voxels
    constexpr double kClearlyFewer = 2.0 / 3.0;   // times as many
    return all_points.shapeless <= kMostShapeless ||
           s.shapeless <= std::min(kMostShapeless, kClearlyFewer * all_points.shapeless);
  });
}

}  // namespace

CloudLevel thinnedLevel(const CloudLevel& finer, double voxel, int threads)
{
  return withShapes(bareThinned(finer, voxel), threads);
}

CloudPyramid::CloudPyramid(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads,
                           bool is_rough)
    : threads_(threads)
{
  CloudLevel all = takePoints(cloud, selectable);
  if (is_rough) {
    full_ = thinnedLevel(all, std::max(kRoughVoxel * extent_, std::numeric_limits<double>::min()), threads);
    return;
  }
  std::vector<std::pair<int, int>> repeated = std::move(all.repeated);
  full_ = withShapes(withoutNoise(withoutScanLines(std::move(all))), threads);
  full_.repeated = std::move(repeated);
}

const std::vector<CloudLevel>& CloudPyramid::thinnedLevels() const
{
  std::call_once(thinned_once_, [this] {
    double voxel = kFirstVoxel * full_.spacing;
    for (const CloudLevel* last = &full_; voxel > 0.0 && last->tree.size() > kCoarsestPoints; voxel *= 2.0) {
      thinned_.push_back(thinnedLevel(*last, voxel, threads_));
      last = &thinned_.back();
    }
  });
  return thinned_;
}

/// Without shapes.
CloudLevel CloudPyramid::takePoints(const CloudView& cloud, const std::vector<std::uint8_t>& selectable)
{
  std::vector<int> numbers = usablePoints(cloud, selectable);
  std::vector<std::pair<int, int>> repeated = dropRepeated(cloud, numbers);
  const auto position = [&](int i) {
    const auto n = static_cast<std::size_t>(i);
    return Eigen::Vector3d(cloud.x(n), cloud.y(n), cloud.z(n));
  };
  const double count = std::max(1.0, static_cast<double>(numbers.size()));
  double largest = 0.0;  // m; of the coordinates in the cloud's frame
  for (const int i : numbers) {
    origin_ += position(i);
    largest = std::max(largest, position(i).cwiseAbs().maxCoeff());
  }
  origin_ /= count;
  std::vector<Eigen::Vector3f> relative;
  relative.reserve(numbers.size());
  double squares = 0.0;
  for (const int i : numbers) {
    const Eigen::Vector3d from_origin = position(i) - origin_;
    squares += from_origin.squaredNorm();
    relative.emplace_back(from_origin.cast<float>());
  }
  extent_ = std::sqrt(squares / count);
  CloudLevel all = bareLevel(relative, numbers);
  all.repeated = std::move(repeated);
  all.rounding = kFloatRounding * largest;
  return all;
}

}  // namespace pcl_floam
