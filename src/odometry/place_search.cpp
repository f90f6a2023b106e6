#include "odometry/place_search.h"

#include "common/pi.h"
#include "motion/motion_estimate.h"
#include "registration/locked_motions.h"
#include "registration/placed_points.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// What was known of the velocity tells nothing there.
SurfaceRegistration registerFrom(SurfaceProblem problem, const SE3& guess, const Doubt& doubt, Evidence evidence)
{
  problem.prior.pose = guess;
  problem.prior.velocity.setZero();
  problem.prior.covariance = MotionEstimate(guess).covariance();
  problem.prior.periods_between = 0.0;
  problem.prior.pose_counts = false;
  problem.guess_covariance = guessCovarianceOf(doubt);
  problem.evidence = evidence;
  problem.is_rival = true;
  problem.looks_for_patterns = false;
  return registerSurfaces(problem);
}

/// A perturbation by one standard deviation, that by which a guess may move the points farthest.
struct WidestDoubt {
  Vector6 perturbation;
  double displacement = 0.0;  // m, of the points

  WidestDoubt(const Matrix6& covariance, double range)
  {
    Vector6 units;
    units << 1.0, 1.0, 1.0, range, range, range;
    const Eigen::Matrix<double, 6, 6> displacements = units.asDiagonal() * covariance * units.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> axes(displacements);
    displacement = std::sqrt(std::max(0.0, axes.eigenvalues()[5]));
    perturbation = displacement * axes.eigenvectors().col(5).cwiseQuotient(units);
  }
};

}  // namespace

double likelihoodOf(const SurfaceRegistration& found, const SE3& expected, const Matrix6& covariance)
{
  const SE3& pose = found.report.target_T_source;
  Vector6 off;
  off << pose.translation - expected.translation, logSO3(pose.rotation * expected.rotation.transpose());
  return found.evidence - 0.5 * squaredDeviations(off, covariance + found.report.covariance);
}

SurfaceRegistration registerAround(SurfaceProblem expected, double side)
{
  constexpr double kBasin = 0.5;  // sides: farther off, a point lies in another cell than its own
  const double range = rmsRange(*expected.scan.points);
  const Matrix6 free = covarianceWithLocked(expected.guess_covariance, expected.locked);
  if (!(WidestDoubt(free, range).displacement > kBasin * side)) {
    return registerSurfaces(expected);
  }
  const auto likelihood = [&expected](const SurfaceRegistration& found) {
    return found.report.hasConverged() ? likelihoodOf(found, expected.prior.pose, expected.guess_covariance)
                                       : -HUGE_VAL;
  };
  expected.evidence = Evidence::total;
  SurfaceRegistration best = registerSurfaces(expected);
  // The scan takes away covariance but along what it does not tell, where no place is better than another.
  const WidestDoubt doubt(propagated(free, inverseOf(Matrix6(free + best.told))), range);
  if (!(doubt.displacement > kBasin * side)) {
    return best;
  }
  for (const double sign : {1.0, -1.0}) {
    SurfaceProblem aside = expected;
    aside.begins_off = sign * doubt.perturbation;
    aside.looks_for_patterns = false;
    SurfaceRegistration found = registerSurfaces(aside);
    if (likelihood(found) > likelihood(best) + kOfOneMotion) {
      aside.looks_for_patterns = expected.looks_for_patterns;  // where the pose is taken
      best = aside.looks_for_patterns ? registerSurfaces(aside) : std::move(found);
    }
  }
  return best;
}

Matrix6 covarianceOf(const Doubt& doubt)
{
  Vector6 variance;
  variance << Eigen::Vector3d::Constant(doubt.far * doubt.far), Eigen::Vector3d::Constant(doubt.turned * doubt.turned);
  return variance.asDiagonal();
}

Matrix6 guessCovarianceOf(const Doubt& doubt)
{
  return covarianceOf({doubt.far / std::sqrt(3.0), doubt.turned / std::sqrt(3.0)});
}

Place settledPlace(const SurfaceProblem& expected, const SE3& guess, Doubt doubt)
{
  constexpr int kRounds = 4;
  SE3 pose = guess;
  for (int round = 0; round < kRounds; ++round, doubt.far *= 0.5, doubt.turned *= 0.5) {
    pose = registerFrom(expected, pose, doubt, Evidence::none).report.target_T_source;  // that failed: where it began
  }
  return {pose, doubt};
}

std::optional<SE3> betterPlace(const SurfaceProblem& expected, double side, const std::vector<SE3>& guesses,
                               const Doubt& doubt)
{
  SurfaceProblem weighed = expected;
  weighed.evidence = Evidence::total;
  weighed.looks_for_patterns = false;
  SurfaceRegistration best = registerAround(weighed, side);
  std::optional<SE3> place;
  for (const SE3& guess : guesses) {
    SurfaceRegistration found = registerFrom(expected, guess, doubt, Evidence::total);
    if (found.report.hasConverged() && (!best.report.hasConverged() || found.evidence > best.evidence)) {
      best = std::move(found);
      place = best.report.target_T_source;
    }
  }
  return place;
}

std::vector<SE3> anyTurnOf(const std::vector<SE3>& poses)
{
  constexpr int kTurns = 18;
  std::vector<SE3> turned;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Eigen::AngleAxisd about_axis(2.0 * kPi * turn / kTurns, Eigen::Vector3d::UnitZ());
    for (const SE3& pose : poses) {
      turned.emplace_back(pose.rotation * about_axis.toRotationMatrix(), pose.translation);
    }
  }
  return turned;
}

}  // namespace pcl_floam
