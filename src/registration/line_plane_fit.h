/// \file line_plane_fit.h
/// Lines and planes fitted to a few map points (the paper's "Pose Estimation", before Eq. 5).
#pragma once

#include <pcl_floam/map/neighbor_search.h>
#include <pcl_floam/registration/registration_parameters.h>

#include <Eigen/Core>

#include <array>
#include <optional>

namespace pcl_floam {

/// p_E^g and n_E^g: a point of the line, relative to the query, and its unit direction.
struct LineFit {
  Eigen::Vector3d center;
  Eigen::Vector3d direction;
};

/// p_S^g and n_S^g: a point of the plane, relative to the query, and its unit normal.
struct PlaneFit {
  Eigen::Vector3d center;
  Eigen::Vector3d normal;
  /// Variance of the neighbours across the plane, m^2. Beside the neighbours' centre it grows, as that of any line or
  /// plane fitted to scattered points does where it is prolonged.
  double variance;
  /// By what the normal may be off: its covariance is the sum of their outer products.
  std::array<Eigen::Vector3d, 2> tilt;
};

/// The line through the neighbours' centre along the eigenvector of the largest eigenvalue of their covariance;
/// nothing unless that eigenvalue is `line_ratio` times the second.
[[nodiscard]] std::optional<LineFit> fitLine(const Neighbors& neighbors, const RegistrationParameters& parameters);

/// The plane through the neighbours' centre across the eigenvector of the smallest eigenvalue; nothing unless the
/// second eigenvalue is `plane_ratio` times the smallest and `plane_spread` times the largest.
[[nodiscard]] std::optional<PlaneFit> fitPlane(const Neighbors& neighbors, const RegistrationParameters& parameters);

}  // namespace pcl_floam
