// Whether the errors of single registrations are what their covariance says: normalised estimation error squared.

#include "filters/spatial_sampling.h"
#include "filters/straight_runs.h"
#include "odometry/scan_preparation.h"
#include "odometry/track.h"
#include "simulator/test_world.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <string>
#include <utility>
#include <vector>

namespace pcl_floam::simulator {

struct CalibrationScene {
  const char* world;
  const char* sensor;
};

/// Sweeps are registered as the odometry does it, in a map of those before, at their exact poses.
class CovarianceCalibration : public testing::TestWithParam<CalibrationScene> {
protected:
  static constexpr int kMapped = 20;
  static constexpr int kRegistrations = 10;
  static constexpr int kBetween = 3;

  void visit(std::uint64_t seed)
  {
    SimulationOptions options = testWorld(GetParam().world, GetParam().sensor);
    options.seed = seed;
    options.start = 8.0;
    Simulation simulation(options);
    std::vector<pcl_floam::Sweep> sweeps;
    std::vector<SweepPose> poses;
    for (std::size_t i = 0; i < kMapped + kBetween * kRegistrations; ++i) {
      const Sweep simulated = simulation.sweep(i);
      pcl_floam::Sweep sweep = sampled(simulated);
      if (i >= kMapped && (i - kMapped) % kBetween == 0) {
        Track track(settings_);
        track.begin(sweeps, poses, keyframesAmong(poses, settings_));
        judge(track.step(sweep).report, simulated.world_T_middle);
      }
      sweeps.push_back(std::move(sweep));
      poses.push_back({simulated.world_T_middle, log(simulated.world_T_start.inverse() * simulated.world_T_end)});
      if (sweeps.size() > kMapped) {
        sweeps.erase(sweeps.begin());
        poses.erase(poses.begin());
      }
    }
  }

  pcl_floam::Sweep sampled(const Sweep& simulated)
  {
    constexpr double kCellsPerRoot = 12.0;
    constexpr double kMapSpacing = 0.3;
    const CloudView view = viewOf(simulated.cloud);
    PreparedScan scan;
    scan.findStructure(view, {}, 0.1);
    scan.takeFeatures(view, {});
    settings_.side = settings_.side > 0.0 ? settings_.side : sampling_.sideFor(scan.returnsOf(view, {}), kCellsPerRoot);
    pcl_floam::Sweep sweep;
    sampling_.sample(scan.returnsOf(view, {}), kMapSpacing * settings_.side, sweep.dense);
    sampling_.sample(sweep.dense, settings_.side, sweep.sample);
    findStraightRuns(scan.returnsOf(view, {}), sweep.sample);
    scan.takeEdges(sweep.edges);
    sweep.fraction = scan.sweep_fraction;
    return sweep;
  }

  void judge(const RegistrationReport& report, const SE3& truth)
  {
    ASSERT_TRUE(report.hasConverged());
    Eigen::Matrix<double, 6, 1> error;
    error << report.target_T_source.translation - truth.translation,
        logSO3(report.target_T_source.rotation * truth.rotation.transpose());
    squares_ += error.dot(Eigen::Matrix<double, 6, 6>(report.covariance).ldlt().solve(error));
    ++registrations_;
  }

  SpatialSampling sampling_;
  TrackSettings settings_;
  double squares_ = 0.0;
  int registrations_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Simulation, CovarianceCalibration,
                         testing::Values(CalibrationScene{"room", "vlp16"}, CalibrationScene{"warehouse", "vlp16"},
                                         CalibrationScene{"handheld", "vlp16"}, CalibrationScene{"urban", "hdl32"},
                                         CalibrationScene{"highway", "hdl32"}, CalibrationScene{"corridor", "vlp16"}),
                         [](const auto& parameter) { return std::string(parameter.param.world); });

TEST_P(CovarianceCalibration, ErrorsAreWithinTheirChiSquareBound)
{
  for (const std::uint64_t seed : {31U, 32U}) {
    settings_ = {};
    visit(seed);
  }
  ASSERT_EQ(registrations_, 20);
  const double mean = squares_ / registrations_;
  RecordProperty("nees", std::to_string(mean));
  // Chi square with 6 x 20 degrees of freedom, 99.9 %, over 20.
  EXPECT_LT(mean, 8.68);
  // On the other side the bound is 3.88. Where planes of all directions abound, errors are down to half of what is
  // said.
  EXPECT_GT(mean, 1.0);
}

}  // namespace pcl_floam::simulator
