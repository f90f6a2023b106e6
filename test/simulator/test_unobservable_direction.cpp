// A smooth corridor, where nothing tells of the way along it.

#include "simulation.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <cstddef>

namespace pcl_floam::simulator {

/// In nearly all scans, once the map is more than the noise of a few.
TEST(UnobservableDirection, IsReported)
{
  constexpr std::size_t kTunnelScans = 80;
  constexpr std::size_t kJudgedFrom = 15;
  SimulationOptions options;
  options.world = "tunnel";
  options.seed = 25;
  Simulation simulation(options);
  Odometry<PointXYZIRT> odometry;
  std::size_t named = 0;
  for (std::size_t scan = 0; scan < kTunnelScans; ++scan) {
    const OdometryReport& report = odometry.track(simulation.sweep(scan).cloud, 0.1 * static_cast<double>(scan));
    const bool is_named = !report.registration.weak_directions.empty();
    named += is_named && scan >= kJudgedFrom ? 1 : 0;
    EXPECT_TRUE(!is_named || report.registration.covariance.trace() > 1e-4) << scan;
  }
  EXPECT_GT(named, (kTunnelScans - kJudgedFrom) * 9 / 10);
}

}  // namespace pcl_floam::simulator
