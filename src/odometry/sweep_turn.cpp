#include "odometry/sweep_turn.h"

#include <cmath>

namespace pcl_floam {

SweepMotion SweepTurn::refine(const SweepMotion& registered, double sweep_fraction, const Vector6& between,
                              double periods)
{
  constexpr double kRegular = 0.3;  // periods that scans may be early or late
  const Turn now{registered.twist().tail<3>() / sweep_fraction, between.tail<3>()};
  if (!(std::abs(periods - 1.0) < kRegular)) {
    last_.reset();
    return registered;
  }
  Vector6 twist = registered.twist();
  Vector6 acceleration = registered.acceleration();
  if (last_) {
    const Eigen::Matrix3d now_R_last = expSO3(now.between).transpose();
    const Eigen::Vector3d during = now_R_last * last_->during;
    const Eigen::Vector3d before = now_R_last * last_->between;
    twist.tail<3>() = sweep_fraction * (0.7 * now.during - 0.6 * during + 0.75 * now.between + 0.15 * before);
    acceleration.tail<3>() =
        sweep_fraction * sweep_fraction * (1.6 * now.during - 1.2 * during - 0.8 * now.between + 0.4 * before);
  }
  last_ = now;
  return SweepMotion(twist, registered.reference(), acceleration);
}

}  // namespace pcl_floam
