/// \file triangle_mesh.h
/// Surfaces made of triangles, and the simple shapes they are built from.
#pragma once

#include "smooth_noise.h"

#include <pcl_floam/common/se3.h>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace pcl_floam::simulator {

/// Triangles seen from both sides, each with a diffuse reflectivity in [0, 1].
struct TriangleMesh {
  std::vector<std::array<float, 3>> vertices;           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< places in \ref vertices
  std::vector<float> reflectivity;                      ///< one per triangle
  std::vector<float> gloss;  ///< by triangle, the part of the light that is not scattered: panes let it through and
                             ///< mirror it, paint mirrors it; 0 beyond its end
};

/// The pose of something that stands upright.
/// \param yaw rad
[[nodiscard]] SE3 upright(double x, double y, double z, double yaw = 0.0);

/// Adds a plane quadrilateral, corners in order around it.
void addQuad(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, double reflectivity);

/// Adds a box that stands on its frame's origin: centred in x and y, z from 0 to size.z.
/// \param taper the top's length and width as a fraction of the bottom's
void addBox(TriangleMesh& mesh, const SE3& world_T_box, const Eigen::Vector3d& size, double reflectivity,
            double taper = 1.0);

/// Adds an upright cylinder or cone without lids, z from 0 to \p height.
/// \param taper the top's radius as a fraction of the bottom's
void addCylinder(TriangleMesh& mesh, const SE3& world_T_cylinder, double radius, double height, double reflectivity,
                 double taper = 1.0, int sides = 12);

/// Adds loose leaves: small triangles scattered in an ellipsoid about the frame's origin.
/// \param radii m, the ellipsoid's half axes
/// \param leaf  m, size of one triangle
void addFoliage(TriangleMesh& mesh, Random& random, const SE3& world_T_crown, const Eigen::Vector3d& radii, double leaf,
                int count, double reflectivity);

constexpr double kGlassGloss = 0.998;  ///< of window panes: only dust on them scatters
constexpr double kPaintGloss = 0.5;    ///< of cars' paint, under its clear coat

/// Makes the triangles from number \p first on glossy, as glass and paint are.
void polish(TriangleMesh& mesh, std::size_t first, double gloss);

/// A rectangle of ground and the resolution of its mesh, m.
struct GroundPatch {
  double min_x, max_x, min_y, max_y, step;
};

/// Adds the ground's surface.
/// \param reflectivity of the ground at a place
void addGround(TriangleMesh& mesh, const Terrain& terrain, const GroundPatch& patch,
               const std::function<double(double x, double y)>& reflectivity);

/// A rectangle of a \ref Relief: how far it stands out of the wall, and what it is made of.
struct ReliefCell {
  double depth = 0.0;  ///< m, towards the viewer
  double reflectivity = 0.4;
  double gloss = 0.0;  ///< see TriangleMesh::gloss
};

/// A wall whose parts lie at different depths: windows, doors, pilasters.
///
/// The wall's frame: x along the wall, y out of it towards the viewer, z up.
struct Relief {
  std::vector<double> columns;    ///< m, rising: borders of the cells along x
  std::vector<double> rows;       ///< m, rising: borders of the cells along z
  std::vector<ReliefCell> cells;  ///< row by row, bottom first

  /// A wall of equal cells.
  Relief(std::vector<double> column_borders, std::vector<double> row_borders, const ReliefCell& cell);

  [[nodiscard]] ReliefCell& cell(std::size_t row, std::size_t column)
  {
    return cells[row * (columns.size() - 1) + column];
  }
  [[nodiscard]] const ReliefCell& cell(std::size_t row, std::size_t column) const
  {
    return cells[row * (columns.size() - 1) + column];
  }
};

/// Adds a relief: the faces of its cells, and the steps between cells of different depth.
void addRelief(TriangleMesh& mesh, const SE3& world_T_wall, const Relief& relief);

}  // namespace pcl_floam::simulator
