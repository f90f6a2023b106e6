/// \file factors.h
/// Residuals and their derivatives by the world point (Eq. 5 to 7, 13, 14).
///
/// A factor knows nothing of poses: how the world point depends on the unknowns is the motion model's business
/// (sweep_trajectory.h). Gauss-Newton and Ceres use these same functions.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pcl_floam {

/// Point-to-line factor (Eq. 5).
///
/// The residual is the vector from the line to the point, (I - n n^T)(Tp - p^g). Its norm is the |(Tp - p^g) x n| of
/// Eq. 5 and so is the cost, but unlike p_n of Eq. 6 its derivative exists at distance zero, and Gauss-Newton sees
/// that the point is held in both directions across the line, where the scalar of Eq. 13 holds it in one.
struct EdgeFactor {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d center;     ///< p_E^g
  Eigen::Vector3d direction;  ///< n_E^g, unit

  [[nodiscard]] Eigen::Vector3d residual(const Eigen::Vector3d& point) const
  {
    const Eigen::Vector3d difference = point - center;
    return difference - direction * direction.dot(difference);
  }
  [[nodiscard]] double squaredResidual(const Eigen::Vector3d& point) const { return residual(point).squaredNorm(); }
  [[nodiscard]] Eigen::Matrix3d derivative() const
  {
    return Eigen::Matrix3d::Identity() - direction * direction.transpose();
  }
};

/// Point-to-plane factor (Eq. 7), derivative n_S^g (Eq. 14, which prints the line's direction for it).
struct PlaneFactor {
  static constexpr int kResiduals = 1;
  Eigen::Vector3d center;  ///< p_S^g
  Eigen::Vector3d normal;  ///< n_S^g, unit

  [[nodiscard]] Eigen::Matrix<double, 1, 1> residual(const Eigen::Vector3d& point) const
  {
    return Eigen::Matrix<double, 1, 1>(normal.dot(point - center));
  }
  [[nodiscard]] double squaredResidual(const Eigen::Vector3d& point) const { return residual(point).squaredNorm(); }
  [[nodiscard]] Eigen::RowVector3d derivative() const { return normal.transpose(); }
};

}  // namespace pcl_floam
