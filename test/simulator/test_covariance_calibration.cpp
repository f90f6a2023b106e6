// Whether the errors of single registrations are what their covariance says: normalised estimation error squared.

#include "odometry/constant_velocity.h"
#include "simulation.h"

#include <pcl_floam/filters/feature_extractor.h>
#include <pcl_floam/filters/sweep_motion.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/feature_registration.h>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <string>

namespace pcl_floam::simulator {

struct CalibrationScene {
  const char* world;
  const char* sensor;
};

/// Sweeps are registered as the odometry does it, with motion estimated under a prior, in a map of exact poses.
class CovarianceCalibration : public testing::TestWithParam<CalibrationScene> {
protected:
  static constexpr int kMapped = 20;  // sweeps before the first that is registered
  static constexpr int kSweeps = 50;

  void visit(std::uint64_t seed)
  {
    SimulationOptions options;
    options.world = GetParam().world;
    options.sensor = GetParam().sensor;
    options.seed = seed;
    options.start = 8.0;
    Simulation simulation(options);
    KeyframeVoxelMap map;
    VelocityNoise noise;
    SE3 last_pose;
    SweepMotion last_motion;
    for (int i = 0; i < kSweeps; ++i) {
      const Sweep sweep = simulation.sweep(static_cast<std::size_t>(i));
      const FeatureSet features = featuresOf(sweep);
      const SweepMotion motion = motionOf(sweep);
      if (i > 0) {
        // The odometry's prediction, from the exact motion before.
        Vector6 twist = last_motion.twist();
        twist.tail<3>() += 0.5 * last_motion.acceleration().tail<3>();
        RegistrationRun run;
        run.guess = last_pose * exp(twist);
        run.sweep.freedom = SweepFreedom::free;
        run.sweep.reference = 0.5;
        run.sweep.twist = twist;
        run.sweep.last_twist = last_motion.twist();
        run.sweep.sweeps_since_last = 1.0;
        run.sweep.prior = noise.prior(run.guess, twist, 1.0, 1.0);
        if (i >= kMapped && i % 3 == 0) {
          judge(registerFeatures(features, {&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)}, run,
                                 RegistrationParameters()),
                sweep.world_T_middle);
        }
        noise.observe(motion.twist() - twist, 1.0);
      }
      last_pose = sweep.world_T_middle;
      last_motion = motion;
      FeatureSet undistorted;
      compensate(features, motion, undistorted);
      map.insert(undistorted, sweep.world_T_middle);
    }
  }

  static FeatureSet featuresOf(const Sweep& sweep)
  {
    const CloudView view = viewOf(sweep.cloud);
    ScanLines lines;
    findScanLines(view, {}, {}, lines);
    FeatureSet features;
    extractFeatures(view, lines, findScanTiming(view, lines, {}, {}), FeatureParameters(), features);
    return features;
  }

  static SweepMotion motionOf(const Sweep& sweep)
  {
    const Vector6 before = log(sweep.world_T_start.inverse() * sweep.world_T_middle);
    const Vector6 after = log(sweep.world_T_middle.inverse() * sweep.world_T_end);
    return SweepMotion(before + after, 0.5, 4.0 * (after - before));
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
