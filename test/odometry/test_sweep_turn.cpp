// How a sweep turns, from that sweep, the last one, and the motions between their poses.
#include "odometry/sweep_turn.h"

#include <gtest/gtest.h>

#include <random>

namespace pcl_floam {
namespace {

/// A sensor that turns about its z axis and goes straight on; the angular velocity changes by the same in each period.
struct SteadyTurn {
  double rate;          ///< rad per period, in the middle of sweep 0
  double acceleration;  ///< of it, per period
  double fraction;      ///< of a period that a sweep takes

  [[nodiscard]] double rateAt(int sweep) const { return rate + acceleration * sweep; }

  /// As registered: the twist is right, the acceleration unknown.
  [[nodiscard]] SweepMotion sweep(int number, double error = 0.0) const
  {
    Vector6 twist = Vector6::Zero();
    twist[0] = 1.3;
    twist[5] = fraction * (rateAt(number) + error);
    return SweepMotion(twist, 0.5);
  }

  [[nodiscard]] Vector6 between(int number) const
  {
    Vector6 motion = Vector6::Zero();
    motion[0] = 1.3;
    motion[5] = rateAt(number) - 0.5 * acceleration;
    return motion;
  }
};

TEST(SweepTurn, IsExactForAConstantAngularAcceleration)
{
  for (const double fraction : {1.0, 0.6}) {
    const SteadyTurn truth{0.2, -0.05, fraction};
    SweepTurn turn;
    turn.refine(truth.sweep(0), fraction, truth.between(0), 1.0);
    for (int i = 1; i < 5; ++i) {
      const SweepMotion refined = turn.refine(truth.sweep(i), fraction, truth.between(i), 1.0);
      EXPECT_NEAR(refined.twist()[5], fraction * truth.rateAt(i), 1e-12);
      EXPECT_NEAR(refined.acceleration()[5], fraction * fraction * truth.acceleration, 1e-12);
    }
  }
}

TEST(SweepTurn, LeavesTheTranslationAlone)
{
  const SteadyTurn truth{0.2, 0.1, 1.0};
  SweepTurn turn;
  turn.refine(truth.sweep(0), 1.0, truth.between(0), 1.0);
  const SweepMotion refined = turn.refine(truth.sweep(1), 1.0, truth.between(1), 1.0);
  EXPECT_EQ(refined.twist().head<3>(), truth.sweep(1).twist().head<3>());
  EXPECT_TRUE(refined.acceleration().head<3>().isZero(0.0));
  EXPECT_EQ(refined.reference(), 0.5);
}

TEST(SweepTurn, AWrongRegistrationCountsForLess)
{
  const SteadyTurn truth{0.2, 0.01, 1.0};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-3);
  SweepTurn turn;
  double registered = 0.0;
  double refined = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double error = noise(random);
    const SweepMotion motion = turn.refine(truth.sweep(i, error), 1.0, truth.between(i), 1.0);
    registered += error * error;
    refined += i == 0 ? 0.0 : std::pow(motion.twist()[5] - truth.rateAt(i), 2);
  }
  EXPECT_LT(refined, 0.95 * registered);
}

TEST(SweepTurn, KnowsTheLastSweepInItsOwnAxes)
{
  // Turned by 40 degrees about z between the poses while it rolls about an axis that stays where it is.
  Vector6 between = Vector6::Zero();
  between[5] = 0.7;
  const Eigen::Vector3d rate(0.1, 0.0, 0.0);
  const Eigen::Matrix3d now_R_last = expSO3(Eigen::Vector3d(0.0, 0.0, -0.7));
  Vector6 last = Vector6::Zero();
  last.tail<3>() = rate;
  Vector6 now = Vector6::Zero();
  now.tail<3>() = now_R_last * rate;
  SweepTurn turn;
  turn.refine(SweepMotion(last, 0.5), 1.0, between, 1.0);
  const SweepMotion refined = turn.refine(SweepMotion(now, 0.5), 1.0, between, 1.0);
  const Eigen::Vector3d expected = (0.7 - 0.6) * now_R_last * rate + (0.75 + 0.15) * between.tail<3>();
  EXPECT_LT((refined.twist().tail<3>() - expected).norm(), 1e-12);
}

TEST(SweepTurn, StartsAnewAfterAGap)
{
  const SteadyTurn truth{0.2, 0.1, 1.0};
  SweepTurn turn;
  turn.refine(truth.sweep(0), 1.0, truth.between(0), 1.0);
  EXPECT_EQ(turn.refine(truth.sweep(3), 1.0, truth.between(3), 3.0).twist(), truth.sweep(3).twist());
  const SweepMotion next = truth.sweep(4, 1e-3);
  EXPECT_EQ(turn.refine(next, 1.0, truth.between(4), 1.0).twist(), next.twist());
  EXPECT_NEAR(turn.refine(truth.sweep(5), 1.0, truth.between(5), 1.0).twist()[5], truth.rateAt(5) - 0.6e-3, 1e-12);
}

}  // namespace
}  // namespace pcl_floam
