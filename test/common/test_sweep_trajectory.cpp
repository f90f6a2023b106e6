// The sensor's poses during a sweep, and how a perturbation moves its points.
#include "common/sweep_trajectory.h"
#include "support/random_motion.h"
#include "support/seen_place.h"

#include <pcl_floam/filters/core/sweep_motion.h>

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
      EXPECT_LT((placeOf(trajectory, kPoint, time) - expected).norm(), 1e-5) << reference << ' ' << time;
    }
  }
}

TEST(SweepTrajectory, IsAsExactOfAFastSensorThatHardlyTurnsAndOfOneThatSpins)
{
  const Eigen::Vector3d near(2.0, 0.5, -0.3);
  for (const double turn : {0.0, 1e-4, 8e-4, 0.016, 3.0, 15.0}) {
    const Vector6 twist = (Vector6() << 4.0, 0.1, 0.0, 0.0, 0.1 * turn, turn).finished();
    for (const double reference : {0.5, 1.0}) {
      const SweepTrajectory trajectory(kPose, twist, reference);
      const Eigen::Vector3d expected = kPose * exp(-reference * twist) * near;
      EXPECT_LT((placeOf(trajectory, near, 0.0) - expected).norm(), 1e-6) << turn << ' ' << reference;
    }
  }
}

TEST(SweepTrajectory, AnAccelerationGrowsWithTheSquareOfTheTime)
{
  const Vector6 acceleration = (Vector6() << 0.4, 0.3, -0.2, -0.05, 0.1, 0.2).finished();
  for (const double reference : {0.0, 0.5, 1.0}) {
    const SweepTrajectory trajectory(kPose, 0.2 * kTwist, reference, acceleration);
    for (double time = 0.0; time <= 1.0; time += 0.0137) {
      const double since = time - reference;
      const SE3 moved = exp(0.2 * since * kTwist + 0.5 * since * since * acceleration);
      EXPECT_LT((placeOf(trajectory, kPoint, time) - kPose * moved * kPoint).norm(), 1e-5) << reference << ' ' << time;
      EXPECT_LT((SweepMotion(0.2 * kTwist, reference, acceleration).at(time) * kPoint - moved * kPoint).norm(), 1e-9);
    }
  }
}

TEST(SweepTrajectory, FromRestAnAccelerationMoves)
{
  const Vector6 acceleration = (Vector6() << 8.0, 0.0, 0.0, 0.0, 0.0, 0.0).finished();
  const SweepTrajectory trajectory(SE3(), Vector6::Zero(), 0.5, acceleration);
  EXPECT_NEAR(placeOf(trajectory, Eigen::Vector3d::Zero(), 1.0).x(), 1.0, 1e-9);
  EXPECT_FALSE(SweepMotion(Vector6::Zero(), 0.5, acceleration).isStill());
}

TEST(SweepTrajectory, AtRestThePoseIsAllThereIs)
{
  const SweepTrajectory trajectory(kPose, Vector6::Zero(), 0.3);
  EXPECT_EQ(placeOf(trajectory, kPoint, 0.9), kPose * kPoint);
}

TEST(SweepTrajectory, APerturbationMovesAllPointsAsARigidScan)
{
  const SweepTrajectory trajectory(kPose, kTwist, 0.5);
  const Vector6 delta = (Vector6() << 1.0, 2.0, -1.0, 0.5, 0.3, -0.7).finished();
  for (const double time : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Eigen::Vector3d expected = exp(delta) * placeOf(trajectory, kPoint, time);
    EXPECT_LT((placeOf(trajectory.perturbed(delta), kPoint, time) - expected).norm(), 1e-9) << time;
  }
}

TEST(SweepTrajectory, StaysARotationOverManyPerturbations)
{
  std::mt19937 random(5);
  SweepTrajectory trajectory(kPose, kTwist, 0.5);
  for (int i = 0; i < 1000; ++i) {
    const Vector6 delta = randomTwist(random, 0.1, 0.1);
    trajectory = trajectory.perturbed(delta);
  }
  const Eigen::Matrix3d& r = trajectory.pose().rotation;
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace pcl_floam::test
