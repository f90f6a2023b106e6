#include <pcl_floam/filters/core/sweep_motion.h>

#include "common/sweep_trajectory.h"

#include <pcl_floam/filters/core/pose_instant.h>

#include <algorithm>
#include <array>
#include <cstddef>

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
  const std::size_t count = compensated.size();
  constexpr std::size_t kTogether = 256;
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::ptrdiff_t part = 0; part < static_cast<std::ptrdiff_t>((count + kTogether - 1) / kTogether); ++part) {
    const std::size_t begin = static_cast<std::size_t>(part) * kTogether;
    const std::size_t some = std::min(kTogether, count - begin);
    std::array<Eigen::Vector3d, kTogether> places;
    trajectory.undistorted(&compensated[begin], 1, some, places.data());
    for (std::size_t i = 0; i < some; ++i) {
      Feature& feature = compensated[begin + i];
      feature.x = static_cast<float>(places[i].x());
      feature.y = static_cast<float>(places[i].y());
      feature.z = static_cast<float>(places[i].z());
    }
  }
}

void compensate(const FeatureSet& features, const SweepMotion& motion, FeatureSet& compensated, int threads)
{
  compensate(features.edges, motion, compensated.edges, threads);
  compensate(features.planes, motion, compensated.planes, threads);
}

}  // namespace pcl_floam
