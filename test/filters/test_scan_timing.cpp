// When within the sweep a point was measured.
#include "common/azimuth.h"
#include "common/pi.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/core/scan_timing.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace pcl_floam::test {
namespace {

Lidar smallLidar(bool clockwise = true, double start_azimuth = kPi)
{
  Lidar lidar;
  lidar.rings = 16;
  lidar.columns = 360;
  lidar.clockwise = clockwise;
  lidar.start_azimuth = start_azimuth;
  return lidar;
}

ScanTiming timingOf(const CloudView& cloud, ScanTimingSource source = ScanTimingSource::automatic)
{
  ScanLines lines;
  findScanLines(cloud, SensorModel(), ScanLineSource::automatic, lines);
  return findScanTiming(cloud, lines, source);
}

/// Largest difference between the told and the true fraction of the sweep.
double worstError(const ScanTiming& timing, const CloudView& cloud, const std::vector<Return>& returns)
{
  double worst = 0.0;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    worst = std::max(worst, std::abs(static_cast<double>(timing.at(cloud, i)) - returns[i].fraction));
  }
  return worst;
}

/// A cloud whose time field holds `first + fraction * sweep` in units of its own.
template <typename T>
pcl::PCLPointCloud2 cloudWithTimes(const std::vector<Return>& returns, const std::string& name, double first,
                                   double sweep)
{
  std::vector<T> times;
  for (const Return& r : returns) {
    times.push_back(static_cast<T>(first + r.fraction * sweep));
  }
  return CloudBuilder().positions(returns).field(name, times).build();
}

TEST(Azimuth, InTurnsIsThatOfTheStandardLibrary)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-0.5 * kTwoPi, 0.5 * kTwoPi);
  std::uniform_real_distribution<double> exponent(-3.0, 3.0);
  for (int i = 0; i < 100000; ++i) {
    const double range = std::pow(10.0, exponent(random));
    const double azimuth = angle(random);
    const auto x = static_cast<float>(range * std::cos(azimuth));
    const auto y = static_cast<float>(range * std::sin(azimuth));
    const double expected = std::atan2(static_cast<double>(y), static_cast<double>(x)) / kTwoPi;
    const double difference = static_cast<double>(azimuthInTurns(x, y)) - expected;
    ASSERT_LT(std::abs(difference - std::round(difference)), 1e-7) << x << ' ' << y;
    ASSERT_GE(azimuthInTurns(x, y), 0.0F);
    ASSERT_LE(azimuthInTurns(x, y), 1.0F);
  }
  EXPECT_EQ(azimuthInTurns(0.0F, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(azimuthInTurns(0.0F, 2.0F), 0.25F);
  EXPECT_FLOAT_EQ(azimuthInTurns(-2.0F, 0.0F), 0.5F);
  EXPECT_FLOAT_EQ(azimuthInTurns(0.0F, -2.0F), 0.75F);
}

struct TimeField {
  const char* what;
  pcl::PCLPointCloud2 (*make)(const std::vector<Return>&, const std::string&, double, double);
  const char* name;
  double first;
  double sweep;
  double tolerance;
};

TEST(ScanTiming, FromTimeFieldsOfEveryUnitAndType)
{
  const auto returns = sweepRoom(Room(), smallLidar());
  const TimeField fields[] = {
      {"float s after the start", cloudWithTimes<float>, "time", 0.0, 0.1, 1e-5},
      {"float s before the end", cloudWithTimes<float>, "time", -0.1, 0.1, 1e-5},
      {"float us", cloudWithTimes<float>, "time", 0.0, 1e5, 1e-5},
      {"uint32 ns", cloudWithTimes<std::uint32_t>, "t", 0.0, 1e8, 1e-5},
      {"uint32 us", cloudWithTimes<std::uint32_t>, "offset_time", 0.0, 1e5, 1e-4},
      {"float64 s since 1970", cloudWithTimes<double>, "timestamp", 1.7e9, 0.1, 1e-4},
      {"float64 ns since boot", cloudWithTimes<double>, "timestamp", 5e12, 1e8, 1e-5},
      {"float64 ms", cloudWithTimes<double>, "time_stamp", 3e6, 100.0, 1e-5},
  };
  for (const TimeField& field : fields) {
    const auto cloud = field.make(returns, field.name, field.first, field.sweep);
    const ScanTiming timing = timingOf(viewOf(cloud));
    EXPECT_EQ(timing.source, ScanTimingSource::time_field) << field.what;
    EXPECT_NEAR(timing.duration, 0.1, 1e-4) << field.what;
    EXPECT_LT(worstError(timing, viewOf(cloud), returns), field.tolerance) << field.what;
  }
}

/// When a sweep ended, by the clock of its stamp.
TEST(ScanTiming, TellsWhenAPoseIsByTheStampsClock)
{
  const auto returns = sweepRoom(Room(), smallLidar());
  const auto endOf = [&](const pcl::PCLPointCloud2& cloud, double stamp) {
    return stamp + timingOf(viewOf(cloud)).sinceStamp(1.0, stamp);
  };
  const double stamp = 1.7e9;
  EXPECT_NEAR(endOf(cloudWithTimes<float>(returns, "time", 0.0, 0.1), stamp), stamp + 0.1, 1e-5);
  EXPECT_NEAR(endOf(cloudWithTimes<float>(returns, "time", -0.1, 0.1), stamp), stamp, 1e-5);
  EXPECT_NEAR(endOf(cloudWithTimes<double>(returns, "timestamp", stamp - 0.04, 0.1), stamp), stamp + 0.06, 1e-5);
  EXPECT_NEAR(endOf(cloudWithTimes<double>(returns, "timestamp", 5e12, 1e8), stamp), stamp + 0.1, 1e-5);
  for (const double young : {0.0, 0.1, 3.0, 9.9, 10.1}) {  // a simulation's, which begins at zero
    EXPECT_NEAR(endOf(cloudWithTimes<double>(returns, "timestamp", young, 0.1), young), young + 0.1, 1e-5) << young;
    EXPECT_NEAR(endOf(cloudWithTimes<float>(returns, "time", 0.0, 0.1), young), young + 0.1, 1e-5) << young;
  }
  EXPECT_EQ(timingOf(viewOf(cloudWithTimes<float>(returns, "time", 0.0, 0.0))).sinceStamp(1.0, stamp), 0.0);
}

/// A camera of light: what it sees from side to side takes no time.
TEST(ScanTiming, WhatSeesLessThanHalfATurnNeedNotTurn)
{
  const auto sweep = sweepRoom(Room(), smallLidar());
  const auto third = static_cast<std::ptrdiff_t>(sweep.size() / 3);
  const auto cloud = cloudWithTimes<float>({sweep.begin() + third, sweep.begin() + 2 * third}, "time", 0.0, 0.0);
  EXPECT_EQ(timingOf(viewOf(cloud)).source, ScanTimingSource::none);
  EXPECT_EQ(timingOf(viewOf(cloud), ScanTimingSource::azimuth).source, ScanTimingSource::azimuth);
}

/// Such a cloud's order tells which way the head turns, but not when.
TEST(ScanTiming, PointsMayBeStoredChannelByChannel)
{
  const auto sweep = sweepRoom(Room(), smallLidar());
  constexpr std::size_t kChannels = 16;
  auto returns = sweep;
  returns.clear();
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    for (std::size_t i = channel; i < sweep.size(); i += kChannels) {
      returns.push_back(sweep[i]);
    }
  }
  const auto cloud = cloudWithTimes<float>(returns, "time", 0.0, 0.0);
  const ScanTiming timing = timingOf(viewOf(cloud));
  ASSERT_EQ(timing.source, ScanTimingSource::azimuth);
  std::size_t off = 0;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    off += std::abs(static_cast<double>(timing.at(viewOf(cloud), i)) - returns[i].fraction) > 0.02 ? 1 : 0;
  }
  EXPECT_LT(off, returns.size() / 20) << "but where the sweep closes";
}

