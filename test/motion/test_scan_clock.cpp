// The clock of the scans.
#include "motion/scan_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pcl_floam {
namespace {

/// A clock that has seen scans every 0.1 s up to the time 100.
ScanClock steadyClock()
{
  ScanClock clock;
  for (int i = -5; i <= 0; ++i) {
    clock.tick(100.0 + 0.1 * i);
  }
  return clock;
}

TEST(ScanClock, CountsPeriods)
{
  ScanClock clock = steadyClock();
  EXPECT_NEAR(clock.period(), 0.1, 1e-9);
  EXPECT_NEAR(clock.tick(100.1), 1.0, 1e-9);
  EXPECT_NEAR(clock.tick(100.4), 3.0, 1e-9);
  EXPECT_EQ(clock.tick(std::nullopt), 1.0);
  EXPECT_EQ(clock.tick(std::numeric_limits<double>::quiet_NaN()), 1.0);
}

/// Of stamps that are taken when a scan arrives.
TEST(ScanClock, TellsHowStampsJitter)
{
  ScanClock clock = steadyClock();
  EXPECT_NEAR(clock.jitter(), 0.0, 1e-6);
  clock.tick(100.3);  // one is missing
  EXPECT_NEAR(clock.jitter(), 0.0, 1e-6);
  std::mt19937 random(1);
  std::normal_distribution<double> late(0.0, 0.01);
  for (int i = 4; i < 40; ++i) {
    clock.tick(100.0 + 0.1 * i + late(random));
  }
  EXPECT_NEAR(clock.jitter(), std::sqrt(2.0) * 0.1, 0.07) << "of the differences of two";
}

/// As if the sensor turned twice as fast as it is said to.
TEST(ScanClock, EverySecondScanMissingIsNoJitter)
{
  ScanClock clock(0.1);
  for (int i = 0; i < 10; ++i) {
    clock.tick(100.0 + 0.2 * i);
  }
  EXPECT_NEAR(clock.jitter(), 0.0, 1e-6);
}

/// What went by without a stamp is in the next one.
TEST(ScanClock, NoPeriodIsCountedTwice)
{
  ScanClock clock = steadyClock();
  double periods = clock.tick(std::nullopt) + clock.tick(100.2);
  EXPECT_NEAR(periods, 2.0, 1e-9);
  periods += clock.tick(std::nullopt) + clock.tick(std::nullopt) + clock.tick(100.6);
  EXPECT_NEAR(periods, 6.0, 1e-9) << "two without a stamp, and one that is missing";
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(clock.tick(std::nullopt), 1.0);
    EXPECT_NEAR(clock.tick(100.8 + 0.2 * i), 1.0, 1e-9);
  }
  EXPECT_NEAR(clock.period(), 0.1, 1e-9);
}

TEST(ScanClock, StampsThatDoNotAdvanceAreNoTime)
{
  ScanClock clock = steadyClock();
  EXPECT_EQ(clock.tick(100.0), 0.0);
  EXPECT_NEAR(clock.tick(100.1), 1.0, 1e-9);
  EXPECT_EQ(clock.tick(100.1 + 1e-7), 0.0);  // a motion divided by it would be no velocity
  EXPECT_NEAR(clock.tick(100.2), 1.0, 1e-5);
  EXPECT_EQ(clock.tick(99.8), 0.0);
  EXPECT_GE(clock.error(), 1.0);
  EXPECT_NEAR(clock.tick(99.9), 1.0, 1e-9);
  EXPECT_EQ(clock.error(), 1.0) << "since when is not known either";
  EXPECT_NEAR(clock.tick(100.0), 1.0, 1e-9);
  EXPECT_EQ(clock.error(), 0.0);
}

TEST(ScanClock, StampsThatStandStillAreNone)
{
  ScanClock clock = steadyClock();
  EXPECT_EQ(clock.tick(100.0), 0.0);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(clock.tick(100.0), 1.0) << i;
  }
  EXPECT_EQ(clock.error(), 0.0);
  EXPECT_NEAR(clock.tick(100.6), 1.0, 1e-9) << "what was counted is in it";

  ScanClock back = steadyClock();
  EXPECT_EQ(back.tick(99.8), 0.0);
  EXPECT_EQ(back.tick(99.7), 1.0);
  EXPECT_NEAR(back.tick(99.8), 1.0, 1e-9);

  ScanClock never;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(never.tick(0.0), 1.0) << i;
    EXPECT_EQ(never.error(), 0.0) << i;
  }
}

TEST(ScanClock, AClockThatWasSetTellsNothing)
{
  for (const double jump : {3600.0, -3600.0, 1e300, -1e300}) {
    ScanClock clock = steadyClock();
    EXPECT_EQ(clock.tick(100.0 + jump), 1.0) << jump;
    EXPECT_NEAR(clock.period(), 0.1, 1e-9) << jump;
  }
  ScanClock clock;
  clock.tick(-std::numeric_limits<double>::max());
  EXPECT_EQ(clock.tick(std::numeric_limits<double>::max()), 1.0);  // their difference is not finite
}

TEST(ScanClock, AWrongFirstPeriodIsForgotten)
{
  ScanClock clock;
  clock.tick(0.0);
  clock.tick(1e-7);
  for (int i = 1; i <= 4; ++i) {
    clock.tick(0.1 * i);
  }
  EXPECT_NEAR(clock.period(), 0.1, 1e-6);
  EXPECT_NEAR(clock.tick(0.7), 3.0, 1e-5);
}

TEST(ScanClock, APeriodThatWasTooLongIsForgotten)
{
  for (const auto& [first, second] : {std::pair<double, double>{0.0, 1.7e9}, {0.1, 60.1}}) {
    ScanClock clock;
    clock.tick(0.0);
    clock.tick(first);
    clock.tick(second);
    for (int i = 1; i <= 6; ++i) {
      clock.tick(second + 0.1 * i);
    }
    EXPECT_NEAR(clock.period(), 0.1, 1e-6) << second;
    EXPECT_NEAR(clock.tick(second + 0.9), 3.0, 1e-5) << second;
  }
}

}  // namespace
}  // namespace pcl_floam
