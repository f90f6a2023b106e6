// Whether scans tell how the sensor moves, whatever was expected.
#include "odometry/told_motion.h"

#include "common/covariance.h"
#include "common/perturbation.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pcl_floam {
namespace {

constexpr double kWell = 0.005;    // m: as walls around tell
constexpr double kSoSo = 0.03;     // as an open road does
constexpr double kHardly = 0.3;    // as a smooth tunnel does
constexpr double kNothing = 1000;  // m

/// Along x so well, along the others well.
Matrix6 told(double along)
{
  Vector6 variance = Vector6::Constant(kWell * kWell);
  variance[0] = along * along;
  return variance.asDiagonal();
}

Eigen::Matrix3d position(double along)
{
  return toldPosition(told(along), Eigen::Matrix3d::Identity(), std::nullopt);
}

MotionHint hintOf(double along)
{
  MotionHint hint;
  hint.covariance = told(along);
  return hint;
}

TEST(ToldMotion, IsToldAtOnceWhereAScanTellsOfAllDirections)
{
  ToldMotion motion;
  EXPECT_FALSE(motion.isTold());
  motion.take(position(kWell), 1.0);
  EXPECT_TRUE(motion.isTold());
  EXPECT_NEAR(motion.deviation(), kWell, 1e-12);
  EXPECT_TRUE(motion.open().isZero());
}

TEST(ToldMotion, IsNeverToldByScansThatTellLittleHoweverMany)
{
  ToldMotion motion;
  for (int scan = 0; scan < 1000; ++scan) {
    motion.take(position(kSoSo), 1.0);
    ASSERT_FALSE(motion.isTold()) << scan;
  }
}

TEST(ToldMotion, LastsUntilAScanLeavesADirectionOpen)
{
  ToldMotion motion;
  motion.take(position(kWell), 1.0);
  motion.take(position(kSoSo), 1.0);
  EXPECT_TRUE(motion.isTold());
  motion.take(position(kHardly), 1.0);
  EXPECT_FALSE(motion.isTold());
  motion.take(position(kSoSo), 1.0);
  EXPECT_FALSE(motion.isTold());
  motion.take(position(kWell), 1.0);
  EXPECT_TRUE(motion.isTold());
}

TEST(ToldMotion, LastsOverAShortGapButNotOverALongOne)
{
  ToldMotion motion;
  motion.take(position(kWell), 1.0);
  motion.take(position(kSoSo), 3.0);
  EXPECT_TRUE(motion.isTold());
  motion.take(position(kSoSo), 2.0 * kLongestKnown);
  EXPECT_FALSE(motion.isTold());
}

TEST(ToldMotion, TwoScansInARowTellTogether)
{
  constexpr double kHalf = 0.025;  // m
  ToldMotion motion;
  motion.take(position(kHalf), 1.0);
  EXPECT_FALSE(motion.isTold());
  motion.take(position(kHalf), 3.0);
  EXPECT_FALSE(motion.isTold()) << "they are not in a row";
  motion.take(position(kHalf), 1.0);
  EXPECT_TRUE(motion.isTold());
  motion.forget();
  EXPECT_FALSE(motion.isTold());
}

TEST(ToldMotion, OneScanBetweenThoseThatLeaveADirectionOpenDoesNotTellOfIt)
{
  ToldMotion motion;
  for (int scan = 0; scan < 10; ++scan) {
    motion.take(position(scan % 2 == 0 ? kNothing : kWell), 1.0);
    EXPECT_FALSE(motion.isTold()) << scan;
  }
  motion.take(position(kWell), 1.0);
  EXPECT_TRUE(motion.isTold());
}

TEST(ToldMotion, WhatIsNoNumberTellsNothing)
{
  ToldMotion motion;
  motion.take(position(std::nan("")), 1.0);
  EXPECT_FALSE(motion.isTold());
}

TEST(ToldMotion, AnySpeedCountsAlongWhatIsOpenAndOnlyThere)
{
  ToldMotion motion;
  motion.take(position(kHardly), 1.0);
  const Eigen::Matrix3d once = motion.open();
  EXPECT_GT(std::sqrt(once(0, 0)), 1.0);
  EXPECT_NEAR(once(1, 1), 0.0, 1e-12);
  EXPECT_NEAR(once(2, 2), 0.0, 1e-12);
  motion.take(position(kHardly), 3.0);
  EXPECT_TRUE(motion.open().isApprox(9.0 * once));
}

TEST(ToldMotion, AHintTellsWhatTheScanLeavesOpen)
{
  const Eigen::Matrix3d both = toldPosition(told(kNothing), Eigen::Matrix3d::Identity(), hintOf(0.01));
  EXPECT_NEAR(std::sqrt(both(0, 0)), 0.01, 1e-5);
  ToldMotion motion;
  motion.take(both, 1.0);
  EXPECT_TRUE(motion.isTold());
}

/// Whichever way the two look: what the one does not tell at all makes no rounding of the other.
TEST(ToldMotion, AHintIsAsGoodInEveryDirection)
{
  std::mt19937 random(3);
  constexpr double kHint = 0.007;  // m
  for (int i = 0; i < 100; ++i) {
    const Matrix6 turn = turnOf(exp(test::randomTwist(random, 1.0, 3.0)).rotation);
    const Eigen::Matrix3d rotation = exp(test::randomTwist(random, 1.0, 3.0)).rotation;
    const Eigen::Matrix3d both = toldPosition(propagated(turn, told(kNothing)), rotation, hintOf(kHint));
    EXPECT_LT(std::sqrt(both.trace()), 1.1 * std::sqrt(kHint * kHint + 2.0 * kWell * kWell)) << i;
  }
}

TEST(ToldMotion, TwoThatTellAlikeTellTwiceAsMuch)
{
  const Eigen::Matrix3d both = toldPosition(told(kSoSo), Eigen::Matrix3d::Identity(), hintOf(kSoSo));
  EXPECT_NEAR(both(0, 0), kSoSo * kSoSo / 2.0, 1e-12);
  EXPECT_NEAR(both(1, 1), kWell * kWell / 2.0, 1e-12);
}

TEST(ToldMotion, AHintIsInTheSensorsAxes)
{
  const Eigen::Matrix3d left = (Eigen::Matrix3d() << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0).finished();
  MotionHint hint = hintOf(kNothing);  // of y in the target's axes
  const Eigen::Matrix3d both = toldPosition(told(kNothing), left, hint);
  EXPECT_GT(std::sqrt(both(0, 0)), 0.9 * kWell / std::sqrt(2.0));
  EXPECT_LT(std::sqrt(both(0, 0)), 1.1 * kWell);
  EXPECT_NEAR(std::sqrt(both(1, 1)), kWell, 1e-6);
}

TEST(ToldMotion, NothingHasToTellOfWhatIsLocked)
{
  ToldMotion motion;
  motion.take(position(0.0), 1.0);
  EXPECT_TRUE(motion.isTold());
  EXPECT_TRUE(std::isfinite(motion.deviation()));
  const Eigen::Matrix3d hinted = toldPosition(told(0.0), Eigen::Matrix3d::Identity(), hintOf(kNothing));
  EXPECT_LT(std::sqrt(hinted(0, 0)), 1e-3) << "a hint does not know it, but need not";
}

}  // namespace
}  // namespace pcl_floam
