#include "registration/point_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pcl_floam {

namespace {

/// A leaf's points, whose distances are found together.
constexpr int kLeafSize = 16;

/// Whether \p a counts as nearer than \p b when both are equally near.
bool precedes(const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Keeps the one nearest point, and how far off all others are at least.
struct OneNearest {
  const std::vector<Eigen::Vector3f>& points;
  float limit;
  int index = -1;
  float clear = std::numeric_limits<float>::max();

  /// All others that are as near lie at the same place.
  [[nodiscard]] bool isOver() const { return limit == 0.0F && index >= 0; }

  void offer(float squared, int candidate)
  {
    if (index >= 0 && squared == limit && !precedes(at(candidate), at(index))) {
      passOver(squared);
      return;
    }
    if (index >= 0) {
      passOver(limit);
    }
    limit = squared;
    index = candidate;
  }

  /// Something at least so far off is not looked at.
  void passOver(float squared) { clear = std::min(clear, squared); }

  [[nodiscard]] const Eigen::Vector3f& at(int i) const { return points[static_cast<std::size_t>(i)]; }
};

}  // namespace

/// Keeps the k nearest points. Takes all within the limit, and throws out what is too far whenever there are three
/// times as many as wanted: cheaper than keeping them sorted.
struct SomeNearest {
  const std::vector<Eigen::Vector3f>& points;
  NearestPoints& result;
  int wanted;
  float limit;

  [[nodiscard]] bool isOver() const { return limit == 0.0F && result.count_ >= wanted; }

  void offer(float squared, int candidate)
  {
    result.keys_[static_cast<std::size_t>(result.count_++)] = sortKey(squared, static_cast<std::uint32_t>(candidate));
    if (result.count_ == 3 * wanted) {
      keepWanted();
    }
  }

  void passOver(float /*squared*/) {}

  void keepWanted()
  {
    if (result.count_ == 0 || wanted < 1) {
      return;
    }
    const int kept = std::min(wanted, result.count_);
    const auto first = result.keys_.begin();
    const auto farthest = first + kept - 1;
    const auto last = first + result.count_;
    std::nth_element(first, farthest, last);
    const std::uint64_t distance = *farthest >> 32U;
    if (std::any_of(farthest + 1, last, [&](std::uint64_t key) { return key >> 32U == distance; })) {
      std::nth_element(first, farthest, last, [this](std::uint64_t a, std::uint64_t b) { return isNearer(a, b); });
    }
    result.count_ = kept;
    if (kept == wanted) {
      limit = std::min(limit, result.squaredDistance(kept - 1));
    }
  }

  /// The points' places decide between those that are equally near.
  [[nodiscard]] bool isNearer(std::uint64_t a, std::uint64_t b) const
  {
    const auto placeOf = [this](std::uint64_t key) -> const Eigen::Vector3f& { return points[key & 0xFFFFFFFFU]; };
    return a >> 32U != b >> 32U ? a < b : precedes(placeOf(a), placeOf(b));
  }
};

PointTree::PointTree(const std::vector<Eigen::Vector3f>& points) : order_(points.size())
{
  std::iota(order_.begin(), order_.end(), 0);
  if (points.empty()) {
    return;
  }
  nodes_.reserve(4 * points.size() / kLeafSize + 2);
  build(points, 0, static_cast<int>(points.size()));
  points_.reserve(points.size());
  for (std::vector<float>& coordinates : coordinates_) {
    coordinates.assign(points.size() + kLeafSize, 0.0F);
  }
  for (std::size_t i = 0; i < order_.size(); ++i) {
    points_.push_back(points[static_cast<std::size_t>(order_[i])]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates_[axis][i] = points_[i][static_cast<Eigen::Index>(axis)];
    }
  }
}

int PointTree::build(const std::vector<Eigen::Vector3f>& points, int first, int last)
{
  const auto number = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first_point = first;
  node.last_point = last;
  const auto at = [&](int position) -> const Eigen::Vector3f& {
    return points[static_cast<std::size_t>(order_[static_cast<std::size_t>(position)])];
  };
  Eigen::Vector3f lowest = at(first);
  Eigen::Vector3f highest = lowest;
  for (int i = first + 1; i < last; ++i) {
    lowest = lowest.cwiseMin(at(i));
    highest = highest.cwiseMax(at(i));
  }
  int axis = 0;
  const float extent = (highest - lowest).maxCoeff(&axis);
  if (last - first > kLeafSize && extent > 0.0F) {
    const int middle = first + (last - first) / 2;
    const auto less = [&](int a, int b) {
      return points[static_cast<std::size_t>(a)][axis] < points[static_cast<std::size_t>(b)][axis];
    };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, less);
    node.axis = axis;
    node.above = at(middle)[axis];
    node.below = at(first)[axis];
    for (int i = first + 1; i < middle; ++i) {
      node.below = std::max(node.below, at(i)[axis]);
    }
    build(points, first, middle);
    node.second = build(points, middle, last);
  }
  nodes_[static_cast<std::size_t>(number)] = node;
  return number;
}

