/// \file information_analysis.h
/// Which directions of motion the correspondences constrain, and the step and covariance that follow.
#pragma once

#include "registration/normal_equations.h"

#include <pcl_floam/registration/registration_report.h>

#include <algorithm>
#include <vector>

namespace pcl_floam {

/// Eigen-analysis of H in metres: rotations are scaled by the root mean square distance of the points, so that an
/// eigenvalue tells how well a displacement of the typical point is seen, whatever its direction.
///
/// What the noise of the normals seems to tell is taken out before a direction is called weak or strong: along a smooth
/// corridor that is all there is.
class InformationAnalysis {
public:
  /// \param weak_threshold eigenvalues per correspondence below this are weak; 0: none is, and noise is not looked for
  InformationAnalysis(const NormalEquations& equations, double weak_threshold);

  /// The Gauss-Newton step -H^-1 b; zero along weak directions, where following the noise would only do harm
  /// (solution remapping after Zhang and Singh, 2016).
  [[nodiscard]] Vector6 step() const;

  /// Covariance of the perturbation; weak directions get the variance of an eigenvalue near zero.
  [[nodiscard]] Matrix6 covariance() const;

  [[nodiscard]] std::vector<WeakDirection> weakDirections() const;

  /// Weighted mean of the squared residuals, m^2.
  [[nodiscard]] double residualVariance() const { return equations_.weighted_squares / equations_.weight; }

  /// Variance of a residual of weight 1, were they independent, as the poses' errors show it, m^2.
  [[nodiscard]] double poseVariance() const;

  /// Mean of the given weights: what one correspondence counts in the sums.
  [[nodiscard]] double meanWeight() const { return equations_.given_weight / (equations_.edges + equations_.planes); }

private:
  /// An eigenvalue of less is rounding: nothing is known of the direction, whatever the threshold.
  static constexpr double kNoInformation = 1e-9;

  [[nodiscard]] bool isWeak(int i) const { return !(eigenvalues_[i] >= std::max(weak_threshold_, kNoInformation)); }

  /// Inverse of the scaled H within the strong directions, zero along weak ones.
  [[nodiscard]] Matrix6 strongInverse() const;

  const NormalEquations& equations_;
  double weak_threshold_;
  Vector6 scale_;         ///< from scaled unknowns (all in m) to (m, rad)
  Vector6 eigenvalues_;   ///< of the scaled H without noise over the sum of the weights
  Matrix6 eigenvectors_;  ///< columns, of the same
  Matrix6 scaled_;        ///< the scaled H over the sum of the weights
};

}  // namespace pcl_floam
