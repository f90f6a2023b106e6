/// \file random_motion.h
/// Random rigid motions and paths, the same in every run.
#pragma once

#include <pcl_floam/common/se3.h>

#include <random>
#include <vector>

namespace pcl_floam::test {

/// Uniform in [-limit, limit].
inline double uniform(std::mt19937& random, double limit)
{
  // Not std::uniform_real_distribution: its numbers differ from one standard library to the next.
  return limit * (2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.0);
}

inline Eigen::Vector3d randomVector(std::mt19937& random, double limit)
{
  return {uniform(random, limit), uniform(random, limit), uniform(random, limit)};
}

inline Vector6 randomTwist(std::mt19937& random, double translation, double rotation)
{
  Vector6 twist;
  for (int i = 0; i < 6; ++i) {
    twist[i] = uniform(random, i < 3 ? translation : rotation);
  }
  return twist;
}

/// A path of \p poses poses that goes about 1 m forward with every step and winds a little.
inline std::vector<SE3> randomPath(std::mt19937& random, std::size_t poses)
{
  std::vector<SE3> path(poses);
  for (std::size_t i = 1; i < poses; ++i) {
    Vector6 step = randomTwist(random, 0.1, 0.03);
    step[0] += 1.0;
    path[i] = path[i - 1] * exp(step);
  }
  return path;
}

}  // namespace pcl_floam::test
