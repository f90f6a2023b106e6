#include "odometry/told_motion.h"

#include "odometry/first_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

constexpr double kTold = 0.012;  // m, by two scans together
constexpr double kOpen = 0.05;   // m, by one: half a metre in the ten scans of a second

}  // namespace

Eigen::Matrix3d toldPosition(const Matrix6& told, const Eigen::Matrix3d& rotation,
                             const std::optional<MotionHint>& hint)
{
  using Square6 = Eigen::Matrix<double, 6, 6>;
  Square6 covariance = told;
  if (hint) {
    Square6 turn = Square6::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = rotation;
    const Square6 both = covariance + turn * Square6(hint->covariance) * turn.transpose();
    covariance -= covariance * both.ldlt().solve(covariance);
  }
  return covariance.topLeftCorner<3, 3>();
}

void ToldMotion::take(const Eigen::Matrix3d& position, double periods)
{
  constexpr double kNextScan = 1.5;  // periods
  if (periods > kNextScan) {
    last_ = 0.0;
  }
  if (periods > kLongestKnown) {
    is_told_ = false;
  }
  constexpr double kLeast = 1e-6;  // m: all is locked
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position);
  directions_.setZero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] > kTold * kTold) {
      directions_ += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose();
    }
  }
  deviation_ = std::sqrt(std::max(solver.eigenvalues()[2], kLeast * kLeast));
  const double information = 1.0 / (deviation_ * deviation_);
  is_told_ = deviation_ <= kOpen && (is_told_ || information + last_ >= 1.0 / (kTold * kTold));
  last_ = information;
}

/// Any speed may be as likely as any other.
Eigen::Matrix3d ToldMotion::open(double periods) const
{
  const double farthest = kFastestMotion * periods;
  return is_told_ ? Eigen::Matrix3d(Eigen::Matrix3d::Zero()) : Eigen::Matrix3d(farthest * farthest / 3.0 * directions_);
}

}  // namespace pcl_floam
