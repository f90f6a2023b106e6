/// \file map_sketch.h
/// The map as a ground plan: what stands upright, drawn; floor and ceiling, left out.
#pragma once

#include "plot_frame.h"

#include <Eigen/Core>

#include <vector>

namespace pcl_floam::tools {

/// The middles of the ground cells over which points at several heights lie: walls, poles, vehicles, trunks.
/// \param cell m, edge of a cell
[[nodiscard]] std::vector<Eigen::Vector2d> uprightCells(const std::vector<Eigen::Vector3d>& points,
                                                        const GroundArea& area, double cell);

}  // namespace pcl_floam::tools
