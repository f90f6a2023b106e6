#include "odometry/unseen_drift.h"

namespace pcl_floam {

namespace {

/// Translations and rotations apart, as they have different units.
Matrix6 projectionOnto(const std::vector<WeakDirection>& directions)
{
  Matrix6 projection = Matrix6::Zero();
  for (const WeakDirection& weak : directions) {
    for (const int part : {0, 3}) {
      const Eigen::Vector3d direction = weak.direction.segment<3>(part);
      projection.block<3, 3>(part, part) += direction * direction.transpose();
    }
  }
  return projection;
}

}  // namespace

void UnseenDrift::carryOn(const Matrix6& velocity, double periods)
{
  pose_ += periods * (pose_and_velocity_ + pose_and_velocity_.transpose()) + periods * periods * velocity;
  pose_and_velocity_ += periods * velocity;
}

void UnseenDrift::see(const std::vector<WeakDirection>& weak)
{
  constexpr int kSeenAgain = 10;
  scans_that_see_ = weak.empty() ? scans_that_see_ + 1 : 0;
  if (scans_that_see_ == 0 || scans_that_see_ >= kSeenAgain) {
    unseen_ = projectionOnto(weak);
  }
  pose_ = unseen_ * pose_ * unseen_;
  pose_and_velocity_ = unseen_ * pose_and_velocity_;
}

}  // namespace pcl_floam