TEST(ScanTiming, AllThreadsFindTheSame)
{
  const auto returns = sweepRoom(Room(), smallLidar());
  const auto cloud = cloudWithTimes<double>(returns, "timestamp", 1.7e9, 0.1);
  const ScanTiming one = timingOf(viewOf(cloud));
  for (const int threads : {2, 3, 30}) {
    const ScanTiming timing = findScanTiming(viewOf(cloud), {}, ScanTimingSource::automatic, threads);
    EXPECT_EQ(timing.start, one.start);
    EXPECT_EQ(timing.duration, one.duration);
    EXPECT_EQ(timing.seconds_per_unit, one.seconds_per_unit);
  }
}

TEST(ScanTiming, ATimeFieldLeftAtZeroIsNone)
{
  const auto returns = sweepRoom(Room(), smallLidar());
  const auto cloud = cloudWithTimes<float>(returns, "time", 0.0, 0.0);
  EXPECT_EQ(timingOf(viewOf(cloud)).source, ScanTimingSource::azimuth);
  EXPECT_EQ(timingOf(viewOf(cloud), ScanTimingSource::time_field).source, ScanTimingSource::none);
}

TEST(ScanTiming, ATimeThatIsNotFiniteIsTheSweepsEnd)
{
  const auto returns = sweepRoom(Room(), smallLidar());
  auto cloud = toCloud(returns);
  cloud[17].time = std::numeric_limits<float>::quiet_NaN();
  const ScanTiming timing = timingOf(viewOf(cloud));
  EXPECT_EQ(timing.source, ScanTimingSource::time_field);
  EXPECT_EQ(timing.at(viewOf(cloud), 17), 1.0F);
  EXPECT_NEAR(timing.at(viewOf(cloud), cloud.size() / 2), 0.5, 0.01);
}

