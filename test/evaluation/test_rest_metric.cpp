#include "support/constants.h"
#include "support/random_motion.h"

#include <pcl_floam/evaluation/trajectory_metrics.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace pcl_floam {
namespace {

using test::kPi;
using test::randomTwist;

/// Poses of a sensor that stood still, in a frame of their own.
std::vector<SE3> restlessPoses(const SE3& world_T_first)
{
  const std::vector<std::pair<double, Eigen::Vector3d>> deviations = {
      {0.0, {0.0, 0.0, 0.0}}, {1.0, {0.03, 0.0, 0.0}}, {-2.0, {0.0, 0.04, 0.0}}, {0.5, {0.0, 0.01, 0.0}}};
  std::vector<SE3> poses;
  for (const auto& [degrees, position] : deviations) {
    poses.push_back(world_T_first * SE3(expSO3(Eigen::Vector3d(0.0, 0.0, degrees * kPi / 180.0)), position));
  }
  return poses;
}

TEST(RestMetric, IsTheDistanceFromTheFirstPoseAndFromPoseToPoseInAnyFrame)
{
  std::mt19937 random(4);
  for (const SE3& world_T_first : {SE3(), exp(randomTwist(random, 50.0, 2.0))}) {
    const RestMetric metric = restMetric(restlessPoses(world_T_first));
    EXPECT_NEAR(metric.wander, 0.04, 1e-12);
    EXPECT_NEAR(metric.drift, 0.01, 1e-12);
    EXPECT_EQ(metric.jitter.translation.count, 3U);
    EXPECT_NEAR(metric.jitter.translation.max, 0.05, 1e-12);
    EXPECT_NEAR(metric.jitter.translation.rms, std::sqrt((9.0 + 25.0 + 9.0) / 3.0) / 100.0, 1e-12);
    EXPECT_NEAR(metric.rotation_wander, 2.0, 1e-9);
    EXPECT_NEAR(metric.rotation_drift, 0.5, 1e-9);
    EXPECT_NEAR(metric.jitter.rotation.max, 3.0, 1e-9);
    EXPECT_NEAR(metric.jitter.rotation.rms, std::sqrt((1.0 + 9.0 + 6.25) / 3.0), 1e-9);
  }
}

TEST(RestMetric, IsZeroAtRestAndWithoutMotionToJudge)
{
  for (const std::size_t poses : {0, 1, 20}) {
    const RestMetric metric = restMetric(std::vector<SE3>(poses, restlessPoses(SE3()).back()));
    EXPECT_NEAR(metric.wander + metric.drift + metric.jitter.translation.max, 0.0, 1e-12);
    EXPECT_NEAR(metric.rotation_wander + metric.rotation_drift + metric.jitter.rotation.max, 0.0, 1e-12);
    EXPECT_EQ(metric.jitter.translation.count, poses == 0 ? 0 : poses - 1);
  }
}

}  // namespace
}  // namespace pcl_floam
