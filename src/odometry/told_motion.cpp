#include "odometry/told_motion.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_floam {

double leastToldDeviation(const Matrix6& told, const Eigen::Matrix3d& rotation, const std::optional<MotionHint>& hint,
                          const DegreesOfFreedom& locked)
{
  constexpr double kNothing = 1e-6;  // 1/m^2 and 1/rad^2: a kilometre
  constexpr double kLocked = 1e12;
  using Square6 = Eigen::Matrix<double, 6, 6>;
  Square6 information = told;
  information.diagonal().array() += kNothing;
  if (hint) {
    Square6 turn = Square6::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = rotation;
    information += turn * Square6(hint->covariance).inverse() * turn.transpose();
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    information(i, i) += locked[static_cast<std::size_t>(i)] ? kLocked : 0.0;
  }
  const Eigen::Matrix3d position = information.inverse().topLeftCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

void ToldMotion::take(double deviation)
{
  constexpr double kTold = 0.012;  // m, by two scans together
  constexpr double kOpen = 0.05;   // m, by one: half a metre in the ten scans of a second
  constexpr double kLeast = 1e-6;  // m: all is locked
  const double information = 1.0 / std::max(deviation * deviation, kLeast * kLeast);
  is_told_ = deviation <= kOpen && (is_told_ || information + last_ >= 1.0 / (kTold * kTold));
  last_ = information;
}

}  // namespace pcl_floam
