/// \file neighbor_search.h
/// Nearest neighbours in a layer of the map, by its voxels or by FLANN's KD-tree.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace pcl_floam {

/// A map point near a query, relative to the query: exact also far from the origin.
struct Neighbor {
  Eigen::Vector3f offset;         ///< neighbour minus query, m
  float squared_distance = 0.0F;  ///< m^2
};

/// Most neighbours that one nearest-neighbour query can ask for.
constexpr int kMaxNeighbors = 20;

/// Fixed room for the neighbours of one query, nearest first: no allocation.
struct Neighbors {
  std::array<Neighbor, kMaxNeighbors> neighbor;
  int count = 0;

  const Neighbor& operator[](int i) const { return neighbor[static_cast<std::size_t>(i)]; }
};

/// Nearest neighbours among the points of a map layer.
class NeighborSearch {
public:
  virtual ~NeighborSearch() = default;

  /// True when there is nothing to be found.
  [[nodiscard]] virtual bool empty() const = 0;

  /// The up to \p k nearest points within \p radius of \p query, nearest first.
  /// \param query  world frame, m; a non-finite one has no neighbours
  /// \param k      1 to kMaxNeighbors
  /// \param radius m, > 0
  virtual void nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const = 0;

  /// \ref nearest for \p count queries. A search in a large map can look ahead here, and fetch for one query while it
  /// works on another.
  /// \param queries   world frame, m
  /// \param neighbors room for those of each query
  virtual void nearestOfEach(const Eigen::Vector3d* queries, std::size_t count, int k, double radius,
                             Neighbors* neighbors) const
  {
    for (std::size_t i = 0; i < count; ++i) {
      nearest(queries[i], k, radius, neighbors[i]);
    }
  }
};

}  // namespace pcl_floam
