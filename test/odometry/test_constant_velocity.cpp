// What is predicted from a constant velocity.
#include "odometry/constant_velocity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {
namespace {

TEST(ConstantVelocity, FollowsTheTwistForAsLongAsItIsWorthAnything)
{
  ConstantVelocity velocity;
  EXPECT_FALSE(velocity.isKnown());
  const Vector6 twist = (Vector6() << 1.0, 0.0, 0.0, 0.0, 0.0, 0.1).finished();
  velocity.set(twist);
  EXPECT_TRUE(velocity.isKnown());
  EXPECT_LT((log(velocity.motion(2.0)) - 2.0 * twist).norm(), 1e-12);
  EXPECT_LT((log(velocity.motion(50.0)) - 10.0 * twist).norm(), 1e-12);
}

TEST(ConstantVelocity, FollowsAPoseAsFarAsItIsKnown)
{
  const Vector6 noise = VelocityNoise().variance();
  Matrix6 covariance = 1e-8 * Matrix6::Identity();
  covariance(0, 0) = 1.0;  // nobody knows how far along x
  ConstantVelocity velocity;
  velocity.set(Vector6::Zero());
  const Vector6 measured = (Vector6() << 0.5, 0.5, 0.0, 0.0, 0.0, 0.1).finished();
  const Vector6 change = velocity.observe(measured, covariance, noise, 1.0);
  EXPECT_TRUE(change.isApprox(velocity.twist()));
  EXPECT_LT(velocity.twist()[0], 0.1 * measured[0]);
  EXPECT_GT(velocity.twist()[0], 0.0);
  EXPECT_NEAR(velocity.twist()[1], measured[1], 1e-4);
  EXPECT_NEAR(velocity.twist()[5], measured[5], 1e-4);
  EXPECT_GT(velocity.covariance()(0, 0), 100.0 * velocity.covariance()(1, 1));
  EXPECT_TRUE(velocity.covariance().isApprox(velocity.covariance().transpose()));
}

TEST(ConstantVelocity, TakesTheMeanOfNoisyPoses)
{
  // Poses that are off by 0.1 m along x, and a velocity that hardly changes.
  const Vector6 noise = Vector6::Constant(1e-5);
  ConstantVelocity velocity;
  velocity.set(Vector6::Zero());
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double error = i % 2 == 0 ? 0.1 : -0.1;
    velocity.observe((1.0 + error) * Vector6::UnitX(), 0.01 * Matrix6::Identity(), noise, 1.0);
    worst = i < 500 ? 0.0 : std::max(worst, std::abs(velocity.twist()[0] - 1.0));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(ConstantVelocity, ALongerWayTellsMoreOfTheVelocity)
{
  const auto gainOver = [](double periods) {
    ConstantVelocity velocity;
    velocity.set(Vector6::Zero());
    return velocity.observe(Vector6::UnitX(), 0.01 * Matrix6::Identity(), VelocityNoise().variance(), periods)[0];
  };
  EXPECT_GT(gainOver(5.0), gainOver(1.0));
  EXPECT_LT(gainOver(5.0), 1.0);
}

TEST(VelocityNoise, HoldsThePoseLessAfterAChangeOfVelocity)
{
  const auto spreadOf = [](const VelocityNoise& noise) {
    return noise.prior(SE3(), Vector6::Zero(), 1.0, 1.0).translation.pose;
  };
  VelocityNoise noise;
  const double at_first = spreadOf(noise);
  for (int i = 0; i < 30; ++i) {
    noise.observe(Vector6::Zero(), 1.0);
  }
  const double steady = spreadOf(noise);
  noise.observe(0.3 * Vector6::UnitX(), 1.0);
  const double changed = spreadOf(noise);
  EXPECT_LT(steady, 0.3 * at_first);
  EXPECT_GT(changed, 3.0 * steady);
  EXPECT_LE(changed, at_first);
}

TEST(PredictionError, BoundsTheNextOneAndFades)
{
  PredictionError error;
  for (int i = 0; i < 50; ++i) {
    error.observe(SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.1, 0.0, 0.0)), 10.0);
  }
  EXPECT_NEAR(error.bound(1.0), 0.3, 1e-3);
  EXPECT_NEAR(error.bound(2.0), 0.6, 1e-3);
  EXPECT_EQ(error.bound(1e6), 4.0);
  for (int i = 0; i < 50; ++i) {
    error.observe(SE3(), 10.0);
  }
  EXPECT_LT(error.bound(1.0), 0.01);
}

}  // namespace
}  // namespace pcl_floam
