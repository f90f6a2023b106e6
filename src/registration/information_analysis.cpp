#include "registration/information_analysis.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Directions with less than this share of the largest eigenvalue are held by nothing but rounding.
constexpr double kNoInformation = 1e-9;

/// Sums and eigenvalues are divided by no less.
constexpr double kSmallest = 1e-300;

}  // namespace

Motions freeMotions(const DegreesOfFreedom& locked, const Eigen::Vector3d& arm)
{
  Motions free(6, 0);
  for (int i = 0; i < 6; ++i) {
    if (!locked[static_cast<std::size_t>(i)]) {
      Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Unit(i);
      motion.head<3>() += Eigen::Vector3d(motion.tail<3>()).cross(arm);
      free.conservativeResize(6, free.cols() + 1);
      free.rightCols<1>() = motion;
    }
  }
  return free;
}

InformationAnalysis::InformationAnalysis(const NormalEquations& equations, double weak_threshold, const Motions& free,
                                         const Motions& held)
    : equations_(equations), weak_threshold_(weak_threshold), weight_(std::max(equations.weight, kSmallest))
{
  const double extent = std::sqrt(equations.squared_extent / weight_);
  const double per_metre = extent > 0.0 ? 1.0 / extent : 1.0;
  scale_ << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  const auto lengths = [this](const Motions& motions) { return Motions(scale_.cwiseInverse().asDiagonal() * motions); };
  const Motions basis = orthonormalBeside(orthonormalBeside(Motions(6, 0), lengths(held)), lengths(free));
  eigenvectors_.resize(6, basis.cols());
  if (basis.cols() == 0) {
    return;
  }
  const auto scaled = [&](const Matrix6& m) {
    return Matrix6(scale_.asDiagonal() * m * scale_.asDiagonal() / weight_);
  };
  const Matrix6 all = scaled(equations.information);
  const Matrix6 known = weak_threshold > 0.0 ? Matrix6(all - scaled(equations.noise_information)) : all;
  const EigenAnalysis analysis = analyse(within(known, basis));
  eigenvalues_ = analysis.values;
  eigenvectors_ = basis * analysis.vectors;
  invert(within(all, eigenvectors_));
}

/// H may say a little of weak directions, too: its parts that lead there are cut off.
void InformationAnalysis::invert(Within turned)
{
  const int weak = below(leastInformation());
  turned.topRows(weak).setZero();
  turned.leftCols(weak).setZero();
  turned.diagonal().head(weak).setOnes();
  inverse_ = turned.ldlt().solve(Within::Identity(turned.rows(), turned.cols()));
  inverse_.diagonal().head(weak).setZero();
}

double InformationAnalysis::largest() const
{
  return eigenvalues_.size() > 0 ? std::max(eigenvalues_.maxCoeff(), kSmallest) : kSmallest;
}

double InformationAnalysis::leastInformation() const
{
  return std::max(weak_threshold_, kNoInformation * largest());
}

double InformationAnalysis::part(const Vector6& perturbation, int i) const
{
  return eigenvectors_.col(i).dot(perturbation.cwiseQuotient(scale_));
}

Vector6 InformationAnalysis::step() const
{
  const Motions motions = scale_.asDiagonal() * eigenvectors_;
  return -(motions * (inverse_ * (motions.transpose() * equations_.gradient / weight_)));
}

Matrix6 InformationAnalysis::covariance(double variance, const std::vector<double>& shares) const
{
  const double most = 1.0 / (kNoInformation * largest());
  Within inverse = inverse_;
  for (int i = 0; i < below(leastInformation()); ++i) {
    inverse(i, i) = most;
  }
  // Where the pull grows by less than it seems, the noise that it has moves the pose by as much more.
  for (int i = 0; i < static_cast<int>(shares.size()); ++i) {
    const double times = std::min(1.0 / shares[static_cast<std::size_t>(i)], std::sqrt(most / inverse(i, i)));
    inverse.row(i) *= times;
    inverse.col(i) *= times;
  }
  const Motions motions = scale_.asDiagonal() * eigenvectors_;
  const Motions half = motions * inverse;
  return variance / weight_ * Matrix6(half * motions.transpose());
}

std::vector<WeakDirection> InformationAnalysis::weakDirections(double limit, const std::vector<double>& shares) const
{
  std::vector<WeakDirection> weak;
  for (int i = 0; i < below(limit); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double share = n < shares.size() ? shares[n] : 1.0;
    weak.push_back({eigenvectors_.col(i), std::max(0.0, share * share * eigenvalues_[i])});
  }
  return weak;
}

double featureVariance(const NormalEquations& equations)
{
  constexpr double kLeast = 1e-6;  // m^2: no map is better than to a millimetre, however well it fits
  const double mean_weight = equations.given_weight / (equations.edges + equations.planes);
  return kMatchesPerIndependentOne * mean_weight * std::max(kLeast, equations.residualVariance());
}

}  // namespace pcl_floam
