/// \file information_analysis.h
/// Which directions of motion the correspondences constrain, and the step and covariance that follow.
#pragma once

#include "common/eigen_analysis.h"
#include "registration/normal_equations.h"

#include <pcl_floam/registration/core/registration_report.h>

#include <Eigen/Core>

#include <vector>

namespace pcl_floam {

/// Perturbations about the local origin that move those degrees of freedom of a frame that are not locked.
/// \param arm from the frame's origin to the local origin, in the target's axes
[[nodiscard]] Motions freeMotions(const DegreesOfFreedom& locked, const Eigen::Vector3d& arm = Eigen::Vector3d::Zero());

/// Eigen-analysis of H in metres: rotations are scaled by the root mean square distance of the points, so that an
/// eigenvalue tells how well a displacement of the typical point is seen, whatever its direction.
///
/// What the noise of the normals seems to tell is taken out before a direction is called weak or strong: along a smooth
/// corridor that is all there is.
class InformationAnalysis {
public:
  /// \param weak_threshold eigenvalues per correspondence below this are weak; 0: none is, and noise is not looked for
  /// \param held           perturbations that are taken out of the free ones
  explicit InformationAnalysis(const NormalEquations& equations, double weak_threshold = 0.0,
                               const Motions& free = Motions::Identity(6, 6), const Motions& held = Motions(6, 0));

  /// The Gauss-Newton step -H^-1 b; zero along weak directions, where following the noise would only do harm
  /// (solution remapping after Zhang and Singh, 2016).
  [[nodiscard]] Vector6 step() const;

  /// How many directions, from the least to the best held, have an eigenvalue below a limit.
  [[nodiscard]] int below(double limit) const { return static_cast<int>((eigenvalues_.array() < limit).count()); }
  [[nodiscard]] double largest() const;

  /// A perturbation along direction \p i that moves the typical point by 1 m, and the gradient along it per m, as the
  /// correspondences stand.
  [[nodiscard]] Vector6 motion(int i) const { return scale_.cwiseProduct(eigenvectors_.col(i)); }
  [[nodiscard]] double stiffness(int i) const { return eigenvalues_[i] * weight_; }

  /// What a perturbation has along direction \p i, m.
  [[nodiscard]] double part(const Vector6& perturbation, int i) const;

  /// By how much a perturbation moves the typical point, m.
  [[nodiscard]] double length(const Vector6& perturbation) const { return perturbation.cwiseQuotient(scale_).norm(); }

  /// Covariance of the perturbation; weak directions get the variance of an eigenvalue near zero.
  /// \param variance of a residual of weight 1, m^2
  /// \param shares   of the first directions: how much of their eigenvalue is true, see WeakDirections
  [[nodiscard]] Matrix6 covariance(double variance, const std::vector<double>& shares = {}) const;

  /// The directions with eigenvalues below a limit.
  [[nodiscard]] std::vector<WeakDirection> weakDirections(double limit, const std::vector<double>& shares = {}) const;

private:
  [[nodiscard]] double leastInformation() const;
  void invert(Within turned);

  const NormalEquations& equations_;
  double weak_threshold_;
  double weight_;  ///< sum of the weights, not zero
  Vector6 scale_;  ///< from scaled unknowns (all in m) to (m, rad)
  /// Of the scaled H without noise over the sum of the weights, within the free motions.
  decltype(EigenAnalysis::values) eigenvalues_;
  Motions eigenvectors_;  ///< columns, of the same
  Within inverse_;        ///< of H in their axes within the strong directions, zero along weak ones
};

/// Neighbouring residuals share the errors of what they are matched with and of the sweep's motion: so many say no more
/// than one that is independent.
inline constexpr double kMatchesPerIndependentOne = 7.0;

/// Variance of a residual of weight 1 of features, were they independent, as the poses' errors show it, m^2.
[[nodiscard]] double featureVariance(const NormalEquations& equations);

}  // namespace pcl_floam
