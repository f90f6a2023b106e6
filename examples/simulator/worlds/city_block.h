/// \file city_block.h
/// A block of houses between four streets.
#pragma once

#include "../triangle_mesh.h"

#include <Eigen/Core>

#include <array>

namespace pcl_floam::simulator {

/// Four corners, counter-clockwise, m.
using BlockOutline = std::array<Eigen::Vector2d, 4>;

/// The outline moved inwards by \p distance metres on all sides.
[[nodiscard]] BlockOutline inset(const BlockOutline& outline, double distance);

/// Adds a block's pavement, houses, trees, lamps, signs and the cars parked along it.
/// \param crossings the middles of the crossings at its corners; the streets run between them
void addCityBlock(TriangleMesh& mesh, Random& random, const Terrain& terrain, const BlockOutline& crossings);

}  // namespace pcl_floam::simulator
