/// \file seen_place.h
/// Where a moving sensor sees a single point.
#pragma once

#include "common/sweep_trajectory.h"

#include <Eigen/Core>

namespace pcl_floam::test {

/// In the target's frame, of a point that was measured at a fraction of the sweep in [0, 1].
inline Eigen::Vector3d placeOf(const SweepTrajectory& sensor, const Eigen::Vector3d& point, double time)
{
  const struct {
    double x, y, z, time;
  } seen{point.x(), point.y(), point.z(), time};
  Eigen::Vector3d place;
  sensor.undistorted(&seen, 1, 1, [&place](std::size_t, const Eigen::Vector3d& seen_at) { place = seen_at; });
  return sensor.pose() * place;
}

}  // namespace pcl_floam::test
