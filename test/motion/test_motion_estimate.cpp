// The motion estimate: constant velocities, what corrections teach, and covariances.
#include "motion/motion_estimate.h"

#include "motion/constant_motion.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

namespace pcl_floam {

namespace {

constexpr double kExact = 1e-10;  // m^2, rad^2

}  // namespace

TEST(MotionEstimate, LearnsAConstantVelocity)
{
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    const Vector6 velocity = test::randomTwist(random, 2.0, 0.1);
    MotionEstimate motion = afterSteps(velocity, 20);
    motion.predict(1.0);
    EXPECT_LT(poseDistance(motion.pose(), exp(21.0 * velocity)), 1e-2 * velocity.norm());
  }
}

TEST(MotionEstimate, PredictsTheSameInOneStepOrInTwo)
{
  std::mt19937 random(4);
  // Slow, as what disturbs it in between turns and moves with the sensor.
  MotionEstimate once = afterSteps(test::randomTwist(random, 0.1, 0.1), 5);
  MotionEstimate twice = once;
  once.predict(2.0);
  twice.predict(1.0);
  twice.predict(1.0);
  EXPECT_LT(poseDistance(once.pose(), twice.pose()), 1e-9);
  const Matrix6 difference = once.poseCovariance() - twice.poseCovariance();
  EXPECT_LT(difference.norm(), 0.05 * Matrix6(once.poseCovariance()).norm());
}

TEST(MotionEstimate, IsNoSurerOfWhatWasThanOfWhatComes)
{
  std::mt19937 random(5);
  const MotionEstimate now = afterSteps(test::randomTwist(random, 0.5, 0.2), 5);
  MotionEstimate before = now;
  MotionEstimate after = now;
  before.predict(-0.5);
  after.predict(0.5);
  EXPECT_LT(poseDistance(before.pose() * exp(now.velocity()), after.pose()), 1e-9);
  EXPECT_GT(before.poseCovariance().trace(), now.poseCovariance().trace());
  EXPECT_GT(after.poseCovariance().trace(), now.poseCovariance().trace());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 12, 12>> solver(before.covariance());
  EXPECT_GT(solver.eigenvalues()[0], 0.0);
  before.predict(0.5);
  EXPECT_LT(poseDistance(before.pose(), now.pose()), 1e-9);
  EXPECT_GT(before.poseCovariance().trace(), now.poseCovariance().trace()) << "the noise of both ways";
}

TEST(MotionEstimate, IsSurerAfterACorrectionAndLessSureWithTime)
{
  MotionEstimate motion = afterSteps(Vector6::Zero(), 10);
  const double corrected = motion.poseCovariance().trace();
  motion.predict(1.0);
  const double soon = motion.poseCovariance().trace();
  motion.predict(5.0);
  EXPECT_LT(corrected, soon);
  EXPECT_LT(10.0 * soon, motion.poseCovariance().trace());
}

/// By the filter, the velocity follows the pose's error by Riccati's gain.
TEST(MotionEstimate, VelocityFollowsThePoseByItsGain)
{
  std::mt19937 random(6);
  for (int i = 0; i < 10; ++i) {
    MotionEstimate motion = afterSteps(test::randomTwist(random, 1.0, 0.1), 10);
    motion.predict(1.0);
    const Vector6 before = motion.velocity();
    const Vector6 push = test::randomTwist(random, 0.1, 0.01);
    const SE3 pushed(motion.pose().rotation * expSO3(push.tail<3>()),
                     motion.pose().translation + motion.pose().rotation * Eigen::Vector3d(push.head<3>()));
    motion.correct(pushed, kExact * Matrix6(Matrix6::Identity()));
    EXPECT_LT((motion.velocity() - before - 1.27 * push).norm(), 0.03 * push.norm());
  }
}

TEST(MotionEstimate, PlacedElsewhereItMovesOnAsBefore)
{
  MotionEstimate motion = afterSteps(0.3 * Vector6(Vector6::Unit(0)), 10);
  const Vector6 velocity = motion.velocity();
  const SE3 place(expSO3({0.0, 0.0, 1.0}), Eigen::Vector3d(5.0, 6.0, 7.0));
  motion.place(place, 0.01 * Matrix6(Matrix6::Identity()));
  motion.predict(1.0);
  EXPECT_LT(poseDistance(motion.pose(), place * exp(velocity)), 1e-9);
  EXPECT_GT(motion.poseCovariance()(0, 0), 0.01);
}

TEST(MotionEstimate, CovarianceTurnsWithTheSensor)
{
  Vector6 velocity = Vector6::Zero();
  velocity[0] = 1.0;
  Matrix6 only_x_unsure = kExact * Matrix6(Matrix6::Identity());
  only_x_unsure(0, 0) = 1.0;
  MotionEstimate motion(SE3(expSO3({0.0, 0.0, 1.5707963267948966}), Eigen::Vector3d::Zero()), velocity);
  motion.predict(1.0);
  motion.correct(motion.pose(), only_x_unsure);
  EXPECT_GT(motion.poseCovariance()(0, 0), 0.01);
  EXPECT_LT(motion.poseCovariance()(1, 1), 1e-6);
}

/// How far the next prediction may be off in y and about z, after a restless while.
std::pair<double, double> spreadAfter(double translation, double rotation)
{
  std::mt19937 random(8);
  MotionEstimate motion;
  for (int i = 0; i < 150; ++i) {
    motion.predict(1.0);
    motion.correct(exp(test::randomTwist(random, translation, rotation)), kExact * Matrix6(Matrix6::Identity()));
  }
  motion.predict(1.0);
  return {std::sqrt(motion.poseCovariance()(1, 1)), std::sqrt(motion.poseCovariance()(5, 5))};
}

