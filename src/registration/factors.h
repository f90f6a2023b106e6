/// \file factors.h
/// Residuals and their derivatives by the world point (Eq. 5 to 7, 13, 14).
///
/// A factor knows nothing of poses: how the world point depends on the unknowns is the motion model's business
/// (sweep_trajectory.h). Gauss-Newton and Ceres use these same functions.
#pragma once

#include <pcl_floam/filters/core/feature_kind.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

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

}  // namespace pcl_floam
