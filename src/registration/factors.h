/// \file factors.h
/// Lines and planes fitted to a few map points (the paper's "Pose Estimation", before Eq. 5); the residuals of what
/// they hold, and their derivatives by the world point (Eq. 5 to 7, 13, 14).
///
/// A factor knows nothing of poses: how the world point depends on the unknowns is the motion model's business
/// (sweep_trajectory.h). Gauss-Newton and Ceres use these same functions.
#pragma once

#include <pcl_floam/filters/core/feature_kind.h>
#include <pcl_floam/map/core/neighbor_search.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <optional>

namespace pcl_floam {

/// The line that holds an edge (Eq. 5), or the plane that holds a plane feature (Eq. 7).
///
/// The residual is the vector from the line or plane to the point, P (Tp - p^g) with P = I - n n^T or n n^T. Its norm
/// is the |(Tp - p^g) x n| of Eq. 5 or the distance of Eq. 7 and so is the cost; but unlike p_n of Eq. 6 an edge's
/// derivative exists at distance zero, and Gauss-Newton sees that the point is held in both directions across the line,
/// where the scalar of Eq. 13 holds it in one. Eq. 14 prints the line's direction for the plane's normal.
struct Factor {
  FeatureKind kind = FeatureKind::plane;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();      ///< p_E^g or p_S^g
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< of the line, or across the plane: n_E^g or n_S^g, unit
  double variance = 0.0;                                 ///< of a plane at the point that it holds, m^2; 0 for lines
  /// By what a plane's normal may be off: its covariance is the sum of their outer products. Zero for lines.
  std::array<Eigen::Vector3d, 2> tilt = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

  [[nodiscard]] Eigen::Vector3d residual(const Eigen::Vector3d& point) const
  {
    const Eigen::Vector3d difference = point - center;
    const Eigen::Vector3d along = direction * direction.dot(difference);
    return kind == FeatureKind::plane ? along : Eigen::Vector3d(difference - along);
  }

  /// P.
  [[nodiscard]] Eigen::Matrix3d derivative() const
  {
    const Eigen::Matrix3d along = direction * direction.transpose();
    return kind == FeatureKind::plane ? along : Eigen::Matrix3d(Eigen::Matrix3d::Identity() - along);
  }

  /// One across a plane, two across a line: they say all that the residual says.
  [[nodiscard]] int directions() const { return kind == FeatureKind::plane ? 1 : 2; }
  [[nodiscard]] Eigen::Vector3d heldDirection(int i) const
  {
    if (kind == FeatureKind::plane) {
      return direction;
    }
    const Eigen::Vector3d across = direction.unitOrthogonal();
    return i == 0 ? across : Eigen::Vector3d(direction.cross(across));
  }
};

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
