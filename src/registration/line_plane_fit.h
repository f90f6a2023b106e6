/// \file line_plane_fit.h
/// Lines and planes fitted to a few map points (the paper's "Pose Estimation", before Eq. 5).
#pragma once

#include "registration/factors.h"

#include <pcl_floam/map/neighbor_search.h>
#include <pcl_floam/registration/registration_parameters.h>

#include <optional>

namespace pcl_floam {

/// The line through the neighbours' centre along the eigenvector of the largest eigenvalue of their covariance,
/// relative to the query; nothing unless that eigenvalue is `line_ratio` times the second.
[[nodiscard]] std::optional<Factor> fitLine(const Neighbors& neighbors, const RegistrationParameters& parameters);

/// The plane through the neighbours' centre across the eigenvector of the smallest eigenvalue, relative to the query;
/// nothing unless the second eigenvalue is `plane_ratio` times the smallest and `plane_spread` times the largest.
///
/// Its variance is that of the neighbours across it, and grows beside their centre, as that of any plane fitted to
/// scattered points does where it is prolonged.
[[nodiscard]] std::optional<Factor> fitPlane(const Neighbors& neighbors, const RegistrationParameters& parameters);

}  // namespace pcl_floam
