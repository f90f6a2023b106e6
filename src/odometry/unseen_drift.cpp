#include "odometry/unseen_drift.h"

namespace pcl_floam {

void UnseenDrift::carryOn(const Matrix6& velocity, double periods)
{
  pose_ += periods * (pose_and_velocity_ + pose_and_velocity_.transpose()) + periods * periods * velocity;
  pose_and_velocity_ += periods * velocity;
}

void UnseenDrift::see(const std::vector<WeakDirection>& weak)
{
  // Translations and rotations apart, as they have different units.
  Matrix6 unseen = Matrix6::Zero();
  for (const WeakDirection& w : weak) {
    for (const int part : {0, 3}) {
      const Eigen::Vector3d direction = w.direction.segment<3>(part);
      unseen.block<3, 3>(part, part) += direction * direction.transpose();
    }
  }
  pose_ = unseen * pose_ * unseen;
  pose_and_velocity_ = unseen * pose_and_velocity_;
}

}  // namespace pcl_floam
