/// \file sweep_step.h
/// From the normal equations to the next estimate, for each freedom that a sweep may have.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"

#include <pcl_floam/registration/sweep_model.h>

namespace pcl_floam {

/// A left perturbation of a trajectory.
struct SweepStep {
  Vector6 pose = Vector6::Zero();   ///< at the reference instant (Eq. 11)
  Vector6 twist = Vector6::Zero();  ///< over the sweep

  [[nodiscard]] bool isFinite() const { return pose.allFinite() && twist.allFinite(); }
};

/// The equations as the model's pose sees them: where the twist follows from the pose, a change of the pose moves
/// points measured before its instant less, and points after it more.
[[nodiscard]] NormalEquations reducedToPose(const NormalEquations& equations, const SweepModel& model);

/// Pose and twist in one vector, and quadratic forms over it.
using Vector12 = Eigen::Matrix<double, 12, 1, Eigen::DontAlign>;
using Matrix12 = Eigen::Matrix<double, 12, 12, Eigen::DontAlign>;

/// The motion prior as it stands beside the residuals: half of (e + x)^T information (e + x) for a step x, in m^2.
struct MotionPriorTerm {
  Matrix12 information;
  Vector12 error;  ///< e: how far the present trajectory is from the expected one
};

/// \param variance m^2, of one independent residual: what turns the prior's information into the residuals' units
[[nodiscard]] MotionPriorTerm motionPriorTerm(const MotionPrior& prior, const SweepTrajectory& now, double variance);

/// Variance of a residual that is independent of the others, m^2; as the weights have it, whatever they add up to.
[[nodiscard]] double independentVariance(const InformationAnalysis& analysis);

/// Pose and twist under the motion prior. Directions that the correspondences do not constrain are left to the prior.
class FreeSweepSolver {
public:
  FreeSweepSolver(const NormalEquations& equations, const InformationAnalysis& analysis, const MotionPrior& prior,
                  const SweepTrajectory& now);

  /// The Gauss-Newton step.
  [[nodiscard]] SweepStep step() const;

  /// Posterior covariance of the pose.
  [[nodiscard]] Matrix6 poseCovariance() const;

private:
  double covariance_variance_;
  MotionPriorTerm term_;             ///< beside the residuals, for the step
  MotionPriorTerm covariance_term_;  ///< and for the covariance
  Matrix12 measured_;                ///< information of the correspondences
  Vector12 gradient_;
};

}  // namespace pcl_floam
