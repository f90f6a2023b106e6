#include "registration/sampling_pattern.h"

#include "common/covariance.h"
#include "map/surface_fit.h"
#include "registration/locked_motions.h"
#include "registration/sweep_prior.h"

#include <limits>

namespace pcl_floam {

namespace {

/// One standard deviation, m: what is known better is seldom held by a pattern alone, and need not be tried.
constexpr double kWellKnown = 0.004;
/// To either side, m: five standard deviations of a range. No farther than what a scene is made of is large, so that
/// patterns whose parts lie more than twice as far apart are taken for structure.
constexpr double kWay = 5.0 * kRangeNoise;
/// Of the growth that is promised. What holds a pose has mostly half of it and more, patterns mostly less than a third.
constexpr double kHolds = 0.4;

/// Displacements by a metre along the axes of what is known of the position that are to be tried. A turn that goes with
/// them would be held by walls, and hide that they are not.
Motions motionsToTry(const Matrix6& covariance)
{
  const EigenAnalysis axes = analyse(Eigen::Matrix3d(covariance.topLeftCorner<3, 3>()));
  Motions tried(6, 0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (axes.values[i] > kWellKnown * kWellKnown) {
      tried.conservativeResize(6, tried.cols() + 1);
      tried.rightCols<1>() << axes.vectors.col(i).head<3>(), Eigen::Vector3d::Zero();
    }
  }
  return tried;
}

/// Combinations of the motions and how much of the growth each has that is promised, rising.
EigenAnalysis sharesOf(const Motions& tried, const PullsWhenMoved& pulls)
{
  constexpr double kNothing = 1e-9;  // of the stiffness
  TriedMotions motions = TriedMotions::Zero();
  motions.leftCols(tried.cols()) = tried;
  Eigen::Matrix3d growth = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < tried.cols(); ++i) {
    const Pulls behind = pulls(motions, -kWay * motions.col(i));
    const Pulls ahead = pulls(motions, kWay * motions.col(i));
    growth.col(i) = (ahead.against - behind.against) / (2.0 * kWay);
    stiffness += (behind.stiffness + ahead.stiffness) / static_cast<double>(2 * tried.cols());
  }
  if (!growth.allFinite() || !stiffness.allFinite()) {  // a map of the user's may give anything: that holds nothing
    growth.setZero();
    stiffness.setIdentity();
  }
  stiffness.diagonal().array() += kNothing * stiffness.trace() + std::numeric_limits<double>::min();
  const Eigen::Index n = tried.cols();
  const Within symmetric = 0.5 * (growth + growth.transpose()).topLeftCorner(n, n);
  return analyse(symmetric, Within(stiffness.topLeftCorner(n, n)));
}

}  // namespace

Motions motionsToldByPattern(const Matrix6& information, const DegreesOfFreedom& locked, const PullsWhenMoved& pulls)
{
  Matrix6 known = information;
  known.diagonal().array() += kNothingKnown;
  const Motions tried = motionsToTry(covarianceWithLocked(inverseOf(informationWithLocked(known, locked)), locked));
  if (tried.cols() == 0) {
    return Motions(6, 0);
  }
  const EigenAnalysis shares = sharesOf(tried, pulls);
  const Eigen::Index count = (shares.values.array() < kHolds).count();  // they are rising
  Motions motions = tried * shares.vectors.leftCols(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    motions.col(i) /= motions.col(i).head<3>().norm();
  }
  return motions;
}

Motions knownAmong(const Motions& motions, const Matrix6& information)
{
  Motions known(6, 0);
  for (Eigen::Index i = 0; i < motions.cols(); ++i) {
    const Vector6 motion = motions.col(i);
    if (motion.dot(information * motion) * kWay * kWay > 1.0) {
      known.conservativeResize(6, known.cols() + 1);
      known.rightCols<1>() = motion;
    }
  }
  return known;
}

Matrix6 apartFrom(const Motions& motions, const Matrix6& onto, const Matrix6& information)
{
  constexpr double kRounding = 1e-9;  // of the information along a motion that is told no more
  Matrix6 apart = onto;
  for (Eigen::Index i = 0; i < motions.cols(); ++i) {
    const Vector6 motion = motions.col(i);
    const Vector6 along = propagated(apart.transpose(), information) * motion;
    const double stiffness = motion.dot(along);
    if (stiffness > kRounding * motion.dot(information * motion)) {
      apart -= apart * motion * along.transpose() / stiffness;
    }
  }
  return apart;
}

void addToWeak(const Motions& motions, const Matrix6& besides, const Vector6& units,
               std::vector<WeakDirection>& directions)
{
  constexpr double kUnknown = 1.0;  // m: one standard deviation of what is as good as not known
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    const Vector6 motion = motions.col(k);
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
