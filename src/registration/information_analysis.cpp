#include "registration/information_analysis.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// An unconstrained direction's eigenvalue in the covariance: large variance, still finite.
constexpr double kNoInformation = 1e-9;

}  // namespace

InformationAnalysis::InformationAnalysis(const NormalEquations& equations, double weak_threshold)
    : equations_(equations), weak_threshold_(weak_threshold)
{
  const double extent = std::sqrt(equations.squared_extent / equations.weight);
  const double per_metre = extent > 0.0 ? 1.0 / extent : 1.0;
  scale_ << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;  // Eigen 3.4's solver does not take unaligned types
  const Matrix6d scaled = scale_.asDiagonal() * equations.information * scale_.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled / equations.weight);
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
}

Vector6 InformationAnalysis::step() const
{
  const Vector6 projected = eigenvectors_.transpose() * scale_.asDiagonal() * equations_.gradient;
  Vector6 solution = Vector6::Zero();
  for (int i = 0; i < 6; ++i) {
    if (!isWeak(i)) {
      solution -= projected[i] / (eigenvalues_[i] * equations_.weight) * eigenvectors_.col(i);
    }
  }
  return scale_.asDiagonal() * solution;
}

Matrix6 InformationAnalysis::covariance() const
{
  const Vector6 inverse = (eigenvalues_.array().max(kNoInformation) * equations_.weight).inverse().matrix();
  const Matrix6 vectors = scale_.asDiagonal() * eigenvectors_;
  return residualVariance() * (vectors * inverse.asDiagonal() * vectors.transpose());
}

Matrix6 InformationAnalysis::strongProjection() const
{
  Matrix6 strong = Matrix6::Zero();
  for (int i = 0; i < 6; ++i) {
    if (!isWeak(i)) {
      strong += eigenvectors_.col(i) * eigenvectors_.col(i).transpose();
    }
  }
  return scale_.asDiagonal() * strong * scale_.cwiseInverse().asDiagonal();
}

std::vector<WeakDirection> InformationAnalysis::weakDirections() const
{
  std::vector<WeakDirection> weak;
  for (int i = 0; i < 6 && eigenvalues_[i] < weak_threshold_; ++i) {
    weak.push_back({eigenvectors_.col(i), eigenvalues_[i]});
  }
  return weak;
}

}  // namespace pcl_floam
