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

/// Gram and Schmidt's: an orthonormal basis of what columns have beside those of an orthonormal basis.
FreeMotions orthonormalBeside(const FreeMotions& known, const FreeMotions& columns)
{
  constexpr double kDependent = 1e-6;
  FreeMotions all = known;
  for (int i = 0; i < columns.cols() && all.cols() < 6; ++i) {
    Eigen::Matrix<double, 6, 1> column = columns.col(i).normalized();
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

AlignmentAnalysis::AlignmentAnalysis(const AlignmentSums& sums, double extent, const FreeMotions& free,
                                     const FreeMotions& held)
    : sums_(sums)
{
  const double per_metre = extent > 0.0 ? 1.0 / extent : 1.0;
  scale_ << 1.0, 1.0, 1.0, per_metre, per_metre, per_metre;
  const Matrix scaled = scale_.asDiagonal() * sums.information * scale_.asDiagonal();
  const auto lengths = [this](const FreeMotions& motions) {
    return FreeMotions(scale_.cwiseInverse().asDiagonal() * motions);
  };
  const FreeMotions basis = orthonormalBeside(orthonormalBeside(FreeMotions(6, 0), lengths(held)), lengths(free));
  eigenvectors_.resize(6, basis.cols());
  if (basis.cols() > 0) {
    using Within = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
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

int AlignmentAnalysis::weak(double share) const
{
  int count = 0;
  while (count < eigenvalues_.size() && eigenvalues_[count] < share * largest()) {
    ++count;
  }
  return count;
}

void AlignmentAnalysis::describe(const Eigen::Vector3d& arm, double weak, const std::vector<double>& shares,
                                 RegistrationReport& report) const
{
  report.cost = sums_.cost;
  report.residual_rms = std::sqrt(variance());
  report.weak_directions.clear();
  // Where the pull grows by less than it seems, the noise that it has moves the pose by as much more.
  Values true_values = eigenvalues_;
  for (int i = 0; i < static_cast<int>(shares.size()); ++i) {
    true_values[i] *= shares[static_cast<std::size_t>(i)] * shares[static_cast<std::size_t>(i)];
  }
  for (int i = 0; i < this->weak(weak); ++i) {
    report.weak_directions.push_back({eigenvectors_.col(i), true_values[i]});
  }
  // A perturbation (t, w) about the source's origin is (t + w x arm, w) about the centroid.
  Matrix to_centroid = Matrix::Identity();
  to_centroid.topRightCorner<3, 3>() = -skew(arm);
  Matrix to_origin = Matrix::Identity();
  to_origin.topRightCorner<3, 3>() = skew(arm);
  report.information = to_centroid.transpose() * sums_.information * to_centroid;
  const Values inverse =
      (true_values.array().max(kNoInformation * largest()) * std::max(sums_.weight, 1e-300)).inverse().matrix();
  const FreeMotions vectors = to_origin * scale_.asDiagonal() * eigenvectors_;
  report.covariance = variance() * (vectors * inverse.asDiagonal() * vectors.transpose());
}

}  // namespace pcl_floam