TEST(ScanTiming, MissingFirstReturnsDoNotShiftRelativeTimes)
{
  auto returns = sweepRoom(Room(), smallLidar());
  returns.erase(returns.begin(), returns.begin() + 16 * 60);
  const auto cloud = toCloud(returns);
  EXPECT_LT(worstError(timingOf(viewOf(cloud)), viewOf(cloud), returns), 1e-5);
}

TEST(ScanTiming, AViewOfAThirdOfTheTurnDoesNotWaver)
{
  const auto sweep = sweepRoom(Room(), smallLidar());
  const std::size_t third = sweep.size() / 3;
  constexpr std::size_t kFew = 16 * 3;  // columns at either end that once are there and once are not
  std::vector<double> starts;
  for (const auto& [from, to] : {std::make_pair(third - kFew, 2 * third + kFew), {third + kFew, 2 * third - kFew}}) {
    const auto cloud =
        toCloud({sweep.begin() + static_cast<std::ptrdiff_t>(from), sweep.begin() + static_cast<std::ptrdiff_t>(to)});
    starts.push_back(timingOf(viewOf(cloud)).start);
  }
  EXPECT_NEAR(starts[0], starts[1], 0.003);
  EXPECT_NEAR(starts[0], 0.033, 0.003);
}

TEST(ScanTiming, FromTheColumnsOfAnOrganisedCloud)
{
  auto returns = sweepRoom(Room(), smallLidar());
  std::stable_sort(returns.begin(), returns.end(), [](const Return& a, const Return& b) { return a.ring > b.ring; });
  auto cloud = toPositions(returns);
  cloud.width = 360;
  cloud.height = 16;
  const ScanTiming timing = timingOf(viewOf(cloud));
  EXPECT_EQ(timing.source, ScanTimingSource::columns);
  EXPECT_LT(worstError(timing, viewOf(cloud), returns), 1e-5);
}

TEST(ScanTiming, TheDirectionOfRotationIsMeasured)
{
  for (const bool clockwise : {true, false}) {
    for (const double start_azimuth : {kPi, 0.0, 0.5 * kPi, -2.0}) {
      const auto returns = sweepRoom(Room(), smallLidar(clockwise, start_azimuth));
      const auto cloud = toPositions(returns);
      const ScanTiming timing = timingOf(viewOf(cloud));
      EXPECT_EQ(timing.source, ScanTimingSource::azimuth);
      EXPECT_EQ(timing.clockwise, clockwise);
      EXPECT_LT(worstError(timing, viewOf(cloud), returns), 0.006) << clockwise << ' ' << start_azimuth;
    }
  }
}

TEST(ScanTiming, KittisFilesAreSweptClockwiseFromTheRear)
{
  auto returns = sweepRoom(Room(), smallLidar());
  const auto azimuth = [](const Return& r) {
    return std::fmod(std::atan2(r.point.y(), r.point.x()) + 2.0 * kPi, 2.0 * kPi);
  };
  std::sort(returns.begin(), returns.end(), [&](const Return& a, const Return& b) {
    return a.ring != b.ring ? a.ring > b.ring : azimuth(a) < azimuth(b);
  });
  const auto cloud = toPositions(returns);
  const ScanTiming timing = timingOf(viewOf(cloud));
  EXPECT_EQ(timing.source, ScanTimingSource::azimuth);
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const double expected = 0.5 - std::atan2(returns[i].point.y(), returns[i].point.x()) / (2.0 * kPi);
    EXPECT_NEAR(timing.at(viewOf(cloud), i), expected, 1e-5);
  }
  EXPECT_LT(worstError(timing, viewOf(cloud), returns), 0.006);

  const ScanTiming told = timingOf(viewOf(cloud), ScanTimingSource::counterclockwise);
  EXPECT_NEAR(told.at(viewOf(cloud), 100), 1.0 - timing.at(viewOf(cloud), 100), 1e-5);
}

TEST(ScanTiming, ASortedCloudTellsNoTimeUnlessTheRotationIsGiven)
{
  auto returns = sweepRoom(Room(), smallLidar());
  std::mt19937 random(1);
  std::shuffle(returns.begin(), returns.end(), random);
  const auto cloud = toPositions(returns);
  const ScanTiming timing = timingOf(viewOf(cloud));
  EXPECT_EQ(timing.source, ScanTimingSource::none);
  EXPECT_EQ(timing.at(viewOf(cloud), 5), 1.0F);
  const ScanTiming given = timingOf(viewOf(cloud), ScanTimingSource::clockwise);
  EXPECT_LT(worstError(given, viewOf(cloud), returns), 0.006);
}

TEST(ScanTiming, NoneCanBeAskedFor)
{
  const auto cloud = toCloud(sweepRoom(Room(), smallLidar()));
  EXPECT_FALSE(timingOf(viewOf(cloud), ScanTimingSource::none).valid());
  EXPECT_FALSE(timingOf(viewOf(pcl::PointCloud<pcl::PointXYZ>())).valid());
}

}  // namespace
}  // namespace pcl_floam::test
