// The sensor's poses during a sweep, and how perturbations move its points.
#include "common/sweep_trajectory.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

const SE3 kPose = exp((Vector6() << 4.0, -2.0, 1.0, 0.3, -0.2, 1.1).finished());
const Vector6 kTwist = (Vector6() << 2.5, -0.4, 0.2, 0.1, -0.2, 0.9).finished();
const Eigen::Vector3d kPoint(30.0, -50.0, 4.0);

TEST(SweepTrajectory, IsTheExponentialOfTheTwist)
{
  for (const double reference : {0.0, 0.5, 1.0}) {
    const SweepTrajectory trajectory(kPose, kTwist, reference);
    for (double time = 0.0; time <= 1.0; time += 0.0137) {
      const Eigen::Vector3d expected = kPose * exp((time - reference) * kTwist) * kPoint;
      EXPECT_LT((trajectory.at(kPoint, time) - expected).norm(), 2e-5) << reference << ' ' << time;
    }
  }
}

TEST(SweepTrajectory, AtRestThePoseIsAllThereIs)
{
  const SweepTrajectory trajectory(kPose, Vector6::Zero(), 0.3);
  EXPECT_EQ(trajectory.at(kPoint, 0.9), kPose * kPoint);
}

TEST(SweepTrajectory, APerturbationMovesPointsByTheirTime)
{
  const SweepTrajectory trajectory(kPose, kTwist, 0.5);
  const Vector6 delta = 1e-6 * (Vector6() << 1.0, 2.0, -1.0, 0.5, 0.3, -0.7).finished();
  const Vector6 epsilon = 1e-6 * (Vector6() << -2.0, 1.0, 0.4, -0.3, 0.9, 0.2).finished();
  const SweepTrajectory perturbed = trajectory.perturbed(delta, epsilon);
  for (const double time : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Vector6 share = delta + (time - 0.5) * epsilon;
    const Eigen::Vector3d expected = exp(share) * trajectory.at(kPoint, time);
    const double moved = (expected - trajectory.at(kPoint, time)).norm();
    // Exact at both ends; in between the perturbed twist turns the points on a slightly different arc.
    const double tolerance = time == 0.0 || time == 1.0 ? 1e-3 : 0.2;
    EXPECT_LT((perturbed.at(kPoint, time) - expected).norm(), tolerance * moved) << time;
  }
}

TEST(SweepTrajectory, StaysARotationOverManyPerturbations)
{
  std::mt19937 random(5);
  SweepTrajectory trajectory(kPose, kTwist, 0.5);
  for (int i = 0; i < 1000; ++i) {
    const Vector6 delta = randomTwist(random, 0.1, 0.1);
    trajectory = trajectory.perturbed(delta, -delta);
  }
  const Eigen::Matrix3d& r = trajectory.pose().rotation;
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace pcl_floam::test
