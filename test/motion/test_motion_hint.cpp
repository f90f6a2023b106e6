// What others tell of the motion.
#include "motion/motion_estimate.h"

#include "motion/constant_motion.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace pcl_floam {

namespace {

MotionHint hintOf(const SE3& last_T_now, double sigma)
{
  return {last_T_now, sigma * sigma * Matrix6(Matrix6::Identity())};
}

}  // namespace

TEST(MotionHint, IsFollowedAsFarAsItIsSure)
{
  std::mt19937 random(5);
  for (int i = 0; i < 10; ++i) {
    MotionEstimate motion = afterSteps(test::randomTwist(random, 1.0, 0.1), 5);
    const SE3 before = motion.pose();
    const SE3 told = exp(test::randomTwist(random, 1.0, 0.1));
    MotionEstimate alone = motion;
    MotionEstimate unsure = motion;
    motion.predict(1.0, hintOf(told, 1e-5));
    unsure.predict(1.0, hintOf(told, 1e4));
    alone.predict(1.0);
    EXPECT_LT(poseDistance(motion.pose(), before * told), 1e-3);
    EXPECT_LT(poseDistance(unsure.pose(), alone.pose()), 1e-6);
    EXPECT_LT(motion.poseCovariance().trace(), 1e-2 * alone.poseCovariance().trace());
    EXPECT_NEAR(unsure.poseCovariance().trace() / alone.poseCovariance().trace(), 1.0, 1e-6);
  }
}

TEST(MotionHint, LeavesACovarianceHoweverSureItIs)
{
  std::mt19937 random(9);
  for (const double sigma : {1e-7, 1e-2}) {
    MotionEstimate motion = afterSteps(Vector6::Zero(), 5);
    for (int i = 0; i < 100; ++i) {
      motion.predict(1.0, hintOf(exp(test::randomTwist(random, 1.0, 0.1)), sigma));
      const Eigen::Matrix<double, 12, 12> covariance = motion.covariance();
      EXPECT_LT((covariance - covariance.transpose()).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_GT(covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-15) << sigma << ' ' << i;
    }
  }
}

/// Of the motion it is sure, though nobody knows where the sensor was.
TEST(MotionHint, SaysNothingOfWhereTheSensorWas)
{
  MotionEstimate motion = afterSteps(Vector6(0.5 * Vector6::Unit(0)), 5);
  Matrix6 lost = 1e-6 * Matrix6::Identity();
  lost(0, 0) = 25.0;
  motion.place(motion.pose(), lost);
  const SE3 before = motion.pose();
  motion.predict(1.0, hintOf(exp(Vector6(0.9 * Vector6::Unit(0))), 1e-3));
  EXPECT_NEAR(motion.pose().translation.x() - before.translation.x(), 0.9, 1e-2);
  EXPECT_NEAR(motion.poseCovariance()(0, 0), 25.0, 0.1);
}

TEST(MotionHint, OneAfterTheOtherAddUp)
{
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const MotionHint first = hintOf(exp(test::randomTwist(random, 5.0, 1.0)), 0.01);
  const MotionHint second = hintOf(exp(test::randomTwist(random, 5.0, 1.0)), 0.02);
  const MotionHint both = first * second;
  EXPECT_LT(poseDistance(both.last_T_now, first.last_T_now * second.last_T_now), 1e-12);
  const auto disturbed = [&](const MotionHint& hint) {
    const double sigma = std::sqrt(hint.covariance(0, 0));
    Vector6 error;
    for (double& e : error) {
      e = sigma * normal(random);
    }
    return hint.last_T_now * SE3(expSO3(error.tail<3>()), error.head<3>());
  };
  constexpr int kSamples = 20000;
  Matrix6 sampled = Matrix6::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const SE3 off = both.last_T_now.inverse() * disturbed(first) * disturbed(second);
    Vector6 error;
    error << off.translation, logSO3(off.rotation);
    sampled += error * error.transpose() / kSamples;
  }
  EXPECT_LT((sampled - both.covariance).norm(), 0.05 * both.covariance.norm());
}

TEST(MotionHint, GoesBackAsItCame)
{
  std::mt19937 random(7);
  constexpr double kSmall = 1e-6;  // m and rad
  MotionHint hint = hintOf(exp(test::randomTwist(random, 5.0, 1.0)), 0.01);
  hint.covariance(1, 1) *= 4.0;
  const MotionHint back = hint.inverse();
  EXPECT_LT(poseDistance(back.last_T_now * hint.last_T_now, SE3()), 1e-12);
  EXPECT_LT((back.inverse().covariance - hint.covariance).norm(), 1e-12);
  Matrix6 moved;  // the way back, by what moves the way there
  for (int i = 0; i < 6; ++i) {
    const Vector6 off = kSmall * Vector6::Unit(i);
    const SE3 disturbed = hint.last_T_now * SE3(expSO3(off.tail<3>()), off.head<3>());
    const SE3 error = back.last_T_now.inverse() * disturbed.inverse();
    moved.col(i) << error.translation / kSmall, logSO3(error.rotation) / kSmall;
  }
  EXPECT_LT((moved * hint.covariance * moved.transpose() - back.covariance).norm(), 1e-4 * back.covariance.norm());
}

TEST(MotionHint, MustBeOne)
{
  MotionHint hint = hintOf(SE3(), 0.1);
  EXPECT_NO_THROW(hint.validate());
  hint.covariance(2, 2) = 0.0;
  EXPECT_THROW(hint.validate(), std::invalid_argument);
  hint = hintOf(SE3(), 0.1);
  hint.covariance(0, 1) = 1e-3;
  EXPECT_THROW(hint.validate(), std::invalid_argument) << "not symmetric";
  hint = hintOf(SE3(), 0.1);
  hint.last_T_now.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(hint.validate(), std::invalid_argument);
}

}  // namespace pcl_floam
