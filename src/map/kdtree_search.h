/// \file kdtree_search.h
/// Nearest neighbours by FLANN's KD-tree, the paper's choice.
#pragma once

#include <pcl_floam/map/core/neighbor_search.h>

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace pcl_floam {

/// A KD-tree over a fixed set of points.
class KdTreeSearch : public NeighborSearch {
public:
  /// \param points world frame, m; those that are not finite are left out; may be empty
  explicit KdTreeSearch(const std::vector<Eigen::Vector3d>& points);
  ~KdTreeSearch() override;

  [[nodiscard]] bool empty() const override;

  void nearest(const Eigen::Vector3d& query, int k, double radius, Neighbors& neighbors) const override;

private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace pcl_floam
