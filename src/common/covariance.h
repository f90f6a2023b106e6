/// \file covariance.h
/// What is done with covariances and information matrices of a pose, and of a pose and a velocity. Compiled once: to
/// the compiler each of Eigen's expressions of so many numbers is a program of its own.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

using Matrix12 = Eigen::Matrix<double, 12, 12, Eigen::DontAlign>;
using Vector12 = Eigen::Matrix<double, 12, 1, Eigen::DontAlign>;

/// Of a linear function of what has the covariance: J P J^T.
[[nodiscard]] Matrix6 propagated(const Matrix6& jacobian, const Matrix6& covariance);
[[nodiscard]] Matrix12 propagated(const Matrix12& jacobian, const Matrix12& covariance);

[[nodiscard]] Matrix6 product(const Matrix6& a, const Matrix6& b);
[[nodiscard]] Matrix12 product(const Matrix12& a, const Matrix12& b);

/// \param positive symmetric and positive definite
[[nodiscard]] Matrix6 inverseOf(const Matrix6& positive);
[[nodiscard]] Matrix12 inverseOf(const Matrix12& positive);

/// Of an error, in standard deviations: e^T P^-1 e.
[[nodiscard]] double squaredDeviations(const Vector6& error, const Matrix6& covariance);

/// Of pose and velocity, from their parts.
[[nodiscard]] Matrix12 inBlocks(const Matrix6& top_left, const Matrix6& top_right, const Matrix6& bottom_left,
                                const Matrix6& bottom_right);

}  // namespace pcl_floam
