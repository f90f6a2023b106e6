// Tracks and what is judged by their evidence, on sweeps of a furnished room.
#include "odometry/tracker.h"

#include "odometry/scan_preparation.h"
#include "support/synthetic_cloud.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace pcl_floam::test {
namespace {

SE3 path(double t)
{
  return exp(Vector6(t * (Vector6() << 0.3, 0.02, 0.0, 0.0, 0.0, 0.03).finished()));
}

pcl::PointCloud<PointXYZIRT> scanOf(int k)
{
  return toCloud(sweepRoom(Room(), Lidar(), [k](double fraction) { return path(k + fraction); }));
}

/// A scan as the odometry takes it.
Sweep sweepOf(const pcl::PointCloud<PointXYZIRT>& cloud, Tracker& tracker)
{
  const CloudView view = viewOf(cloud);
  PreparedScan scan;
  scan.findStructure(view, OdometryParameters(), 0.0);
  scan.takeFeatures(view, OdometryParameters());
  Sweep sweep;
  tracker.sample(scan.returnsOf(view, OdometryParameters()), sweep);
  scan.takeEdges(sweep.edges);
  return sweep;
}

Tracker::Outcome step(Tracker& tracker, const Sweep& sweep)
{
  const Tracker::Outcome outcome = tracker.step(sweep);
  tracker.updateMap(sweep);
  return outcome;
}

double error(const SE3& pose, int k)
{
  const SE3 truth = path(0.5).inverse() * path(k + 0.5);
  return (pose.translation - truth.translation).norm();
}

}  // namespace

TEST(Tracker, FollowsAMotionThatItFindsFromTwoSweeps)
{
  Tracker tracker({});
  for (int k = 0; k < 8; ++k) {
    const Tracker::Outcome outcome = step(tracker, sweepOf(scanOf(k), tracker));
    EXPECT_EQ(outcome.registration.report.hasConverged(), k > 0);
    EXPECT_EQ(tracker.isTracking(), k > 0);
    if (k > 0) {
      EXPECT_LT(error(tracker.track().pose().middle, k), 0.02) << k;
    }
  }
}

TEST(Tracker, ASweepThatFitsNothingChangesNothing)
{
  Tracker tracker({});
  for (int k = 0; k < 4; ++k) {
    step(tracker, sweepOf(scanOf(k), tracker));
  }
  const SE3 before = tracker.track().pose().middle;
  Sweep far_off = sweepOf(scanOf(4), tracker);
  far_off.edges.clear();
  for (std::vector<ScanPoint>* points : {&far_off.dense, &far_off.sample}) {
    for (ScanPoint& point : *points) {
      point.x += 1000.0F;
    }
  }
  EXPECT_FALSE(step(tracker, far_off).registration.report.hasConverged());
  EXPECT_EQ(tracker.track().pose().middle.translation, before.translation);
  Sweep later = sweepOf(scanOf(5), tracker);
  later.periods = 2.0;
  EXPECT_TRUE(step(tracker, later).registration.report.hasConverged());
  EXPECT_LT(error(tracker.track().pose().middle, 5), 0.02);
}

/// The memory of a map that has held another sweep makes no difference.
TEST(TrackMap, OneThatHasServedBeforeIsAsANewOne)
{
  const auto spare = std::make_shared<SpareMaps>();
  TrackSettings settings;
  settings.side = 0.2;
  Tracker tracker(settings);
  const Sweep sweep = sweepOf(scanOf(3), tracker);
  TrackMap fresh(settings);
  fresh.insert(sweep, {});
  settings.spare_maps = spare;
  const SurfaceSearch* memory = nullptr;
  {
    TrackMap before(settings);
    before.insert(sweepOf(scanOf(0), tracker), {path(2.0)});
    memory = &before.space();
  }
  TrackMap again(settings);
  ASSERT_EQ(&again.space(), memory);
  again.insert(sweep, {});
  const std::size_t count = sweep.dense.size();
  std::vector<Eigen::Vector3d> places;
  for (const ScanPoint& point : sweep.dense) {
    places.emplace_back(point.x + 0.05, point.y, point.z + 0.02);
  }
  for (const auto part : {&TrackMap::space, &TrackMap::edges}) {
    std::vector<Surface> found(count);
    std::vector<Surface> expected(count);
    (again.*part)().find(places.data(), count, found.data());
    (fresh.*part)().find(places.data(), count, expected.data());
    std::size_t surfaces = 0;
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(found[i].kind, expected[i].kind);
      ASSERT_EQ(found[i].center, expected[i].center);
      ASSERT_EQ(found[i].direction, expected[i].direction);
      surfaces += found[i].kind != SurfaceKind::unknown ? 1 : 0;
    }
    EXPECT_GT(surfaces, count / 20);
  }
}

