/// \file surface_fit.h
/// The shape of a cell's points from their running sums.
#pragma once

#include "common/point_moments.h"

#include <pcl_floam/map/core/surface.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>

namespace pcl_floam {

/// Standard deviation of a return's place, m.
inline constexpr double kRangeNoise = 0.02;

/// Count, sum and sum of outer products of points about a common origin, and the lasers that saw them.
struct CellSums {
  PointMoments points;
  std::uint64_t lasers = 0;  // bits

  void add(const Eigen::Vector3d& point, std::uint32_t laser);
};

/// A plane or a line: what the sums tell of it. The mean is from the sums' origin.
struct CellShape {
  std::array<float, 3> mean{};
  std::array<float, 3> direction{};
  float thickness = 0.0F;
  float extent = 0.0F;
};

struct CellFit {
  SurfaceKind kind = SurfaceKind::unknown;
  CellShape shape;
  /// Of what is neither plane nor line, which displacements show among its points (\ref Surface::observability); of a
  /// plane its longer direction and the variance along that.
  std::array<float, 9> along{};
};

/// A shape that chance, noise or the sampling pattern of a single laser would give is none.
/// \param side   m, of the cell
/// \param around the cell of twice the side that holds it; nullptr: there is none, and so no telling whether what is
///               neither plane nor line ends with the cell: no displacement shows
[[nodiscard]] CellFit fitOf(const CellSums& sums, double side, const CellSums* around);

}  // namespace pcl_floam
