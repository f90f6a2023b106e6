/// \file point_tree.h
/// Nearest neighbours among a fixed set of points, fast for queries that come in spatial order.
#pragma once

#include "common/sort_key.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// In this order wherever distances are compared to the bit: Eigen's order depends on the processor.
inline float squaredDistance(float dx, float dy, float dz)
{
  return dx * dx + (dy * dy + dz * dz);
}
inline float squaredDistance(const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  return squaredDistance(a.x() - b.x(), a.y() - b.y(), a.z() - b.z());
}

/// The nearest points of one query, in no order but that the farthest comes last. Fixed room: no allocation.
class NearestPoints {
public:
  static constexpr int kCapacity = 40;

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int index(int i) const { return static_cast<int>(keys_[static_cast<std::size_t>(i)] & 0xFFFFFFFFU); }
  [[nodiscard]] float squaredDistance(int i) const { return valueOf(keys_[static_cast<std::size_t>(i)]); }

private:
  friend class PointTree;
  friend struct SomeNearest;

  static constexpr std::size_t kRoom = 3 * kCapacity;  ///< what the search needs beyond the capacity
  std::array<std::uint64_t, kRoom> keys_;              ///< of squared distances and indices
  int count_ = 0;
};

/// A balanced KD-tree in single precision.
///
/// The points are kept in the tree's order, in which neighbours lie near each other in memory: going through one
/// tree's points in order and asking another one is several times faster than in any other order. Among points that
/// are equally near, the one with the lexicographically smallest coordinates counts as nearer, so that the order of the
/// points given has no influence.
class PointTree {
public:
  PointTree() = default;
  /// \param points finite
  explicit PointTree(const std::vector<Eigen::Vector3f>& points);

  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] std::size_t size() const { return points_.size(); }

  /// The points in the tree's order, which the indices of the searches refer to.
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }

  /// For each point in the tree's order, where it stood among the points given.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

  /// The nearest point no farther than \p limit (squared), -1 if there is none. \p limit becomes its squared distance.
  [[nodiscard]] int nearest(const Eigen::Vector3f& query, float& limit) const;

  /// \param[out] clear squared distance below which there is no point but the one found
  [[nodiscard]] int nearest(const Eigen::Vector3f& query, float& limit, float& clear) const;

  /// The up to \p k nearest points; \p k at most NearestPoints::kCapacity.
  void nearest(const Eigen::Vector3f& query, int k, NearestPoints& result) const;

private:
  struct Node {
    float below = 0.0F;  ///< largest coordinate of the first child along the axis
    float above = 0.0F;  ///< smallest one of the second
    int axis = -1;       ///< -1 for a leaf
    int second = 0;      ///< number of the second child; the first follows its parent
    int first_point = 0;
    int last_point = 0;  ///< one past
  };

  int build(const std::vector<Eigen::Vector3f>& points, int first, int last);
  template <typename Collector>
  void search(int node, const Eigen::Vector3f& query, float squared, Eigen::Vector3f& offset,
              Collector& collector) const;
  template <typename Collector>
  void lookAt(const Node& leaf, const Eigen::Vector3f& query, Collector& collector) const;

  std::vector<Eigen::Vector3f> points_;
  std::array<std::vector<float>, 3> coordinates_;  ///< of the points, axis by axis, and some more for whole blocks
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace pcl_floam
