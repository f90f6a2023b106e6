#include "registration/sweep_step.h"

#include <Eigen/Cholesky>

namespace pcl_floam {

namespace {

/// Neighbouring residuals share the errors of the map and of the sensor: so many of them say no more than one that is
/// independent. Beside the motion prior they count for less than in the covariance, as what is common to a whole map
/// does not show in them; the covariance's number is that of test_covariance_calibration.cpp.
constexpr double kResidualsBesidePrior = 20.0;
constexpr double kResidualsInCovariance = 3.0;

/// Inverse of a 2x2 covariance.
struct Precision {
  explicit Precision(const MotionPrior::Spread& spread)
  {
    const double determinant = spread.pose * spread.twist - spread.common * spread.common;
    pose = spread.twist / determinant;
    twist = spread.pose / determinant;
    common = -spread.common / determinant;
  }
  double pose;
  double twist;
  double common;
};

}  // namespace

NormalEquations reducedToPose(const NormalEquations& equations, const SweepModel& model)
{
  NormalEquations reduced = equations;
  if (model.freedom == SweepFreedom::follows_pose) {
    const double slope = model.sweep_per_motion;
    reduced.information += 2.0 * slope * equations.coupling + slope * slope * equations.twist_information;
    // Roughly: the normals' noise grows with the whole, not with the points before and after the reference apart.
    reduced.noise_information *= reduced.information.trace() / equations.information.trace();
    reduced.gradient += slope * equations.twist_gradient;
  }
  return reduced;
}

MotionPriorTerm motionPriorTerm(const MotionPrior& prior, const SweepTrajectory& now, double variance)
{
  // In the target's axes, as the perturbations are.
  const Eigen::Matrix3d& axes = now.pose().rotation;
  const Vector6 difference = now.twist() - prior.twist;
  MotionPriorTerm term;
  term.error << now.pose().translation - prior.pose.translation, logSO3(axes * prior.pose.rotation.transpose()),
      axes * difference.head<3>(), axes * difference.tail<3>();
  term.information.setZero();
  const Precision translation(prior.translation);
  const Precision rotation(prior.rotation);
  for (int i = 0; i < 6; ++i) {
    const Precision& precision = i < 3 ? translation : rotation;
    term.information(i, i) = variance * precision.pose;
    term.information(i, i + 6) = term.information(i + 6, i) = variance * precision.common;
    term.information(i + 6, i + 6) = variance * precision.twist;
  }
  return term;
}

double independentVariance(const InformationAnalysis& analysis)
{
  return kResidualsBesidePrior * analysis.meanWeight() * analysis.residualVariance();
}

FreeSweepSolver::FreeSweepSolver(const NormalEquations& equations, const InformationAnalysis& analysis,
                                 const MotionPrior& prior, const SweepTrajectory& now)
    : covariance_variance_(kResidualsInCovariance / kResidualsBesidePrior * independentVariance(analysis)),
      term_(motionPriorTerm(prior, now, independentVariance(analysis))),
      covariance_term_(motionPriorTerm(prior, now, covariance_variance_))
{
  const Matrix6 strong = analysis.strongProjection();
  const auto cleaned = [&](const Matrix6& m) { return Matrix6(strong.transpose() * m * strong); };
  measured_ << cleaned(equations.information), cleaned(equations.coupling), cleaned(equations.coupling),
      cleaned(equations.twist_information);
  gradient_ << strong.transpose() * equations.gradient, strong.transpose() * equations.twist_gradient;
}

SweepStep FreeSweepSolver::step() const
{
  using Matrix12d = Eigen::Matrix<double, 12, 12>;  // Eigen 3.4's solvers do not take unaligned types
  const Vector12 gradient = gradient_ + term_.information * term_.error;
  const Vector12 solution = Matrix12d(measured_ + term_.information).ldlt().solve(-gradient);
  return {solution.head<6>(), solution.tail<6>()};
}

Matrix6 FreeSweepSolver::poseCovariance() const
{
  using Matrix12d = Eigen::Matrix<double, 12, 12>;
  const Matrix12d information = measured_ + covariance_term_.information;
  return covariance_variance_ * information.ldlt().solve(Matrix12d::Identity()).topLeftCorner<6, 6>();
}

}  // namespace pcl_floam
