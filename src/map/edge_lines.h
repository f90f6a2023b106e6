/// \file edge_lines.h
/// The edges of keyframes, and the lines that they lie on.
#pragma once

#include "map/voxel_layer.h"

#include <pcl_floam/map/core/surface.h>

#include <Eigen/Core>

#include <cstddef>
#include <memory>

namespace pcl_floam {

/// At a place there is the line through the edges nearest to it (the paper's "Pose Estimation", before Eq. 5). A cell
/// of a pyramid would not do: where rings are far apart it has too few edges, or those of the next post as well.
class EdgeLines : public SurfaceSearch {
public:
  EdgeLines();
  EdgeLines(const EdgeLines& other);
  EdgeLines& operator=(const EdgeLines& other) { return *this = EdgeLines(other); }
  EdgeLines(EdgeLines&& other) noexcept = default;
  EdgeLines& operator=(EdgeLines&& other) noexcept = default;
  ~EdgeLines() override = default;

  void clear() { layer_->clear(); }

  /// Edges of one laser make a line, too: they are chosen places and not its curve.
  void insert(const Eigen::Vector3d* places, std::size_t count) { layer_->insertEach(places, count); }

  /// Forgets what is farther than \p radius (m) from \p center.
  void crop(const Eigen::Vector3d& center, double radius) { layer_->crop(center, radius); }

  [[nodiscard]] bool empty() const override { return layer_->empty(); }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override;

private:
  std::unique_ptr<VoxelLayer> layer_;
};

}  // namespace pcl_floam
