/// \file edge_lines.h
/// The edges of keyframes, and the lines that they lie on.
#pragma once

#include "map/voxel_layer.h"

#include <pcl_floam/map/core/surface_map.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace pcl_floam {

/// At a place there is the line through the edges nearest to it (the paper's "Pose Estimation", before Eq. 5). A cell
/// of a pyramid would not do: where rings are far apart it has too few edges, or those of the next post as well.
class EdgeLines : public SurfaceMap {
public:
  EdgeLines();
  EdgeLines(const EdgeLines& other);
  EdgeLines& operator=(const EdgeLines& other) { return *this = EdgeLines(other); }
  EdgeLines(EdgeLines&& other) noexcept = default;
  EdgeLines& operator=(EdgeLines&& other) noexcept = default;
  ~EdgeLines() override = default;

  /// \param side not asked: posts and frames are of the same size wherever the sensor is
  [[nodiscard]] std::unique_ptr<SurfaceMap> makeEmpty(double side) const override;
  [[nodiscard]] std::unique_ptr<SurfaceMap> copy() const override { return std::make_unique<EdgeLines>(*this); }
  void clear() override { layer_->clear(); }

  /// \param lasers not asked: edges of one laser make a line, too, as they are chosen places and not its curve
  void insert(const Eigen::Vector3d* places, const std::uint32_t* lasers, std::size_t count) override;
  void crop(const Eigen::Vector3d& center, double radius) override { layer_->crop(center, radius); }

  [[nodiscard]] bool empty() const override { return layer_->empty(); }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override;

private:
  std::unique_ptr<VoxelLayer> layer_;
};

}  // namespace pcl_floam
