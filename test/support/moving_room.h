// Sweeps that a moving lidar takes of a furnished room, and how far off an odometry's poses are.
#pragma once

#include "support/synthetic_cloud.h"

#include <pcl_floam/odometry/odometry.h>

#include <cstdlib>
#include <functional>

namespace pcl_floam::test {

using Cloud = pcl::PointCloud<PointXYZIRT>;

/// These tests are run for each engine, the second time with this variable in their environment.
inline bool isByFeatures()
{
  return std::getenv("PCL_FLOAM_TEST_FEATURES") != nullptr;
}

inline OdometryParameters defaults()
{
  OdometryParameters parameters;
  parameters.engine = isByFeatures() ? OdometryEngine::features : OdometryEngine::surfaces;
  return parameters;
}

/// `world_T_sensor` at a time in periods.
using Path = std::function<SE3(double)>;

inline SE3 steadyPath(double t)
{
  return exp(Vector6(t * (Vector6() << 0.6, 0.02, 0.0, 0.0, 0.0, 0.04).finished()));
}

/// From 0.2 m to 0.9 m a period, in a bend that tightens.
inline SE3 acceleratedPath(double t)
{
  const double way = 0.2 * t + 0.02 * t * t;
  const double heading = 0.01 * t + 0.001 * t * t;
  return {expSO3(Eigen::Vector3d(0.0, 0.0, heading)), Eigen::Vector3d(way - 3.0, 0.15 * way, 0.0)};
}

/// Sweep k lasts from time k to time k + 1.
inline Cloud sweep(const Path& path, int k)
{
  return toCloud(sweepRoom(Room(), Lidar(), [&](double fraction) { return path(k + fraction); }));
}

/// How far an odometry's pose after sweep k is from the true one, both seen from the first.
inline double error(const SE3& estimate, const Path& path, int k, double instant = 1.0)
{
  const SE3 truth = path(instant).inverse() * path(k + instant);
  return (estimate.translation - truth.translation).norm();
}

inline double angleError(const SE3& estimate, const Path& path, int k, double instant = 1.0)
{
  const SE3 truth = path(instant).inverse() * path(k + instant);
  return rotationAngle(estimate.rotation.transpose() * truth.rotation);
}

inline bool sameBits(const SE3& a, const SE3& b)
{
  return a.rotation == b.rotation && a.translation == b.translation;
}

constexpr int kScans = 18;

}  // namespace pcl_floam::test
