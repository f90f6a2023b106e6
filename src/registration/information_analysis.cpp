#include "registration/information_analysis.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>

namespace pcl_floam {

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;  // Eigen 3.4's solvers do not take unaligned types

/// Neighbouring residuals share the errors of the map's planes and of the sweep's motion: so many say no more than one
/// that is independent.
constexpr double kFeaturesPerIndependentOne = 7.0;

}  // namespace

InformationAnalysis::InformationAnalysis(const NormalEquations& equations, double weak_threshold)
    : equations_(equations), weak_threshold_(weak_threshold)
{
  const double extent = std::sqrt(equations.squared_extent / equations.weight);
  const double per_metre = extent > 0.0 ? 1.0 / extent : 1.0;
  scale_ << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  const auto scaled = [&](const Matrix6& m) {
    return Matrix6d(scale_.asDiagonal() * m * scale_.asDiagonal() / equations.weight);
  };
  scaled_ = scaled(equations.information);
  const Matrix6d known =
      weak_threshold > 0.0 ? Matrix6d(scaled_ - scaled(equations.noise_information)) : Matrix6d(scaled_);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(known);
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
}

Matrix6 InformationAnalysis::strongInverse() const
{
  // In the eigenvectors' axes. H may say a little of weak directions, too: its parts that lead there are cut off.
  Matrix6d turned = eigenvectors_.transpose() * scaled_ * eigenvectors_;
  for (int i = 0; i < 6; ++i) {
    if (isWeak(i)) {
      turned.row(i).setZero();
      turned.col(i).setZero();
      turned(i, i) = 1.0;
    }
  }
  Matrix6d inverse = turned.ldlt().solve(Matrix6d::Identity());
  for (int i = 0; i < 6; ++i) {
    if (isWeak(i)) {
      inverse(i, i) = 0.0;
    }
  }
  return eigenvectors_ * inverse * eigenvectors_.transpose();
}

Vector6 InformationAnalysis::step() const
{
  const Vector6 gradient = scale_.asDiagonal() * equations_.gradient / equations_.weight;
  return -(scale_.asDiagonal() * (strongInverse() * gradient));
}

Matrix6 InformationAnalysis::covariance() const
{
  Matrix6 inverse = strongInverse();
  for (int i = 0; i < 6; ++i) {
    if (isWeak(i)) {
      inverse += eigenvectors_.col(i) * eigenvectors_.col(i).transpose() / kNoInformation;
    }
  }
  return poseVariance() / equations_.weight * (scale_.asDiagonal() * inverse * scale_.asDiagonal());
}

double InformationAnalysis::poseVariance() const
{
  return kFeaturesPerIndependentOne * meanWeight() * residualVariance();
}

std::vector<WeakDirection> InformationAnalysis::weakDirections() const
{
  std::vector<WeakDirection> weak;
  for (int i = 0; i < 6 && weak_threshold_ > 0.0 && eigenvalues_[i] < weak_threshold_; ++i) {
    weak.push_back({eigenvectors_.col(i), std::max(0.0, eigenvalues_[i])});
  }
  return weak;
}

}  // namespace pcl_floam
