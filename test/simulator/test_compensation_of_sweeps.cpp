// MotionCompensation on simulated sweeps, whose undistorted form is known.

#include "simulator/test_world.h"

#include <pcl_floam/filters/motion_compensation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace pcl_floam::simulator {

namespace {

/// Distance of a cloud's points from where they would lie at the sweep's end, m, root mean square.
double distortion(const pcl::PointCloud<PointXYZIRT>& cloud, const Sweep& sweep)
{
  double squares = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    squares += static_cast<double>((cloud[i].getVector3fMap() - sweep.exact_at_end[i]).squaredNorm());
  }
  return std::sqrt(squares / static_cast<double>(cloud.size()));
}

}  // namespace

struct KnownMotion {
  const char* world;
  double start;      // s into the world's motion, where it is fast
  double distorted;  // m, at least
};

class CompensationOfSweeps : public testing::TestWithParam<KnownMotion> {};

INSTANTIATE_TEST_SUITE_P(Simulation, CompensationOfSweeps,
                         testing::Values(KnownMotion{"warehouse", 10.0, 0.06}, KnownMotion{"room", 10.0, 0.04},
                                         KnownMotion{"urban", 15.0, 0.3}, KnownMotion{"highway", 10.0, 0.8},
                                         KnownMotion{"handheld", 8.0, 0.08}),
                         [](const auto& parameter) { return std::string(parameter.param.world); });

TEST_P(CompensationOfSweeps, GivesBackTheUndistortedSweepToWithinTheRangeNoise)
{
  SimulationOptions options = testWorld(GetParam().world, "vlp16");
  options.start = GetParam().start;
  for (const double noise : {0.0, 0.02}) {
    options.range_noise = noise;
    Simulation simulation(options);
    for (const std::size_t number : {0U, 5U, 10U}) {
      const Sweep sweep = simulation.sweep(number);
      MotionCompensation<PointXYZIRT> compensation;
      compensation.setInputCloud(sweep.cloud.makeShared());
      compensation.setTwist(log(sweep.world_T_start.inverse() * sweep.world_T_end));
      pcl::PointCloud<PointXYZIRT> undistorted;
      compensation.filter(undistorted);
      ASSERT_EQ(undistorted.size(), sweep.cloud.size());
      // What remains without noise is that the motion's speed changes within the sweep.
      EXPECT_LT(distortion(undistorted, sweep), std::hypot(1.03 * noise, 0.018)) << "noise " << noise << " m";
      EXPECT_GT(distortion(sweep.cloud, sweep), GetParam().distorted);
    }
  }
}

}  // namespace pcl_floam::simulator
