#include "registration/net_information.h"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace pcl_floam {

Vector6 commonUnits(const NormalEquations& equations)
{
  const double per_metre = std::sqrt(equations.weight / equations.squared_extent);
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  return scale;
}

Matrix6 netInformation(const NormalEquations& equations, const Matrix6& information)
{
  if (!(equations.squared_extent > 0.0)) {
    return information;
  }
  const Vector6 scale = commonUnits(equations);
  using Square = Eigen::Matrix<double, 6, 6>;
  const Square net = information - equations.noise_information - equations.chance_information;
  const Eigen::SelfAdjointEigenSolver<Square> solver(scale.asDiagonal() * net * scale.asDiagonal());
  const Square axes = scale.cwiseInverse().asDiagonal() * solver.eigenvectors();
  return axes * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.transpose();
}

}  // namespace pcl_floam
