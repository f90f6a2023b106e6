#include "common/sweep_trajectory.h"

namespace pcl_floam {

void SweepTrajectory::tabulate()
{
  still_ = twist_.isZero(0.0) && acceleration_.isZero(0.0);
  if (still_) {
    return;
  }
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const double since = static_cast<double>(k) / kSteps - reference_;
    poses_[k] = pose_ * exp(since * twist_ + 0.5 * since * since * acceleration_);
  }
  // Ad(T) xi, Ad(T) alpha
  angular_velocity_ = pose_.rotation * twist_.tail<3>();
  velocity_ = pose_.rotation * twist_.head<3>() + pose_.translation.cross(angular_velocity_);
  angular_acceleration_ = pose_.rotation * acceleration_.tail<3>();
  linear_acceleration_ = pose_.rotation * acceleration_.head<3>() + pose_.translation.cross(angular_acceleration_);
}

SweepTrajectory SweepTrajectory::perturbed(const Vector6& delta) const
{
  SE3 pose = exp(delta) * pose_;
  pose.rotation = nearestRotation(pose.rotation);
  return {pose, twist_, reference_, acceleration_};
}

}  // namespace pcl_floam
