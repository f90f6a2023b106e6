#include "registration/point_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pcl_floam {

namespace {

constexpr int kLeafSize = 10;

/// Whether \p a counts as nearer than \p b when both are equally near.
bool precedes(const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Keeps the one nearest point.
struct OneNearest {
  const std::vector<Eigen::Vector3f>& points;
  float limit;
  int index = -1;

  void offer(float squared, int candidate)
  {
    if (squared < limit || (squared == limit && (index < 0 || precedes(points[static_cast<std::size_t>(candidate)],
                                                                       points[static_cast<std::size_t>(index)])))) {
      limit = squared;
      index = candidate;
    }
  }
};

/// Keeps the k nearest points, sorted.
struct SomeNearest {
  const std::vector<Eigen::Vector3f>& points;
  NearestPoints& result;
  float limit = std::numeric_limits<float>::max();

  [[nodiscard]] bool nearer(float squared, int candidate, std::size_t than) const
  {
    return squared < result.squared_distance[than] ||
           (squared == result.squared_distance[than] && precedes(points[static_cast<std::size_t>(candidate)],
                                                                 points[static_cast<std::size_t>(result.index[than])]));
  }

  void offer(float squared, int candidate)
  {
    const bool full = result.count == result.wanted;
    auto place = static_cast<std::size_t>(full ? result.count - 1 : result.count);
    if (full && !nearer(squared, candidate, place)) {
      return;
    }
    result.count += full ? 0 : 1;
    for (; place > 0 && nearer(squared, candidate, place - 1); --place) {
      result.squared_distance[place] = result.squared_distance[place - 1];
      result.index[place] = result.index[place - 1];
    }
    result.squared_distance[place] = squared;
    result.index[place] = candidate;
    if (result.count == result.wanted) {
      limit = result.squared_distance[static_cast<std::size_t>(result.wanted - 1)];
    }
  }
};

}  // namespace

PointTree::PointTree(const std::vector<Eigen::Vector3f>& points) : order_(points.size())
{
  std::iota(order_.begin(), order_.end(), 0);
  if (points.empty()) {
    return;
  }
  nodes_.reserve(4 * points.size() / kLeafSize + 2);
  build(points, 0, static_cast<int>(points.size()));
  points_.reserve(points.size());
  for (const int i : order_) {
    points_.push_back(points[static_cast<std::size_t>(i)]);
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
void PointTree::search(int number, const Eigen::Vector3f& query, float squared, Eigen::Vector3f& offset,
                       Collector& collector) const
{
  const Node& node = nodes_[static_cast<std::size_t>(number)];
  if (node.axis < 0) {
    for (int i = node.first_point; i < node.last_point; ++i) {
      const float distance = (points_[static_cast<std::size_t>(i)] - query).squaredNorm();
      if (distance <= collector.limit) {
        collector.offer(distance, i);
      }
    }
    return;
  }
  const float coordinate = query[node.axis];
  const bool first_is_nearer = coordinate - node.below < node.above - coordinate;
  search(first_is_nearer ? number + 1 : node.second, query, squared, offset, collector);
  // The other child lies beyond the gap between the two; the offsets along the other axes stay what they were.
  const float gap = first_is_nearer ? std::max(0.0F, node.above - coordinate) : std::max(0.0F, coordinate - node.below);
  const float before = offset[node.axis];
  const float beyond = squared - before * before + gap * gap;
  if (beyond <= collector.limit) {
    offset[node.axis] = gap;
    search(first_is_nearer ? node.second : number + 1, query, beyond, offset, collector);
    offset[node.axis] = before;
  }
}

int PointTree::nearest(const Eigen::Vector3f& query, float& limit) const
{
  OneNearest collector{points_, limit};
  if (!empty()) {
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();
    search(0, query, 0.0F, offset, collector);
    limit = collector.limit;
  }
  return collector.index;
}

void PointTree::nearest(const Eigen::Vector3f& query, int k, NearestPoints& result) const
{
  result.wanted = k;
  result.count = 0;
  if (!empty()) {
    SomeNearest collector{points_, result};
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();
    search(0, query, 0.0F, offset, collector);
  }
}

}  // namespace pcl_floam
