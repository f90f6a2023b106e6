#include "common/eigen_analysis.h"

#include <Eigen/Eigenvalues>

namespace pcl_floam {

Within within(const Matrix6& m, const Motions& directions)
{
  const Motions half = m * directions;
  return directions.transpose() * half;
}

EigenAnalysis analyse(const Within& m)
{
  const Eigen::SelfAdjointEigenSolver<Within> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

EigenAnalysis analyse(const Within& m, const Within& b)
{
  const Eigen::GeneralizedSelfAdjointEigenSolver<Within> solver(m, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Motions orthonormalBeside(const Motions& known, const Motions& columns)
{
  constexpr double kDependent = 1e-6;
  Motions all = known;
  for (int i = 0; i < columns.cols() && all.cols() < 6; ++i) {
    Vector6 column = columns.col(i).normalized();
    for (int j = 0; j < all.cols(); ++j) {
      column -= all.col(j).dot(column) * all.col(j);
    }
    if (column.norm() > kDependent) {
      all.conservativeResize(6, all.cols() + 1);
      all.rightCols<1>() = column.normalized();
    }
  }
  return all.rightCols(all.cols() - known.cols());
}

}  // namespace pcl_floam
