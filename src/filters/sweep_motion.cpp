#include <pcl_floam/filters/core/sweep_motion.h>

#include "common/sweep_trajectory.h"

#include <pcl_floam/filters/core/pose_instant.h>

namespace pcl_floam {

const char* toString(PoseInstant instant)
{
  switch (instant) {
    case PoseInstant::start: return "start";
    case PoseInstant::middle: return "middle";
    case PoseInstant::end: return "end";
  }
  return "unknown";
}

double fractionOf(PoseInstant instant)
{
  return instant == PoseInstant::start ? 0.0 : (instant == PoseInstant::middle ? 0.5 : 1.0);
}

void compensate(const std::vector<Feature>& features, const SweepMotion& motion, std::vector<Feature>& compensated,
                int threads)
{
  compensated = features;
  if (motion.isStill()) {
    return;
  }
  const SweepTrajectory trajectory(SE3(), motion.twist(), motion.reference(), motion.acceleration());
  trajectory.undistorted(compensated, threads, [&](std::size_t i, const Eigen::Vector3d& place) {
    compensated[i].x = static_cast<float>(place.x());
    compensated[i].y = static_cast<float>(place.y());
    compensated[i].z = static_cast<float>(place.z());
  });
}

void compensate(const FeatureSet& features, const SweepMotion& motion, FeatureSet& compensated, int threads)
{
  compensate(features.edges, motion, compensated.edges, threads);
  compensate(features.planes, motion, compensated.planes, threads);
}

}  // namespace pcl_floam
