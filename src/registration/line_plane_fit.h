/// \file line_plane_fit.h
/// Lines and planes fitted to a few map points (the paper's "Pose Estimation", before Eq. 5).
#pragma once

#include "registration/factors.h"

#include <pcl_floam/map/core/neighbor_search.h>

#include <optional>

namespace pcl_floam {

/// Map points that a line or a plane is fitted to: the paper's number.
inline constexpr int kFitNeighbors = 5;
/// Of eigenvalues: a line's largest to its second, stricter than LOAM's 3, since door frames and posts are rounded.
inline constexpr double kLineRatio = 8.0;
/// A plane's second to its smallest.
inline constexpr double kPlaneRatio = 20.0;
/// A plane's second to its largest: no plane through a line.
inline constexpr double kPlaneSpread = 0.02;

/// The line through the neighbours' centre along the eigenvector of the largest eigenvalue of their covariance,
/// relative to the query; nothing unless that eigenvalue is \ref kLineRatio times the second.
[[nodiscard]] std::optional<Factor> fitLine(const Neighbors& neighbors);

/// The plane through the neighbours' centre across the eigenvector of the smallest eigenvalue, relative to the query;
/// nothing unless the second eigenvalue is \ref kPlaneRatio times the smallest and \ref kPlaneSpread times the largest.
///
/// Its variance is that of the neighbours across it, and grows beside their centre, as that of any plane fitted to
/// scattered points does where it is prolonged.
[[nodiscard]] std::optional<Factor> fitPlane(const Neighbors& neighbors);

}  // namespace pcl_floam
