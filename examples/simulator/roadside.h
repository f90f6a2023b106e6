/// \file roadside.h
/// What runs along a road: kerbs, rails, banks; and houses.
#pragma once

#include "path_line.h"
#include "triangle_mesh.h"

#include <vector>

namespace pcl_floam::simulator {

/// A corner of the cross-section of a strip.
struct StripCorner {
  double left;    ///< m, to the left of the line
  double height;  ///< m, above the ground
};

/// Part of a line, and how finely a strip along it is cut.
struct StripExtent {
  double from, to, step;  ///< m
};

/// Adds a strip: a cross-section drawn along a line, on the terrain.
/// \param unevenness m, standard deviation of each corner's height from one cut to the next
void addStrip(TriangleMesh& mesh, Random& random, const PathLine& line, const Terrain& terrain,
              const StripExtent& extent, const std::vector<StripCorner>& section, double unevenness,
              double reflectivity);

/// Adds a house with a facade in relief: windows by storeys, doors, pilasters, cornice, balconies.
/// \param world_T_front x along the facade from its left end, y out of it towards the street, z up from the ground
void addHouse(TriangleMesh& mesh, Random& random, const SE3& world_T_front, double width);

}  // namespace pcl_floam::simulator
