// Clouds without rings, times and order: which way the head turned, and whether it did, shows as the sensor moves.

#include "simulator/test_world.h"

#include <pcl_floam/odometry/odometry.h>

#include <pcl/common/io.h>
#include <pcl/point_types.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

namespace pcl_floam::simulator {

namespace {

SimulationOptions simulated(const std::string& world, std::uint64_t seed)
{
  SimulationOptions options = testWorld(world);
  options.seed = seed;
  return options;
}

}  // namespace

enum class TimeRuns { with_the_clock, against_it, not_at_all };

struct Untold {
  TimeRuns runs;
  const char* world;
  std::uint64_t seed;
};

class UnknownTimes : public testing::TestWithParam<Untold> {
protected:
  static pcl::PointCloud<pcl::PointXYZ> bare(const Sweep& sweep, std::mt19937& random)
  {
    pcl::PointCloud<pcl::PointXYZ> cloud;
    for (std::size_t i = 0; i < sweep.cloud.size(); ++i) {
      const Eigen::Vector3f place = GetParam().runs == TimeRuns::not_at_all ? Eigen::Vector3f(sweep.exact_at_end[i])
                                                                            : sweep.cloud[i].getVector3fMap();
      cloud.emplace_back(place.x(), mirror() * place.y(), place.z());
    }
    std::shuffle(cloud.begin(), cloud.end(), random);
    return cloud;
  }

  /// In a mirror the head turns the other way.
  static SE3 seen(const SE3& pose)
  {
    const Eigen::Vector3d m(1.0, mirror(), 1.0);
    return {m.asDiagonal() * pose.rotation * m.asDiagonal(), m.asDiagonal() * pose.translation};
  }

private:
  static float mirror() { return GetParam().runs == TimeRuns::against_it ? -1.0F : 1.0F; }
};

TEST_P(UnknownTimes, AreToldByTheScans)
{
  constexpr std::size_t sweeps = 50;
  Simulation simulation(simulated(GetParam().world, GetParam().seed));
  std::mt19937 random(3);
  Odometry<PointXYZIRT> told;
  Odometry<pcl::PointXYZ> untold;
  SE3 world_T_first;
  double told_off = 0.0;
  double untold_off = 0.0;
  ScanTimingSource source = ScanTimingSource::automatic;
  for (std::size_t i = 0; i < sweeps; ++i) {
    const Sweep sweep = simulation.sweep(i);
    world_T_first = i == 0 ? sweep.world_T_end : world_T_first;
    const SE3 truth = world_T_first.inverse() * sweep.world_T_end;
    const SE3 pose = told.track(sweep.cloud, sweep.start_time).world_T_sensor;
    const OdometryReport& report = untold.track(bare(sweep, random), sweep.start_time);
    EXPECT_EQ(report.state, i == 0 ? TrackingState::initialized : TrackingState::tracked) << i << report.reason;
    source = report.timing_source;
    if (i >= sweeps / 2) {
      told_off = std::max(told_off, (pose.translation - truth.translation).norm());
      untold_off = std::max(untold_off, (report.world_T_sensor.translation - seen(truth).translation).norm());
    }
  }
  RecordProperty("told_m", std::to_string(told_off));
  RecordProperty("untold_m", std::to_string(untold_off));
  EXPECT_EQ(source, GetParam().runs == TimeRuns::not_at_all       ? ScanTimingSource::none
                    : GetParam().runs == TimeRuns::with_the_clock ? ScanTimingSource::clockwise
                                                                  : ScanTimingSource::counterclockwise);
  EXPECT_LT(untold_off, 1.5 * told_off + 0.005);
}

INSTANTIATE_TEST_SUITE_P(All, UnknownTimes,
                         testing::Values(Untold{TimeRuns::with_the_clock, "room", 41},
                                         Untold{TimeRuns::against_it, "room", 41},
                                         Untold{TimeRuns::not_at_all, "room", 41},
                                         Untold{TimeRuns::with_the_clock, "warehouse", 41}),
                         [](const auto& untold) {
                           const TimeRuns runs = untold.param.runs;
                           return untold.param.world + std::string(runs == TimeRuns::with_the_clock ? "WithTheClock"
                                                                   : runs == TimeRuns::against_it   ? "AgainstIt"
                                                                                                    : "NotAtAll");
                         });

/// It sees less than half a turn, and has no times.
TEST(FlashLidar, IsFoundToHaveNoSweep)
{
  SimulationOptions options = simulated("room", 43);
  options.sensor = "flash";
  Simulation simulation(options);
  Odometry<pcl::PointXYZ> odometry;
  SE3 world_T_first;
  double off = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    const Sweep sweep = simulation.sweep(i);
    pcl::PointCloud<pcl::PointXYZ> cloud;
    pcl::copyPointCloud(sweep.cloud, cloud);
    world_T_first = i == 0 ? sweep.world_T_middle : world_T_first;
    const OdometryReport& report = odometry.track(cloud, sweep.start_time);
    EXPECT_EQ(report.timing_source, ScanTimingSource::none) << i;
    off = std::max(
        off, ((world_T_first.inverse() * sweep.world_T_middle).translation - report.world_T_sensor.translation).norm());
  }
  EXPECT_LT(off, 0.03);
}

/// Whatever was found of sweeps without times holds for those alone.
TEST(TimesLostNowAndThen, CountWhereTheyAreThere)
{
  constexpr std::size_t half = 25;
  for (const bool begins_with_times : {true, false}) {
    Simulation simulation(simulated("room", 42));
    std::mt19937 random(3);
    Odometry<PointXYZIRT> odometry;
    SE3 world_T_first;
    double off = 0.0;
    for (std::size_t i = 0; i < 2 * half; ++i) {
      Sweep sweep = simulation.sweep(i);
      const bool has_times = (i < half) == begins_with_times;
      for (PointXYZIRT& point : sweep.cloud) {  // in a mirror, so that the head turns counterclockwise
        point.y = -point.y;
        point.time = has_times ? point.time : 0.0F;
        point.ring = has_times ? point.ring : 0;
      }
      if (!has_times) {
        std::shuffle(sweep.cloud.begin(), sweep.cloud.end(), random);
      }
      world_T_first = i == 0 ? sweep.world_T_end : world_T_first;
      const Eigen::Vector3d truth = (world_T_first.inverse() * sweep.world_T_end).translation;
      const OdometryReport& report = odometry.track(sweep.cloud, sweep.start_time);
      if (has_times) {
        EXPECT_EQ(report.timing_source, ScanTimingSource::time_field) << i;
      } else if (begins_with_times) {
        EXPECT_EQ(report.timing_source, ScanTimingSource::none) << i;
      }
      if (i >= 2 * half - 5) {
        off = std::max(off, (report.world_T_sensor.translation - truth.cwiseProduct(Eigen::Vector3d(1, -1, 1))).norm());
      }
    }
    EXPECT_LT(off, begins_with_times ? 0.15 : 0.03) << begins_with_times;  // a sweep's own motion is 0.1 m
  }
}

}  // namespace pcl_floam::simulator
