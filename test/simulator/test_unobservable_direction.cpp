// A smooth corridor, where nothing tells of the way along it.

#include "simulation.h"

#include <pcl_floam/odometry/odometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pcl_floam::simulator {

struct TunnelDrive {
  std::uint64_t seed;
  int judged_from;  ///< scan; before it the map is the noise of a few, which may be taken for knowledge
};

/// Drives through a whole tunnel.
class UnobservableDirection : public testing::TestWithParam<TunnelDrive> {
protected:
  static SimulationOptions optionsOf(std::uint64_t seed)
  {
    SimulationOptions options;
    options.world = "tunnel";
    options.seed = seed;
    return options;
  }

  static OdometryParameters middleOfTheSweep()
  {
    OdometryParameters parameters;
    parameters.engine = OdometryEngine::features;
    parameters.pose_instant = PoseInstant::middle;
    return parameters;
  }

  void track(int scan)
  {
    const Sweep sweep = simulation_.sweep(static_cast<std::size_t>(scan));
    if (scan == 0) {
      world_T_first_ = sweep.world_T_middle;
    }
    report_ = odometry_.track(sweep.cloud, 0.1 * scan);
    const SE3 truth = world_T_first_.inverse() * sweep.world_T_middle;
    // In the axes of the tunnel, which runs along x.
    const Eigen::Matrix3d& tunnel_R_first = world_T_first_.rotation;
    error_ = tunnel_R_first * (report_.world_T_sensor.translation - truth.translation);
    const Eigen::Matrix3d covariance = report_.covariance.topLeftCorner<3, 3>();
    sigma_ = (tunnel_R_first * covariance * tunnel_R_first.transpose()).diagonal().cwiseSqrt();
  }

  [[nodiscard]] double pathLength()
  {
    const Sweep last = simulation_.sweep(simulation_.size() - 1);
    return (last.world_T_middle.translation - world_T_first_.translation).norm();
  }

  [[nodiscard]] bool namesTheWayAlong() const
  {
    const std::vector<WeakDirection>& weak = report_.registration.weak_directions;
    return std::any_of(weak.begin(), weak.end(),
                       [](const WeakDirection& w) { return std::abs(w.direction[0]) > 0.95; });
  }

  Simulation simulation_{optionsOf(GetParam().seed)};
  Odometry<PointXYZIRT> odometry_{middleOfTheSweep()};
  SE3 world_T_first_;
  OdometryReport report_;
  Eigen::Vector3d error_;
  Eigen::Vector3d sigma_;
};

/// The way along the corridor is known to be unknown; the rest is as good as ever.
TEST_P(UnobservableDirection, IsReportedAndItsErrorIsWithinItsBounds)
{
  const int scans = static_cast<int>(simulation_.size());
  int weak = 0;
  int beyond = 0;
  double farthest = 0.0;
  double aside = 0.0;
  double height = 0.0;
  for (int scan = 0; scan < scans; ++scan) {
    track(scan);
    weak += namesTheWayAlong() ? 1 : 0;
    const bool is_beyond = std::abs(error_.x()) > 3.0 * sigma_.x();
    beyond += is_beyond ? 1 : 0;
    farthest = std::max(farthest, std::abs(error_.x()));
    aside = std::max(aside, std::abs(error_.y()));
    height = std::max(height, std::abs(error_.z()));
    if (scan >= GetParam().judged_from) {
      EXPECT_FALSE(is_beyond) << scan << ": " << error_.x() << " m, sigma " << sigma_.x() << " m";
      EXPECT_LT(sigma_.tail<2>().maxCoeff(), 0.01 + 0.02 * sigma_.x()) << scan;  // the direction is known to a degree
    }
  }
  RecordProperty("scans_that_name_it", weak);
  RecordProperty("scans_beyond_three_sigma", beyond);
  RecordProperty("farthest_along_m", std::to_string(farthest));
  RecordProperty("farthest_aside_m", std::to_string(aside));
  RecordProperty("farthest_in_height_m", std::to_string(height));
  EXPECT_GT(weak, scans * 95 / 100);
  EXPECT_GT(farthest, 1.0);  // else nothing was shown
  EXPECT_LT(sigma_.x(), 2.0 * pathLength());
  EXPECT_LT(aside, 0.05);
  EXPECT_LT(height, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Tunnels, UnobservableDirection,
                         testing::Values(TunnelDrive{21, 15}, TunnelDrive{22, 15},
                                         TunnelDrive{23, 30}),  // its noise is taken for knowledge until scan 29
                         [](const auto& drive) { return std::to_string(drive.param.seed); });

/// Surfaces name it in nearly all scans, once their map is more than the noise of a few.
TEST(UnobservableDirectionOfSurfaces, IsReported)
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
