/// \file cloud_pyramid.h
/// One cloud at several resolutions.
#pragma once

#include "registration/local_shape.h"
#include "registration/point_tree.h"

#include <pcl_floam/common/cloud_view.h>

#include <Eigen/Core>

#include <cstdint>
#include <deque>
#include <vector>

namespace pcl_floam {

/// A cloud at one resolution: its points, or the means of those within each voxel.
struct CloudLevel {
  PointTree tree;                  ///< relative to the pyramid's origin
  std::vector<int> number;         ///< in the tree's order: the cloud's point that is this one, or nearest to the mean
  std::vector<LocalShape> shapes;  ///< in the tree's order
  double spacing = 0.0;            ///< typical distance of neighbours, m
};

/// A cloud's finite points about their centroid, so that neither single precision nor the equations suffer far from
/// the origin; and thinned versions of it.
class CloudPyramid {
public:
  /// \param selectable one flag per point of the cloud; empty: all
  CloudPyramid(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads);

  /// A pyramid whose level 0 is thinned already, for clouds of which only a rough picture is needed.
  [[nodiscard]] static CloudPyramid thinned(const CloudView& cloud, const std::vector<std::uint8_t>& selectable,
                                            int threads);

  [[nodiscard]] bool empty() const { return levels_[0].tree.empty(); }

  /// The centroid, in the cloud's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }

  /// Root mean square distance of the points from the centroid, m.
  [[nodiscard]] double extent() const { return extent_; }

  /// Level 0 holds all points, each further one fewer.
  [[nodiscard]] const CloudLevel& level(std::size_t number) const { return levels_[number]; }
  [[nodiscard]] std::size_t levels() const { return levels_.size(); }

  /// Adds the level of the means within voxels of the given size, m, made from the last level.
  void addLevel(double voxel_size, int threads);

private:
  struct Points {
    std::vector<Eigen::Vector3f> position;  ///< relative to the origin
    std::vector<int> number;                ///< in the cloud
  };

  CloudPyramid() = default;
  Points takePoints(const CloudView& cloud, const std::vector<std::uint8_t>& selectable);

  std::deque<CloudLevel> levels_;  ///< a deque: references to levels stay valid when one is added
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double extent_ = 0.0;
};

}  // namespace pcl_floam
