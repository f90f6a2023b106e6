// How the sensor moves during a sweep, from all sweeps so far.
#include "odometry/axis_velocity.h"
#include "odometry/sweep_velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

namespace pcl_floam {
namespace {

/// The errors of a filter that sees a motion with noise, and those of what it sees.
struct Errors {
  double measured = 0.0;   ///< of the velocity, root mean square
  double estimated = 0.0;  ///< of the same
};

/// A displacement as a function of time, measured once per period: poses with 1 mm, velocities with \p velocity_noise.
Errors errorsAlong(const std::function<double(double)>& displacement, int first, int scans, double velocity_noise)
{
  constexpr double kPoseNoise = 1e-3;
  constexpr double kStep = 1e-4;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  AxisVelocity axis;
  const auto velocity = [&](double t) { return (displacement(t + kStep) - displacement(t - kStep)) / (2.0 * kStep); };
  axis.begin(velocity(0.0));
  double last = displacement(0.0);
  Errors errors;
  for (int i = 1; i < scans; ++i) {
    const double pose = displacement(i) + kPoseNoise * normal(random);
    const double measured = velocity(i) + velocity_noise * normal(random);
    axis.observe({pose - last, measured, kPoseNoise * kPoseNoise, velocity_noise * velocity_noise}, 1.0);
    last = pose;
    if (i >= first) {
      errors.measured += std::pow(measured - velocity(i), 2) / (scans - first);
      errors.estimated += std::pow(axis.velocity() - velocity(i), 2) / (scans - first);
    }
  }
  return {std::sqrt(errors.measured), std::sqrt(errors.estimated)};
}

TEST(AxisVelocity, LearnsThatAMotionIsSteady)
{
  const Errors errors = errorsAlong([](double t) { return 1.3 * t; }, 100, 1000, 3.5e-3);
  EXPECT_LT(errors.estimated, 0.1 * errors.measured);
}

TEST(AxisVelocity, LearnsThatAMotionSwings)
{
  const Errors slow = errorsAlong([](double t) { return 0.5 * std::sin(0.2 * t); }, 100, 1000, 3.5e-3);
  EXPECT_LT(slow.estimated, 0.6 * slow.measured);
  const Errors quick = errorsAlong([](double t) { return 0.5 * std::sin(1.1 * t); }, 100, 1000, 3.5e-3);
  EXPECT_LT(quick.estimated, 1.1 * quick.measured) << "there is nothing to be gained, but nothing lost";
}

TEST(AxisVelocity, IsNotSurprisedForLong)
{
  // After a long rest the sensor starts at 0.02 m per period^2: within two scans the error is that of a measurement.
  constexpr int kRest = 500;
  const auto start = [](double t) { return t < kRest ? 0.0 : 0.01 * (t - kRest) * (t - kRest); };
  const Errors errors = errorsAlong(start, kRest + 2, kRest + 10, 3.5e-3);
  EXPECT_LT(errors.estimated, 1.5 * errors.measured);
}

TEST(AxisVelocity, DoesNotCareForUnits)
{
  AxisVelocity metres;
  AxisVelocity millimetres;
  metres.begin(0.5);
  millimetres.begin(500.0);
  for (int i = 0; i < 50; ++i) {
    const double wobble = 0.01 * std::sin(i);
    metres.observe({0.5 + wobble, 0.5 - wobble, 1e-6, 12e-6}, 1.0);
    millimetres.observe({500.0 + 1e3 * wobble, 500.0 - 1e3 * wobble, 1.0, 12.0}, 1.0);
    EXPECT_NEAR(1e3 * metres.velocity(), millimetres.velocity(), 1e-6);
    EXPECT_NEAR(1e3 * metres.acceleration(), millimetres.acceleration(), 1e-6);
  }
}

TEST(AxisVelocity, IsExactForExactMeasurements)
{
  // A constant acceleration, and a scan that is missing.
  const auto displacement = [](double t) { return 0.3 * t + 0.01 * t * t; };
  AxisVelocity axis;
  axis.begin(0.3);
  double last = 0.0;
  for (int i = 1; i < 60; ++i) {
    if (i == 40) {
      continue;
    }
    const double periods = i == 41 ? 2.0 : 1.0;
    axis.observe({displacement(i) - last, 0.3 + 0.02 * i, 1e-6, 12e-6}, periods);
    last = displacement(i);
    if (i > 20) {
      EXPECT_NEAR(axis.velocity(), 0.3 + 0.02 * i, 1e-5) << i;
      EXPECT_NEAR(axis.acceleration(), 0.02, 1e-5) << i;
    }
  }
}

/// The error of the velocity, root mean square, where every \p every-th pose is off by ten times as much as the others.
double errorWithPoorPoses(int every, bool are_known)
{
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  AxisVelocity axis;
  axis.begin(0.0);
  double last = 0.0;
  double squares = 0.0;
  constexpr int kScans = 2000;
  for (int i = 1; i < kScans; ++i) {
    const double noise = i % every == 0 ? 1e-2 : 1e-3;
    const double variance = are_known ? noise * noise : 1e-6;
    const double truth = 0.05 * std::sin(0.1 * i);  // it sets off and turns back
    const double pose = -0.5 * std::cos(0.1 * i) + noise * normal(random);
    axis.observe({pose - last, truth + 3.5 * noise * normal(random), variance, 12.0 * variance}, 1.0);
    last = pose;
    squares += i > 100 ? std::pow(axis.velocity() - truth, 2) / (kScans - 100) : 0.0;
  }
  return std::sqrt(squares);
}

TEST(AxisVelocity, PoorlyKnownPosesCountForLess)
{
  EXPECT_LT(errorWithPoorPoses(7, true), 0.6 * errorWithPoorPoses(7, false));
}

/// A car that goes straight on while it pitches steadily.
Vector6 carTwist()
{
  Vector6 twist = Vector6::Zero();
  twist[0] = 1.3;
  twist[4] = 0.01;
  return twist;
}

TEST(SweepVelocity, KeepsWhatIsRight)
{
  for (const double fraction : {1.0, 0.6}) {
    SweepVelocity velocity;
    velocity.begin(carTwist());
    const SweepMotion truth(fraction * carTwist(), 0.5);
    for (int i = 0; i < 20; ++i) {
      const SweepMotion refined = velocity.refine(truth, 1e-6 * Matrix6::Identity(), fraction, carTwist(), 1.0);
      EXPECT_LT((refined.twist() - truth.twist()).norm(), 1e-12);
      EXPECT_LT(refined.acceleration().norm(), 1e-12);
      EXPECT_EQ(refined.reference(), 0.5);
    }
  }
}

TEST(SweepVelocity, IsExactForAConstantAccelerationAcrossAGap)
{
  constexpr double kFraction = 0.6;
  constexpr double kAcceleration = 0.02;
  SweepVelocity velocity;
  velocity.begin(carTwist());
  double last = 0.0;
  for (int i = 1; i < 60; ++i) {
    if (i == 40) {
      continue;
    }
    const double periods = i == 41 ? 2.0 : 1.0;
    Vector6 twist = kFraction * carTwist();
    twist[0] += kFraction * kAcceleration * i;
    const double displacement = 1.3 * i + 0.5 * kAcceleration * i * i;
    Vector6 between = carTwist();
    between[0] = (displacement - last) / periods;
    last = displacement;
    const SweepMotion refined =
        velocity.refine(SweepMotion(twist, 0.5), 1e-6 * Matrix6::Identity(), kFraction, between, periods);
    if (i > 20) {
      EXPECT_LT((refined.twist() - twist).norm(), 1e-5) << i;
      EXPECT_NEAR(refined.acceleration()[0], kFraction * kFraction * kAcceleration, 1e-5) << i;
    }
  }
}

/// A sensor that swings along x; poses are off by 1 mm, motions over sweeps by root twelve times as much.
double errorWhileSwinging(double fraction)
{
  constexpr double kNoise = 1e-3;
  constexpr double kRate = 0.4;
  constexpr int kScans = 3000;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  SweepVelocity velocity;
  velocity.begin(Vector6::Zero());
  double last = 0.0;
  double squares = 0.0;
  for (int i = 1; i < kScans; ++i) {
    const double truth = 0.05 * std::cos(kRate * i);
    const double pose = 0.05 / kRate * std::sin(kRate * i) + kNoise * normal(random);
    Vector6 registered = Vector6::Zero();
    registered[0] = fraction * truth + std::sqrt(12.0) * kNoise * normal(random);
    Vector6 between = Vector6::Zero();
    between[0] = pose - last;
    last = pose;
    const Matrix6 covariance = kNoise * kNoise * Matrix6::Identity();
    const double refined = velocity.refine(SweepMotion(registered, 0.5), covariance, fraction, between, 1.0).twist()[0];
    squares += i > 100 ? std::pow(refined / fraction - truth, 2) / (kScans - 100) : 0.0;
  }
  return std::sqrt(squares);
}

TEST(SweepVelocity, AShortSweepSaysLittleOfTheVelocity)
{
  const double of_short_sweeps = errorWhileSwinging(0.15);
  const double of_whole_ones = errorWhileSwinging(1.0);
  RecordProperty("ratio", std::to_string(of_short_sweeps / of_whole_ones));
  EXPECT_LT(of_short_sweeps, 2.0 * of_whole_ones);
}

TEST(SweepVelocity, TheFirstSweepIsTakenAsItIsWhereNothingIsKnown)
{
  SweepVelocity velocity;
  const SweepMotion truth(carTwist(), 0.5);
  for (int i = 0; i < 10; ++i) {
    const Vector6 between = i == 0 ? Vector6(0.1 * carTwist()) : carTwist();  // at first, how far off the guess was
    const Vector6 twist = velocity.refine(truth, 1e-6 * Matrix6::Identity(), 1.0, between, 1.0).twist();
    EXPECT_LT((twist - carTwist()).norm(), 1e-12);
  }
}

TEST(SweepVelocity, TellsTheAxesApart)
{
  // Along x the registration errs by 1 cm, now ahead and now back; the pitch rate really swings.
  SweepVelocity velocity;
  velocity.begin(carTwist());
  Vector6 last = carTwist();
  for (int i = 1; i < 200; ++i) {
    Vector6 truth = carTwist();
    truth[4] = 0.01 * std::cos(0.9 * i);
    Vector6 between = carTwist();
    between[4] = 0.01 / 0.9 * (std::sin(0.9 * i) - std::sin(0.9 * (i - 1)));
    Vector6 registered = truth;
    registered[0] += i % 2 == 0 ? 0.01 : -0.01;
    last = velocity.refine(SweepMotion(registered, 0.5), 1e-6 * Matrix6::Identity(), 1.0, between, 1.0).twist();
    if (i > 100) {
      EXPECT_NEAR(last[0], truth[0], 1e-3);
      EXPECT_NEAR(last[4], truth[4], 1e-3);
    }
  }
}

TEST(SweepVelocity, StartsAnewAfterALongGap)
{
  SweepVelocity velocity;
  velocity.begin(Vector6::Zero());
  for (int i = 0; i < 20; ++i) {
    velocity.refine(SweepMotion(Vector6::Zero(), 0.5), 1e-6 * Matrix6::Identity(), 1.0, Vector6::Zero(), 1.0);
  }
  const SweepMotion truth(carTwist(), 0.5);
  EXPECT_EQ(velocity.refine(truth, 1e-6 * Matrix6::Identity(), 1.0, carTwist(), 5.0).twist(), carTwist());
  const Vector6 next = velocity.refine(truth, 1e-6 * Matrix6::Identity(), 1.0, carTwist(), 1.0).twist();
  EXPECT_LT((next - carTwist()).norm(), 1e-12);
}

TEST(SweepVelocity, LockedDirectionsHaveNoVariance)
{
  SweepVelocity velocity;
  velocity.begin(Vector6::Zero());
  for (int i = 0; i < 5; ++i) {
    const SweepMotion refined = velocity.refine(SweepMotion(carTwist(), 0.5), Matrix6::Zero(), 1.0, carTwist(), 1.0);
    EXPECT_TRUE(refined.twist().allFinite());
    EXPECT_TRUE(refined.acceleration().allFinite());
  }
}

}  // namespace
}  // namespace pcl_floam