TEST(Track, SweepsOfKnownPosesMakeAMapToGoOnFrom)
{
  std::vector<Sweep> sweeps;
  std::vector<SweepPose> poses;
  TrackSettings settings;
  settings.side = 0.2;
  Tracker tracker(settings);
  for (int k = 0; k < 5; ++k) {
    sweeps.push_back(sweepOf(scanOf(k), tracker));
    poses.push_back({path(0.5).inverse() * path(k + 0.5), log(path(k).inverse() * path(k + 1))});
  }
  const Sweep last = sweeps.back();
  const SweepPose last_pose = poses.back();
  sweeps.pop_back();
  poses.pop_back();
  Track track(settings);
  track.begin(sweeps, poses, keyframesAmong(poses, settings));
  EXPECT_TRUE(track.step(last).report.hasConverged());
  EXPECT_LT(error(track.pose().middle, 4), 0.01);

  // And backwards, with time running the other way.
  Track back(settings);
  std::vector<Sweep> reversed = {last, sweeps[3]};
  for (Sweep& sweep : reversed) {
    sweep.fraction = -sweep.fraction;
  }
  back.begin(reversed, {last_pose, poses[3]}, {true, true});
  Sweep before = sweeps[2];
  before.fraction = -before.fraction;
  EXPECT_TRUE(back.step(before).report.hasConverged());
  EXPECT_LT(error(back.pose().middle, 2), 0.02);
}

/// Where the pattern is another in each sweep, a sensor at rest sees more and more, which makes up its map: else
/// motions that compete would explain the more, the more they move.
TEST(Track, AtRestAMapTakesInWhatAPatternHasNotShown)
{
  TrackSettings settings;
  settings.side = 0.2;
  Tracker tracker(settings);
  Sweep sweep = sweepOf(toCloud(sweepRoom(Room(), Lidar(), [](double) { return SE3(); })), tracker);
  for (const bool is_new : {false, true}) {
    for (const bool has_own_rule : {false, true}) {
      sweep.is_pattern_new = is_new;
      settings.components.is_keyframe = {};
      if (has_own_rule) {
        settings.components.is_keyframe = [](const SE3&, const SE3&) { return false; };
      }
      Track track(settings);
      ASSERT_TRUE(track.begin(sweep, sweep, {Vector6::Zero(), 0.25}).report.hasConverged());
      for (const Rivals rivals : {Rivals::motions, Rivals::none}) {
        ASSERT_TRUE(track.step(sweep, rivals).report.hasConverged());
        EXPECT_EQ(track.isKeyframe(), is_new && rivals == Rivals::motions && !has_own_rule);
      }
    }
  }
}

/// A scan between smooth walls, which has its rings nowhere in particular.
pcl::PointCloud<PointXYZIRT> betweenWalls(const SE3& world_T_sensor, std::mt19937& random)
{
  Room passage;
  passage.walls = {{-60.0, -1.5, -1.7}, {60.0, 1.7, 1.5}};
  passage.furniture.clear();
  Lidar lidar;
  lidar.lowest += std::uniform_real_distribution<double>(0.0, 2.0)(random);  // degrees
  std::normal_distribution<double> noise(0.0, 0.01);                         // m
  std::vector<Return> returns = sweepRoom(passage, lidar, [&](double) { return world_T_sensor; });
  for (Return& r : returns) {
    r.point *= 1.0 + noise(random) / r.point.norm();
  }
  return toCloud(returns);
}

/// Two sweeps there tell of all but the way along the walls.
TEST(Track, WhatTwoSweepsDoNotTellOfStaysAsItIsOrRests)
{
  constexpr double kAlong = 0.3;  // m, as the search has it
  std::mt19937 random(1);
  const SE3 away = exp((Vector6() << 0.2, 0.05, 0.0, 0.0, 0.0, 0.03).finished());
  TrackSettings settings;
  settings.side = 0.2;
  Tracker tracker(settings);
  Sweep first = sweepOf(betweenWalls(SE3(), random), tracker);
  Sweep second = sweepOf(betweenWalls(away, random), tracker);
  for (Sweep* sweep : {&first, &second}) {
    sweep->edges.clear();
    sweep->fraction = 0.0;
  }
  FirstLook look;
  look.velocity[0] = kAlong;
  look.far = 0.25;
  look.rounds = 2;
  for (const bool rests : {false, true}) {
    look.rests = rests;
    const SurfaceRegistration found = Track(settings).begin(first, second, look);
    ASSERT_TRUE(found.report.hasConverged());
    ASSERT_EQ(found.report.weak_directions.size(), 1U);
    const SE3& moved = found.report.target_T_source;
    EXPECT_NEAR(moved.translation.x(), rests ? 0.0 : kAlong, 0.01);
    EXPECT_NEAR(moved.translation.y(), away.translation.y(), 0.01) << "of this they tell";
    EXPECT_NEAR(logSO3(moved.rotation).z(), 0.03, 0.002);
  }
}

}  // namespace pcl_floam::test
