#include "common/sweep_trajectory.h"

namespace pcl_floam {

void SweepTrajectory::tabulate()
{
  still_ = twist_.isZero(0.0);
  if (still_) {
    return;
  }
  const SE3 step = exp(twist_ / kSteps);
  poses_[0] = pose_ * exp(-reference_ * twist_);
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    poses_[k] = poses_[k - 1] * step;
  }
  // Ad(T) xi
  angular_velocity_ = pose_.rotation * twist_.tail<3>();
  velocity_ = pose_.rotation * twist_.head<3>() + pose_.translation.cross(angular_velocity_);
}

SweepTrajectory SweepTrajectory::perturbed(const Vector6& delta, const Vector6& epsilon) const
{
  const auto cleaned = [](SE3 pose) {
    pose.rotation = nearestRotation(pose.rotation);
    return pose;
  };
  if (epsilon.isZero(0.0)) {
    return {cleaned(exp(delta) * pose_), twist_, reference_};
  }
  const SE3 start = exp(delta - reference_ * epsilon) * pose_ * exp(-reference_ * twist_);
  const SE3 end = exp(delta + (1.0 - reference_) * epsilon) * pose_ * exp((1.0 - reference_) * twist_);
  const Vector6 twist = log(start.inverse() * end);
  return {cleaned(start * exp(reference_ * twist)), twist, reference_};
}

}  // namespace pcl_floam
