// The first scans of a drive, taken at 25 m/s among cars of about the same speed, or beside them.

#include "simulator/first_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pcl_floam::simulator {

std::string nameOf(const testing::TestParamInfo<Start>& info)
{
  const Start& start = info.param;
  return start.sensor + "Seed" + std::to_string(start.seed) + "At" + std::to_string(static_cast<int>(start.seconds)) +
         (start.dropout > 0.0 ? "WithReturnsMissing" : "");
}

class StartsInTraffic : public testing::TestWithParam<Start> {};

INSTANTIATE_TEST_SUITE_P(Highway, StartsInTraffic,
                         testing::Values(Start{21, 25.3}, Start{21, 34.5}, Start{22, 0.0}, Start{22, 6.9},
                                         Start{22, 0.0, 0.3}),
                         nameOf);

TEST_P(StartsInTraffic, TheWorldIsWhatStands)
{
  constexpr int kAllAtOnce = 1000;
  FirstScans scans(optionsOf(GetParam()), kAllAtOnce);
  scans.next();
  for (std::size_t number = 1; number < 5; ++number) {
    scans.next();
    EXPECT_GT(scans.trueMotion(), 2.0) << number;
    EXPECT_LT(scans.motionError(), 0.2) << number;
  }
}

/// Sensors of few scan lines, whose first two scans don't tell.
class AmbiguousStarts : public testing::TestWithParam<Start> {};

const std::vector<Start> kAmbiguous{Start{21, 0.0, 0.0, "vlp16"}, Start{22, 0.0, 0.0, "vlp16"},
                                    Start{23, 0.0, 0.3, "vlp16"}, Start{31, 0.0, 0.0, "hdl32"}};
INSTANTIATE_TEST_SUITE_P(Highway, AmbiguousStarts, testing::ValuesIn(kAmbiguous), nameOf);

constexpr int kSettled = 10;  // scans after which the start must be known
constexpr int kRefined = 12;  // and after which the first poses are as good as they get
constexpr int kScans = 26;
/// m: half of a period's way at 25 m/s; with another motion the way would be off by several periods'.
constexpr double kHalfAPeriod = 1.25;

TEST_P(AmbiguousStarts, AreToldOfUntilTheNextScansTell)
{
  constexpr double kJump = 0.1;  // m
  FirstScans scans(optionsOf(GetParam()));
  bool was_provisional = false;
  for (int number = 0; number < kScans; ++number) {
    const OdometryReport& report = scans.next();
    const bool is_right = scans.motionError() < 0.3 && scans.wayError() < 1.0;
    EXPECT_TRUE(number < kSettled || is_right || report.provisional || report.state == TrackingState::doubtful)
        << number << ": " << scans.motionError() << ' ' << scans.wayError();
    EXPECT_TRUE(report.corrected_poses.empty() || was_provisional || number < kRefined) << number;
    EXPECT_TRUE(!saysSeveralExplain(report) || (report.provisional && number + 1 >= kRefined)) << number;
    was_provisional = was_provisional || report.provisional;
    if (scans.correctedBy() > kJump) {
      EXPECT_TRUE(was_provisional) << number;
      EXPECT_FALSE(report.reason.empty()) << number;
    }
  }
}

TEST(ManyAmbiguousStarts, HardlyOneIsLost)
{
  std::vector<Start> starts = kAmbiguous;
  for (const unsigned seed : {24U, 25U, 26U, 27U}) {
    starts.push_back({seed, 0.0, 0.0, "vlp16"});
  }
  std::string lost;
  std::size_t found = 0;
  for (const Start& start : starts) {
    FirstScans scans(optionsOf(start));
    bool is_open = true;
    for (int number = 0; number < kScans || (is_open && number < kLongest); ++number) {
      is_open = scans.next().provisional;
    }
    // The report tells what the poses before should have been.
    const bool is_right = scans.motionError() < 0.3 && scans.greatestWayError(kFirst) < 1.0;
    found += is_right ? 1 : 0;
    lost += is_right ? "" : " " + std::to_string(start.seed);
  }
  EXPECT_GE(found + 1, starts.size()) << "lost:" << lost;
}

/// The other one is lost: see the README's limits.
class ScanMissingAtTheStart : public testing::TestWithParam<Start> {};

INSTANTIATE_TEST_SUITE_P(Highway, ScanMissingAtTheStart, testing::Values(kAmbiguous[0], kAmbiguous[2], kAmbiguous[3]),
                         nameOf);

TEST_P(ScanMissingAtTheStart, IsSettled)
{
  for (const int missing : {1, 2}) {
    FirstScans scans(optionsOf(GetParam()));
    bool is_open = true;
    for (int number = 0; number < kScans + missing || (is_open && number < kLongest); ++number) {
      is_open = (number == missing ? scans.miss() : scans.next()).provisional;
    }
    EXPECT_FALSE(is_open) << missing;
    EXPECT_LT(scans.motionError(), 0.3) << missing;
    EXPECT_LT(scans.wayError(), kHalfAPeriod) << missing;
    EXPECT_LT(scans.greatestWayError(kFirst), kHalfAPeriod) << missing;
  }
}

TEST_P(AmbiguousStarts, ACopyKnowsOfThemToo)
{
  Simulation simulation(optionsOf(GetParam()));
  Odometry<PointXYZIRT> odometry;
  for (std::size_t number = 0; number < 3; ++number) {
    odometry.track(simulation.sweep(number).cloud);
  }
  Odometry<PointXYZIRT> copy = odometry;
  for (std::size_t number = 3; number < kScans; ++number) {
    const Sweep sweep = simulation.sweep(number);
    odometry.track(sweep.cloud);
    copy.track(sweep.cloud);
  }
  EXPECT_EQ(copy.getPose().translation, odometry.getPose().translation);
}

/// A lorry beside the sensor stays there for seconds after the start.
TEST(AmongTraffic, TheWorldIsWhatIsSpread)
{
  FirstScans scans(optionsOf({22, 0.0, 0.0, "hdl32"}));
  for (int number = 0; number < 60; ++number) {
    scans.next();
  }
  EXPECT_LT(scans.wayError(), 1.0);
}

/// Many more starts are from rest than in motion.
class StandingBesideTraffic : public testing::TestWithParam<Start> {};

INSTANTIATE_TEST_SUITE_P(Highway, StandingBesideTraffic,
                         testing::Values(Start{51, 0.0, 0.0, "vlp16"}, Start{53, 5.0, 0.0, "vlp16"},
                                         Start{51, 10.0, 0.0, "hdl32"}),
                         nameOf);

/// Or it is told that it may not: among cars of one speed rest is one of several motions until one of them is left.
TEST_P(StandingBesideTraffic, TheSensorStands)
{
  int stands = 0;
  SimulationOptions options = optionsOf(GetParam());
  options.standing = -4.0;  // on the hard shoulder
  FirstScans scans(options);
  for (int number = 0; number < kScans; ++number) {
    const OdometryReport& report = scans.next();
    const bool is_told = report.state != TrackingState::tracked || report.provisional;
    stands += scans.motionError() < 0.05 && scans.wayError() < 0.4 ? 1 : 0;
    if (number >= kSettled && !is_told) {
      EXPECT_LT(scans.motionError(), 0.05) << number;
      EXPECT_LT(scans.wayError(), 0.4) << number;
    }
  }
  EXPECT_GT(stands, kScans / 2);
}

}  // namespace pcl_floam::simulator
