/// \file locked_motions.h
/// Degrees of freedom that keep the guess's value, in information and covariance.
#pragma once

#include <pcl_floam/registration/core/registration_parameters.h>

#include <Eigen/Core>

#include <cstddef>

namespace pcl_floam {

/// Of a pose, and of the velocity after it, the degree of freedom of a row.
[[nodiscard]] inline bool isLocked(const DegreesOfFreedom& locked, Eigen::Index row)
{
  return locked[static_cast<std::size_t>(row % 6)];
}

/// As if they were known: on its diagonal stands \p known of them, and nothing beside that.
template <typename Matrix>
[[nodiscard]] Matrix withLocked(Matrix matrix, const DegreesOfFreedom& locked, double known)
{
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (isLocked(locked, i)) {
      matrix.row(i).setZero();
      matrix.col(i).setZero();
      matrix(i, i) = known;
    }
  }
  return matrix;
}

/// An information matrix that can be inverted.
template <typename Matrix>
[[nodiscard]] Matrix informationWithLocked(const Matrix& information, const DegreesOfFreedom& locked)
{
  return withLocked(information, locked, 1.0);
}

/// A covariance of which they have no part.
template <typename Matrix>
[[nodiscard]] Matrix covarianceWithLocked(const Matrix& covariance, const DegreesOfFreedom& locked)
{
  return withLocked(covariance, locked, 0.0);
}

}  // namespace pcl_floam