TEST(MotionEstimate, IsExpectedToBeAsRestlessAsItWas)
{
  const auto [shift, turn] = spreadAfter(0.002, 0.002);
  EXPECT_NEAR(spreadAfter(0.0, 0.02).second / turn, 10.0, 0.5);
  EXPECT_NEAR(spreadAfter(0.001, 0.0).first / shift, 0.5, 0.05);
  EXPECT_GT(turn, 0.001) << "no less than it was";
  EXPECT_GT(shift, 0.001);
}

TEST(MotionEstimate, AShiftFromRestIsExpectedFromTheNextScanOn)
{
  constexpr double kShift = 0.02;  // m
  MotionEstimate motion = afterSteps(Vector6::Zero(), 200);
  motion.predict(1.0);
  EXPECT_LT(motion.poseCovariance()(0, 0), 1e-6) << "it has been resting";
  motion.correct(SE3(Eigen::Matrix3d::Identity(), {kShift, 0.0, 0.0}), kExact * Matrix6(Matrix6::Identity()));
  motion.predict(1.0);
  EXPECT_GT(std::sqrt(motion.poseCovariance()(0, 0)), 0.5 * kShift);
  EXPECT_LT(motion.poseCovariance()(1, 1), 1e-6) << "that was along x";
}

/// On an open road hardly anything tells of the way along: that is no sign of rest.
TEST(MotionEstimate, WhereAScanTellsNothingNothingIsLearned)
{
  constexpr double kNothing = 1e4;  // m^2
  Matrix6 all_but_x = kExact * Matrix6(Matrix6::Identity());
  all_but_x(0, 0) = kNothing;
  MotionEstimate corrected;
  MotionEstimate updated;
  for (int i = 0; i < 200; ++i) {
    corrected.predict(1.0);
    corrected.correct(SE3(), all_but_x);
    updated.predict(1.0);
    Matrix12 posterior = updated.covariance();
    posterior.bottomRows<11>().setZero();  // all but x is known
    posterior.rightCols<11>().setZero();
    updated.update(SE3(), Vector6::Zero(), posterior);
  }
  for (MotionEstimate* motion : {&corrected, &updated}) {
    motion->place(SE3(), Matrix6(Matrix6::Zero()));
    motion->predict(1.0);
    EXPECT_GT(std::sqrt(motion->poseCovariance()(0, 0)), 0.01);
    EXPECT_LT(std::sqrt(motion->poseCovariance()(1, 1)), 0.005);
  }
}

/// A scan whose stamp does not advance may be of the last one's instant or of a later one.
TEST(MotionEstimate, AnUnknownTimeFreesThePoseAlongTheMotion)
{
  std::mt19937 random(8);
  const Vector6 velocity = test::randomTwist(random, 1.0, 0.1);
  constexpr double kNoTime = 1e-3;
  constexpr double kOnePeriod = 1.0;
  for (const double true_periods : {0.0, 1.0}) {
    MotionEstimate motion = afterSteps(velocity, 20);
    const double sure = motion.poseCovariance().trace();
    const SE3 truth = motion.pose() * exp(Vector6(true_periods * velocity));
    motion.predict(kNoTime, std::nullopt, kOnePeriod);
    EXPECT_GT(motion.poseCovariance().trace(), sure + 0.9 * velocity.squaredNorm());
    motion.correct(truth, 1e-6 * Matrix6::Identity());
    EXPECT_LT(poseDistance(motion.pose(), truth), 1e-3);
    EXPECT_LT((motion.velocity() - velocity).norm(), 0.02) << "of that it tells nothing";
    MotionEstimate usual = afterSteps(velocity, 20);
    motion.predict(1.0);
    usual.predict(1.0);
    EXPECT_LT(motion.poseCovariance().trace(), 1.5 * usual.poseCovariance().trace());
  }
}

TEST(MotionEstimate, ForgetsTheMotionAlongADirectionAndNoOther)
{
  MotionEstimate motion = afterSteps(0.3 * Vector6(Vector6::Unit(0)), 10);
  const Matrix6 before = motion.poseCovariance();
  motion.forgetAlong(Eigen::Vector3d::UnitY(), 12.0);
  const Matrix6 after = motion.poseCovariance();
  EXPECT_GT(after(1, 1), 1.0);  // 12 periods at any velocity of a car's
  EXPECT_NEAR(after(0, 0), before(0, 0), 1e-12);
  EXPECT_NEAR(after(2, 2), before(2, 2), 1e-12);
  motion.predict(12.0);
  EXPECT_NEAR(std::sqrt(motion.poseCovariance()(1, 1) / after(1, 1)), 2.0, 0.05) << "nor is the velocity known";
}

TEST(MotionEstimate, CovariancesStayPositive)
{
  std::mt19937 random(5);
  MotionEstimate motion(SE3(), Vector6::Zero());
  for (int i = 0; i < 200; ++i) {
    motion.predict(i % 7 == 0 ? 3.0 : 1.0);
    const SE3 measured = motion.pose() * exp(test::randomTwist(random, 0.2, 0.02));
    const Matrix6 half = 0.5 * Matrix6(motion.poseCovariance());
    motion.correct(measured, half);
    const Eigen::Matrix<double, 6, 6> covariance = motion.poseCovariance();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(covariance);
    ASSERT_GT(eigen.eigenvalues().minCoeff(), 0.0);
  }
}

}  // namespace pcl_floam
