// How a sweep turns, from that sweep, the last one, and the motions between their poses.
#include "odometry/sweep_turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pcl_floam {
namespace {

/// A sensor that turns about its z axis; the angular velocity changes by the same in each period.
struct SteadyTurn {
  double rate;          ///< rad per period, in the middle of sweep 0
  double acceleration;  ///< of it, per period

  [[nodiscard]] double rateAt(int sweep) const { return rate + acceleration * sweep; }

  [[nodiscard]] Eigen::Vector3d during(int number, double error = 0.0) const
  {
    return {0.0, 0.0, rateAt(number) + error};
  }

  [[nodiscard]] Eigen::Vector3d between(int number) const { return {0.0, 0.0, rateAt(number) - 0.5 * acceleration}; }
};

TEST(SweepTurn, IsExactForAConstantAngularAcceleration)
{
  const SteadyTurn truth{0.2, -0.05};
  SweepTurn turn;
  turn.refine(truth.during(0), truth.between(0), 1.0);
  for (int i = 1; i < 5; ++i) {
    EXPECT_NEAR(turn.refine(truth.during(i), truth.between(i), 1.0).z(), truth.rateAt(i), 1e-12);
  }
}

TEST(SweepTurn, AWrongRegistrationCountsForLess)
{
  const SteadyTurn truth{0.2, 0.01};
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-3);
  SweepTurn turn;
  double registered = 0.0;
  double refined = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double error = noise(random);
    const Eigen::Vector3d motion = turn.refine(truth.during(i, error), truth.between(i), 1.0);
    registered += error * error;
    refined += i == 0 ? 0.0 : std::pow(motion.z() - truth.rateAt(i), 2);
  }
  EXPECT_LT(refined, 0.95 * registered);
}

TEST(SweepTurn, KnowsTheLastSweepInItsOwnAxes)
{
  // Turned by 40 degrees about z between the poses while it rolls about an axis that stays where it is.
  const Eigen::Vector3d between(0.0, 0.0, 0.7);
  const Eigen::Vector3d last(0.1, 0.0, 0.0);
  const Eigen::Vector3d now = expSO3(Eigen::Vector3d(0.0, 0.0, -0.7)) * last;
  SweepTurn turn;
  turn.refine(last, between, 1.0);
  const Eigen::Vector3d expected = (0.7 - 0.6) * now + (0.75 + 0.15) * between;
  EXPECT_LT((turn.refine(now, between, 1.0) - expected).norm(), 1e-12);
}

TEST(SweepTurn, StartsAnewAfterAGap)
{
  const SteadyTurn truth{0.2, 0.1};
  SweepTurn turn;
  turn.refine(truth.during(0), truth.between(0), 1.0);
  EXPECT_EQ(turn.refine(truth.during(3), truth.between(3), 3.0), truth.during(3));
  const Eigen::Vector3d next = truth.during(4, 1e-3);
  EXPECT_EQ(turn.refine(next, truth.between(4), 1.0), next);
  EXPECT_NEAR(turn.refine(truth.during(5), truth.between(5), 1.0).z(), truth.rateAt(5) - 0.6e-3, 1e-12);
}

}  // namespace
}  // namespace pcl_floam
