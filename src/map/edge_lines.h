/// \file edge_lines.h
/// The edges of keyframes, and the lines that they lie on.
#pragma once

#include "map/voxel_layer.h"

#include <pcl_floam/map/surface.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
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

  void insert(const Eigen::Vector3d* places, std::size_t count) { layer_->insertEach(places, count); }

  [[nodiscard]] bool empty() const override { return layer_->empty(); }

  /// \param lasers not asked: edges of one laser make a line, too, as they are chosen places and not its curve
  void find(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count,
            Surface* surfaces) const override;

  void crop(const Eigen::Vector3d& center, double radius) { layer_->crop(center, radius); }
  void clear() { layer_->clear(); }

private:
  std::unique_ptr<VoxelLayer> layer_;
};

}  // namespace pcl_floam
