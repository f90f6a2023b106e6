// Starts among cars of about the same speed, of which the first scans do not tell.
#include "simulator/first_scans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace pcl_floam::simulator {

/// Twelve sweeps do not tell here: that is said, and the next ones tell.
TEST(UndecidedStarts, AreDoubtfulUntilOneMotionIsLeft)
{
  FirstScans scans(optionsOf(Start{23, 0.0, 0.3, "vlp16"}));
  int undecided = 0;
  bool is_provisional = false;
  for (int number = 0; number < kLongest; ++number) {
    const OdometryReport& report = scans.next();
    is_provisional = report.provisional;
    undecided += report.state == TrackingState::doubtful && saysSeveralExplain(report) ? 1 : 0;
  }
  EXPECT_GT(undecided, 0);
  EXPECT_FALSE(is_provisional);
  EXPECT_LT(scans.motionError(), 0.3);
  EXPECT_LT(scans.wayError(), 2.0);
}

/// With the errors of a real lidar, where it takes long until one motion is left.
SimulationOptions slowlyTold(unsigned seed = 6, double begin = 0.0)
{
  SimulationOptions options = optionsOf({seed, begin, 0.0, "vlp16"});
  options.realism = Realism::real;
  return options;
}

/// Rivals are followed for longer than sweeps are kept, and none is chosen meanwhile.
TEST(UndecidedStarts, AreNotSettledByTheClock)
{
  constexpr int kLong = 120;  // scans
  FirstScans scans(slowlyTold(38, 7.0));
  int undecided = 0;
  for (int number = 0; number < kLong; ++number) {
    const OdometryReport report = scans.next();
    undecided += saysSeveralExplain(report) ? 1 : 0;
    EXPECT_TRUE(report.state != TrackingState::tracked || report.provisional || scans.motionError() < 0.3) << number;
  }
  EXPECT_GT(undecided, kLong / 2) << "settled soon: nothing is shown";
}

/// While a wrong one is followed, the right one is within reach of the covariance once it is followed beside it.
TEST(UndecidedStarts, HaveACovarianceThatReachesToRivals)
{
  constexpr double kWrong = 10.0;  // m
  constexpr double kSigmas = 3.0;
  FirstScans scans(slowlyTold(1, 14.0));
  int wrong = 0;
  for (int number = 0; number < 45; ++number) {
    const OdometryReport& report = scans.next();
    if (number >= 30) {
      const double reach = kSigmas * std::sqrt(report.covariance.topLeftCorner<3, 3>().trace());
      wrong += scans.wayError() > kWrong ? 1 : 0;
      EXPECT_TRUE(scans.wayError() < kWrong || scans.wayError() < reach) << number << ' ' << reach;
    }
  }
  EXPECT_GT(wrong, 10) << "the right one is followed";
}

/// By the sum of what points tell, cars that keep pace explain these scans so much better than the road does that its
/// motion, which is the right one, would be given up.
TEST(UndecidedStarts, AreNotDecidedByAConvoy)
{
  FirstScans scans(slowlyTold(12, 14.0));
  OdometryReport report;
  for (int number = 0; number < 110; ++number) {
    report = scans.next();
    EXPECT_TRUE(report.state != TrackingState::tracked || report.provisional || scans.motionError() < 0.5) << number;
  }
  EXPECT_EQ(report.state, TrackingState::tracked) << report.reason;
  EXPECT_FALSE(report.provisional);
}

/// Once one is left the poses before are corrected.
TEST(UndecidedStarts, AreSettledWhenOneMotionIsLeft)
{
  constexpr int kLong = 60;  // scans
  FirstScans scans(slowlyTold(3, 7.0));
  int undecided = 0;
  OdometryReport report;
  for (int number = 0; number < kLong; ++number) {
    report = scans.next();
    undecided += saysSeveralExplain(report) ? 1 : 0;
    EXPECT_TRUE(report.state != TrackingState::tracked || report.provisional || scans.motionError() < 0.3) << number;
  }
  EXPECT_GT(undecided, 5);
  EXPECT_EQ(report.state, TrackingState::tracked) << report.reason;
  EXPECT_LT(scans.greatestWayError(kFirst), 1.0);
}

/// The likeliest stays then.
TEST(UndecidedStarts, AreSettledByAPoseThatIsGiven)
{
  Simulation simulation(slowlyTold());
  Odometry<PointXYZIRT> odometry;
  for (std::size_t number = 0; number < 20; ++number) {
    odometry.track(simulation.sweep(number).cloud);
  }
  EXPECT_TRUE(saysSeveralExplain(odometry.report()));
  odometry.setPose(odometry.getPose());
  EXPECT_FALSE(saysSeveralExplain(odometry.track(simulation.sweep(20).cloud)));
}

/// Nothing tells two apart that have come to move alike, and nothing is to be told.
TEST(UndecidedStarts, EndWhereRivalsMoveAlike)
{
  SimulationOptions options = testWorld("open-road", "vlp16");
  options.seed = 8;
  constexpr int kEnd = 60;  // scans
  FirstScans scans(options);
  int undecided = 0;
  OdometryReport report;
  for (int number = 0; number < kEnd; ++number) {
    report = scans.next();
    undecided += saysSeveralExplain(report) ? 1 : 0;
  }
  EXPECT_GT(undecided, 0) << "no rivals here";
  EXPECT_EQ(report.state, TrackingState::tracked) << report.reason;
  EXPECT_LT(scans.greatestWayError(kEnd), 0.3);
}

/// Scans in which nothing is where it was fit none of the rivals; these are followed where it goes on.
TEST(UndecidedStarts, OutliveScansThatDoNotFit)
{
  Simulation simulation(slowlyTold(1, 14.0));
  Odometry<PointXYZIRT> odometry;
  constexpr float kAway = 60.0F;  // m, up
  int unfit = 0;
  for (std::size_t number = 0; number < 40; ++number) {
    Sweep sweep = simulation.sweep(number);
    if (number >= 20 && number < 28) {
      for (PointXYZIRT& point : sweep.cloud) {
        point.z += kAway;
      }
    }
    const OdometryReport& report = odometry.track(sweep.cloud);
    unfit += report.state == TrackingState::predicted ? 1 : 0;
    EXPECT_TRUE(number < 20 || report.state != TrackingState::tracked) << number;
  }
  EXPECT_GE(unfit, 6);
  EXPECT_TRUE(saysSeveralExplain(odometry.report())) << odometry.report().reason;
}

}  // namespace pcl_floam::simulator
