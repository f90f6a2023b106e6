/// \file alignment_analysis.h
/// Which directions of motion the matches of two clouds constrain, and the step and covariance that follow.
#pragma once

#include "registration/level_alignment.h"

#include <pcl_floam/registration/registration_report.h>

#include <Eigen/Core>

namespace pcl_floam {

/// Perturbations about a cloud's centroid that are free: one a column.
using FreeMotions = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// Those of the degrees of freedom of the cloud's frame that are not locked.
/// \param arm from the frame's origin to the centroid, in the target's axes
[[nodiscard]] FreeMotions freeMotions(const DegreesOfFreedom& locked, const Eigen::Vector3d& arm);

/// Eigen-analysis of H in metres: rotations are scaled by the cloud's extent.
class AlignmentAnalysis {
public:
  /// \param extent root mean square distance of the source's points from their centroid, m
  AlignmentAnalysis(const AlignmentSums& sums, double extent, const FreeMotions& free);

  /// The damped Gauss-Newton step, about the centroid; zero along directions without any information.
  [[nodiscard]] Vector6 step() const;

  /// Fills in cost, residual, information, covariance (about the source's origin) and weak directions (about its
  /// centroid).
  /// \param arm  from the source's origin to its centroid, in the target's axes
  /// \param weak share of the largest eigenvalue below which a direction is weak
  void describe(const Eigen::Vector3d& arm, double weak, RegistrationReport& report) const;

private:
  using Matrix = Eigen::Matrix<double, 6, 6>;
  using Vector = Eigen::Matrix<double, 6, 1>;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;

  [[nodiscard]] double largest() const;

  const AlignmentSums& sums_;
  Vector scale_;              ///< from scaled unknowns (all in m) to (m, rad)
  Values eigenvalues_;        ///< of the scaled H over the sum of the weights, within the free motions
  FreeMotions eigenvectors_;  ///< columns, of the same
};

}  // namespace pcl_floam
