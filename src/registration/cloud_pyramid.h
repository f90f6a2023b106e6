/// \file cloud_pyramid.h
/// One cloud at several resolutions.
#pragma once

#include "registration/local_shape.h"
#include "registration/point_tree.h"

#include <pcl_floam/common/core/cloud_view.h>

#include <Eigen/Core>

#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace pcl_floam {

/// Few points are key points rather than samples of surfaces: each tells a place, not only a surface.
inline constexpr std::size_t kFewPoints = 1000;

/// A cloud at one resolution: its points, or the means of those within each voxel.
struct CloudLevel {
  PointTree tree;           ///< relative to the pyramid's origin
  std::vector<int> number;  ///< in the tree's order: the cloud's point that is this one, or nearest to the mean
  std::vector<std::pair<int, int>> repeated;  ///< numbers of points that are others again, and of these others
  std::vector<LocalShape> shapes;             ///< in the tree's order
  double spacing = 0.0;                       ///< typical distance of neighbours, m
  double rounding = 0.0;                      ///< m; of the cloud's coordinates, wherever its frame's origin is
  double voxel = 0.0;                         ///< m; size of the voxels whose means the points are
};

/// The means of a level's points within voxels of the given size, m.
[[nodiscard]] CloudLevel thinnedLevel(const CloudLevel& finer, double voxel, int threads);

/// A cloud's finite points about their centroid, so that neither single precision nor the equations suffer far from
/// the origin; and thinned versions of it.
class CloudPyramid {
public:
  /// \param selectable one flag per point of the cloud; empty: all
  /// \param is_rough    thinned from the first level on, for clouds of which only a rough picture is needed
  CloudPyramid(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads, bool is_rough = false);

  [[nodiscard]] bool empty() const { return full_.tree.empty(); }

  /// The centroid, in the cloud's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }

  /// Root mean square distance of the points from the centroid, m.
  [[nodiscard]] double extent() const { return extent_; }

  /// All points, or, of a cloud in which the sensor's scan lines or noise show in place of surfaces, means that are
  /// even enough not to show them.
  [[nodiscard]] const CloudLevel& full() const { return full_; }

  /// Ever fewer points, in voxels twice as large from level to level: made when they are first asked for, by any
  /// thread, from nothing but this cloud.
  [[nodiscard]] const std::vector<CloudLevel>& thinnedLevels() const;

private:
  CloudLevel takePoints(const CloudView& cloud, const std::vector<std::uint8_t>& selectable);

  CloudLevel full_;
  mutable std::once_flag thinned_once_;
  mutable std::vector<CloudLevel> thinned_;
  int threads_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double extent_ = 0.0;
};

}  // namespace pcl_floam
