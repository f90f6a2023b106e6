/// \file alignment_analysis.h
/// Which directions of motion the matches of two clouds constrain, and the step and covariance that follow.
#pragma once

#include "registration/level_alignment.h"

#include <pcl_floam/registration/registration_report.h>

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace pcl_floam {

/// Perturbations about a cloud's centroid that are free: one a column.
using FreeMotions = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// Those of the degrees of freedom of the cloud's frame that are not locked.
/// \param arm from the frame's origin to the centroid, in the target's axes
[[nodiscard]] FreeMotions freeMotions(const DegreesOfFreedom& locked, const Eigen::Vector3d& arm);

/// Eigen-analysis of H in metres: rotations are scaled by the cloud's extent.
class AlignmentAnalysis {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  using Vector = Eigen::Matrix<double, 6, 1>;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

public:
  /// \param extent root mean square distance of the source's points from their centroid, m
  /// \param held   perturbations that are taken out of the free ones
  AlignmentAnalysis(const AlignmentSums& sums, double extent, const FreeMotions& free, const FreeMotions& held);

  /// The damped Gauss-Newton step, about the centroid; zero along directions without any information.
  [[nodiscard]] Vector6 step() const;

  /// How many directions, from the least to the best held, have less than this share of the largest eigenvalue.
  [[nodiscard]] int weak(double share) const;

  /// A perturbation along direction \p i that moves the typical point by 1 m, and the matches' gradient along it per m,
  /// as they stand.
  [[nodiscard]] Vector motion(int i) const { return scale_.asDiagonal() * eigenvectors_.col(i); }
  [[nodiscard]] double stiffness(int i) const { return eigenvalues_[i] * std::max(sums_.weight, 1e-300); }

  /// What a perturbation has along direction \p i, m.
  [[nodiscard]] double part(const Vector& perturbation, int i) const
  {
    return eigenvectors_.col(i).dot(scale_.cwiseInverse().asDiagonal() * perturbation);
  }

  /// By how much a perturbation moves the typical point, m.
  [[nodiscard]] double length(const Vector& perturbation) const
  {
    return (scale_.cwiseInverse().asDiagonal() * perturbation).norm();
  }

  /// Weighted mean of the squared residuals, m^2.
  [[nodiscard]] double variance() const { return sums_.weight > 0.0 ? sums_.weighted_squares / sums_.weight : 0.0; }

  /// Fills in cost, residual, information, covariance (about the source's origin) and weak directions (about its
  /// centroid).
  /// \param arm    from the source's origin to its centroid, in the target's axes
  /// \param weak   share of the largest eigenvalue below which a direction is weak
  /// \param shares of the first directions: how much of their eigenvalue is true, see WeakDirections
  void describe(const Eigen::Vector3d& arm, double weak, const std::vector<double>& shares,
                RegistrationReport& report) const;

private:
  [[nodiscard]] double largest() const;

  const AlignmentSums& sums_;
  Vector scale_;              ///< from scaled unknowns (all in m) to (m, rad)
  Values eigenvalues_;        ///< of the scaled H over the sum of the weights, within the free motions
  FreeMotions eigenvectors_;  ///< columns, of the same
};

}  // namespace pcl_floam
