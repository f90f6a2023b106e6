#include "motion/sweep_pose.h"

namespace pcl_floam {

SE3 SweepPose::at(double fraction) const
{
  const double since = fraction - 0.5;
  return middle * exp(since * twist + 0.5 * since * since * acceleration);
}

SweepPose operator*(const SE3& target_T_source, const SweepPose& pose)
{
  return {target_T_source * pose.middle, pose.twist, pose.acceleration};
}

}  // namespace pcl_floam
