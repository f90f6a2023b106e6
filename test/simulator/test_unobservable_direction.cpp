// A smooth corridor, where nothing tells of the way along it.

#include "simulation.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

/// The way along the corridor is known to be unknown; the rest is as good as ever.
TEST(UnobservableDirection, IsReportedAndItsErrorIsWithinItsBounds)
{
  constexpr int kFirst = 15;  // scans until the map is more than the noise of one
  constexpr int kScans = 150;
  SimulationOptions options;
  options.world = "tunnel";
  options.seed = 21;
  Simulation simulation(options);
  OdometryParameters parameters;
  parameters.pose_instant = PoseInstant::middle;
  Odometry<PointXYZIRT> odometry(parameters);
  SE3 world_T_first;
  int found_weak = 0;
  double farthest = 0.0;
  for (int i = 0; i < kScans; ++i) {
    const Sweep sweep = simulation.sweep(static_cast<std::size_t>(i));
    if (i == 0) {
      world_T_first = sweep.world_T_middle;
    }
    const SE3 truth = world_T_first.inverse() * sweep.world_T_middle;
    const OdometryReport& report = odometry.track(sweep.cloud, 0.1 * i);
    const Eigen::Vector3d error = report.world_T_sensor.translation - truth.translation;
    if (i < kFirst) {
      continue;
    }
    for (const WeakDirection& weak : report.registration.weak_directions) {
      found_weak += std::abs(weak.direction[0]) > 0.95 ? 1 : 0;
    }
    const Eigen::Vector3d sigma = report.covariance.diagonal().head<3>().cwiseSqrt();
    EXPECT_LT(std::abs(error.x()), 3.0 * sigma.x()) << i;
    EXPECT_LT(sigma.tail<2>().maxCoeff(), 0.01 + 0.02 * sigma.x()) << i;  // the direction itself is known to a degree
    farthest = std::max(farthest, std::abs(error.x()));
  }
  EXPECT_GT(found_weak, (kScans - kFirst) * 9 / 10);
  EXPECT_GT(farthest, 1.0);  // else nothing was shown
}

}  // namespace pcl_floam::simulator
