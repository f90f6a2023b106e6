#include "odometry/sweep_turn.h"

#include <cmath>

namespace pcl_floam {

Eigen::Vector3d SweepTurn::refine(const Eigen::Vector3d& during, const Eigen::Vector3d& between, double periods)
{
  constexpr double kRegular = 0.3;  // periods that scans may be early or late
  if (!(std::abs(periods - 1.0) < kRegular)) {
    last_.reset();
    return during;
  }
  Eigen::Vector3d refined = during;
  if (last_) {
    const Eigen::Matrix3d now_R_last = expSO3(between).transpose();
    refined = 0.7 * during - 0.6 * (now_R_last * last_->during) + 0.75 * between + 0.15 * (now_R_last * last_->between);
  }
  last_ = Turn{during, between};
  return refined;
}

}  // namespace pcl_floam
