#include "registration/alignment_analysis.h"

#include <pcl_floam/common/se3.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Directions with less than this share of the largest eigenvalue are held by nothing but rounding.
constexpr double kNoInformation = 1e-9;

/// Added to all eigenvalues, as a share of the largest: keeps steps along the weakest directions short.
constexpr double kDamping = 1e-7;

/// Gram and Schmidt's, for independent columns.
FreeMotions orthonormal(FreeMotions columns)
{
  for (int i = 0; i < columns.cols(); ++i) {
    for (int j = 0; j < i; ++j) {
      columns.col(i) -= columns.col(j).dot(columns.col(i)) * columns.col(j);
    }
    columns.col(i).normalize();
  }
  return columns;
}

}  // namespace

FreeMotions freeMotions(const DegreesOfFreedom& locked, const Eigen::Vector3d& arm)
{
  FreeMotions free(6, 0);
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

AlignmentAnalysis::AlignmentAnalysis(const AlignmentSums& sums, double extent, const FreeMotions& free) : sums_(sums)
{
  const double per_metre = extent > 0.0 ? 1.0 / extent : 1.0;
  scale_ << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  const Matrix scaled = scale_.asDiagonal() * sums.information * scale_.asDiagonal();
  eigenvectors_.resize(6, free.cols());
  if (free.cols() > 0) {
    using Within = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
    const FreeMotions basis = orthonormal(scale_.cwiseInverse().asDiagonal() * free);
    const Within within = basis.transpose() * scaled * basis / std::max(sums.weight, 1e-300);
    const Eigen::SelfAdjointEigenSolver<Within> solver(within);
    eigenvalues_ = solver.eigenvalues();
    eigenvectors_ = basis * solver.eigenvectors();
  }
}

double AlignmentAnalysis::largest() const
{
  return eigenvalues_.size() > 0 ? std::max(eigenvalues_.maxCoeff(), 1e-300) : 1e-300;
}

Vector6 AlignmentAnalysis::step() const
{
  const Values projected = eigenvectors_.transpose() * (scale_.asDiagonal() * sums_.gradient);
  Vector solution = Vector::Zero();
  for (int i = 0; i < eigenvalues_.size(); ++i) {
    if (eigenvalues_[i] > kNoInformation * largest()) {
      solution -= projected[i] / ((eigenvalues_[i] + kDamping * largest()) * sums_.weight) * eigenvectors_.col(i);
    }
  }
  return scale_.asDiagonal() * solution;
}

void AlignmentAnalysis::describe(const Eigen::Vector3d& arm, double weak, RegistrationReport& report) const
{
  report.cost = sums_.cost;
  const double variance = sums_.weight > 0.0 ? sums_.weighted_squares / sums_.weight : 0.0;
  report.residual_rms = std::sqrt(variance);
  report.weak_directions.clear();
  for (int i = 0; i < eigenvalues_.size() && eigenvalues_[i] < weak * largest(); ++i) {
    report.weak_directions.push_back({eigenvectors_.col(i), eigenvalues_[i]});
  }
  // A perturbation (t, w) about the source's origin is (t + w x arm, w) about the centroid.
  Matrix to_centroid = Matrix::Identity();
  to_centroid.topRightCorner<3, 3>() = -skew(arm);
  Matrix to_origin = Matrix::Identity();
  to_origin.topRightCorner<3, 3>() = skew(arm);
  report.information = to_centroid.transpose() * sums_.information * to_centroid;
  const Values inverse =
      (eigenvalues_.array().max(kNoInformation * largest()) * std::max(sums_.weight, 1e-300)).inverse().matrix();
  const FreeMotions vectors = to_origin * scale_.asDiagonal() * eigenvectors_;
  report.covariance = variance * (vectors * inverse.asDiagonal() * vectors.transpose());
}

}  // namespace pcl_floam
