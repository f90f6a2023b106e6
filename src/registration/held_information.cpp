#include "registration/held_information.h"

#include "common/covariance.h"
#include "common/eigen_analysis.h"
#include "registration/locked_motions.h"
#include "registration/sweep_prior.h"

namespace pcl_floam {

namespace {

/// One standard deviation, m: what is told of so well is told of by more places than any pattern reaches.
constexpr double kWellKnown = 0.004;
/// Nor is there anything to try where next to nothing is told.
constexpr double kUnknown = 1.0;
/// What holds a pose pulls by half of what it promises and more, also amid traffic; patterns by less than a fifth.
constexpr double kHolds = 1.0 / 3.0;

}  // namespace

HeldInformation heldInformation(const Matrix6& information, const DegreesOfFreedom& locked, double way,
                                const std::function<Pull(const Vector6& motion, double way)>& pull_along)
{
  Matrix6 known = information;
  known.diagonal().array() += kNothingKnown;
  const Matrix6 covariance = covarianceWithLocked(inverseOf(informationWithLocked(known, locked)), locked);
  const EigenAnalysis axes = analyse(Eigen::Matrix3d(covariance.topLeftCorner<3, 3>()));
  HeldInformation held = {information, {}};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double variance = axes.values[i];
    if (!(variance > kWellKnown * kWellKnown && variance < kUnknown * kUnknown)) {
      continue;
    }
    // Of all motions by a metre along this axis, that which the residuals tell least of.
    const Vector6 motion = covariance.leftCols<3>() * axes.vectors.col(i).head<3>() / variance;
    if (!(shareOfGrowth(pull_along(motion, -way), pull_along(motion, way), way) >= kHolds)) {  // nor if nothing pulls
      const Vector6 told = held.information * motion;
      const double along = motion.dot(told);
      if (along > 0.0) {
        held.information -= told * told.transpose() / along;
      }
      held.not_held.push_back(motion);
    }
  }
  return held;
}

void nameWhatIsNotHeld(const HeldInformation& held, const Matrix6& besides, const Vector6& units,
                       std::vector<WeakDirection>& directions)
{
  for (const Vector6& motion : held.not_held) {
    if (motion.dot(besides * motion) * kUnknown * kUnknown < 1.0) {
      Motions named(6, static_cast<Eigen::Index>(directions.size()));
      for (Eigen::Index i = 0; i < named.cols(); ++i) {
        named.col(i) = directions[static_cast<std::size_t>(i)].direction;
      }
      const Motions one = orthonormalBeside(named, Motions(motion.cwiseQuotient(units)));
      for (Eigen::Index i = 0; i < one.cols(); ++i) {
        directions.push_back({one.col(i), 0.0});
      }
    }
  }
}

}  // namespace pcl_floam
