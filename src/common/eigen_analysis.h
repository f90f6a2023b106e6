/// \file eigen_analysis.h
/// Symmetric matrices within some directions of motion, their eigenvalues and eigenvectors. Compiled once, as Eigen's
/// solvers take long to compile.
#pragma once

#include <pcl_floam/common/se3.h>

namespace pcl_floam {

/// Directions of motion (translation, rotation), one a column.
using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// What there is within some directions: as many rows and columns.
using Within = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// D^T m D.
[[nodiscard]] Within within(const Matrix6& m, const Motions& directions);

struct EigenAnalysis {
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> values;  ///< rising
  Within vectors;                                                          ///< in columns
};

/// m v = d v, with v^T v = 1.
[[nodiscard]] EigenAnalysis analyse(const Within& m);

/// m v = d b v, with v^T b v = 1.
/// \param b positive definite
[[nodiscard]] EigenAnalysis analyse(const Within& m, const Within& b);

/// Gram and Schmidt's: an orthonormal basis of what columns have beside those of an orthonormal basis.
[[nodiscard]] Motions orthonormalBeside(const Motions& known, const Motions& columns);

}  // namespace pcl_floam