template <typename Collector>
void PointTree::lookAt(const Node& leaf, const Eigen::Vector3f& query, Collector& collector) const
{
  // More than one block only where all points are equal.
  for (int first = leaf.first_point; first < leaf.last_point && !collector.isOver(); first += kLeafSize) {
    const float* x = coordinates_[0].data() + first;
    const float* y = coordinates_[1].data() + first;
    const float* z = coordinates_[2].data() + first;
    std::array<float, kLeafSize> squared;
    for (std::size_t i = 0; i < kLeafSize; ++i) {  // a whole block, for the sake of vector instructions
      squared[i] = squaredDistance(x[i] - query.x(), y[i] - query.y(), z[i] - query.z());
    }
    const int count = std::min(kLeafSize, leaf.last_point - first);
    for (int i = 0; i < count; ++i) {
      if (squared[static_cast<std::size_t>(i)] <= collector.limit) {
        collector.offer(squared[static_cast<std::size_t>(i)], first + i);
      } else {
        collector.passOver(squared[static_cast<std::size_t>(i)]);
      }
    }
  }
}

template <typename Collector>
void PointTree::search(int number, const Eigen::Vector3f& query, float squared, Eigen::Vector3f& offset,
                       Collector& collector) const
{
  const Node& node = nodes_[static_cast<std::size_t>(number)];
  if (node.axis < 0) {
    lookAt(node, query, collector);
    return;
  }
  const float coordinate = query[node.axis];
  const bool first_is_nearer = coordinate - node.below < node.above - coordinate;
  search(first_is_nearer ? number + 1 : node.second, query, squared, offset, collector);
  // The other child lies beyond the gap between the two; the offsets along the other axes stay what they were.
  const float gap = first_is_nearer ? std::max(0.0F, node.above - coordinate) : std::max(0.0F, coordinate - node.below);
  const float before = offset[node.axis];
  const float beyond = squared - before * before + gap * gap;
  if (beyond <= collector.limit && !collector.isOver()) {
    offset[node.axis] = gap;
    search(first_is_nearer ? node.second : number + 1, query, beyond, offset, collector);
    offset[node.axis] = before;
  } else {
    collector.passOver(beyond);
  }
}

int PointTree::nearest(const Eigen::Vector3f& query, float& limit, float& clear) const
{
  OneNearest collector{points_, limit};
  if (!empty()) {
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();
    search(0, query, 0.0F, offset, collector);
    limit = collector.limit;
  }
  clear = collector.clear;
  return collector.index;
}

int PointTree::nearest(const Eigen::Vector3f& query, float& limit) const
{
  float clear = 0.0F;
  return nearest(query, limit, clear);
}

void PointTree::nearest(const Eigen::Vector3f& query, int k, NearestPoints& result) const
{
  result.count_ = 0;
  if (!empty()) {
    SomeNearest collector{points_, result, k, std::numeric_limits<float>::max()};
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();
    search(0, query, 0.0F, offset, collector);
    collector.keepWanted();
  }
}

}  // namespace pcl_floam
