#include "odometry/told_motion.h"

#include "common/covariance.h"
#include "common/perturbation.h"
#include "odometry/first_motion.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// What two scans together have to tell of the position, one standard deviation in m: as much as a single return would.
/// Less may be what errors that all of a laser's returns share make of a motion that is wrong; and after a scan that
/// leaves a direction open, the next one may seem to tell of it by chance.
constexpr double kTold = 0.02;
/// One alone, for what was told before to last: half a metre in the ten scans of a second.
constexpr double kOpen = 0.05;

}  // namespace

Eigen::Matrix3d toldPosition(const Matrix6& told, const Eigen::Matrix3d& rotation,
                             const std::optional<MotionHint>& hint)
{
  if (!hint) {
    return told.topLeftCorner<3, 3>();
  }
  constexpr double kLeast = 1e-12;  // m^2 and rad^2: what is locked is known, whatever a hint says
  const Matrix6 hinted = propagated(turnOf(rotation), hint->covariance);
  const Matrix6 by_scan = inverseOf(Matrix6(told + kLeast * Matrix6::Identity()));
  const Matrix6 together = inverseOf(Matrix6(by_scan + inverseOf(hinted)));
  return together.topLeftCorner<3, 3>();
}

void ToldMotion::take(const Eigen::Matrix3d& position, double periods)
{
  constexpr double kNextScan = 1.5;  // periods
  constexpr double kLeast = 1e-6;    // m: all is locked
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position);
  deviation_ = std::sqrt(std::max(solver.eigenvalues()[2], kLeast * kLeast));
  const double information = 1.0 / (deviation_ * deviation_);
  const double together = information + (periods < kNextScan ? last_ : 0.0);
  const bool is_known = is_told_ && periods <= kLongestKnown;
  const bool is_open = !(deviation_ <= kOpen);
  is_told_ = !is_open && (is_known || (!was_open_ && together >= 1.0 / (kTold * kTold)));
  was_open_ = is_open;
  last_ = information;
  open_.setZero();
  for (Eigen::Index i = 0; i < 3 && !is_told_; ++i) {
    if (solver.eigenvalues()[i] > kTold * kTold) {
      const Eigen::Vector3d farthest = kFastestMotion * periods * solver.eigenvectors().col(i);
      open_ += farthest * farthest.transpose() / 3.0;
    }
  }
}

}  // namespace pcl_floam
