// Tracks and what is judged by their evidence, on sweeps of a furnished room.
#include "odometry/tracker.h"

#include "odometry/scan_preparation.h"
#include "support/synthetic_cloud.h"

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

SE3 path(double t)
{
  return exp(Vector6(t * (Vector6() << 0.3, 0.02, 0.0, 0.0, 0.0, 0.03).finished()));
}

struct Prepared {
  std::vector<ScanPoint> points;
  std::vector<ScanPoint> edges;
};

Prepared prepared(int k)
{
  const auto cloud = toCloud(sweepRoom(Room(), Lidar(), [k](double fraction) { return path(k + fraction); }));
  PreparedScan scan;
  scan.findStructure(viewOf(cloud), OdometryParameters(), 0.0);
  scan.takePoints(viewOf(cloud), OdometryParameters());
  scan.takeFeatures(viewOf(cloud), OdometryParameters());
  std::vector<ScanPoint> edges;
  scan.takeEdges(edges);
  return {scan.points, edges};
}

/// Takes a scan as the odometry does.
Tracker::Outcome step(Tracker& tracker, const Prepared& scan, double periods = 1.0)
{
  Sweep sweep;
  tracker.sample(scan.points, sweep);
  sweep.edges = scan.edges;
  sweep.periods = periods;
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
    const Prepared scan = prepared(k);
    const Tracker::Outcome outcome = step(tracker, scan);
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
    const Prepared scan = prepared(k);
    step(tracker, scan);
  }
  const SE3 before = tracker.track().pose().middle;
  Prepared far_off{prepared(4).points, {}};
  for (ScanPoint& point : far_off.points) {
    point.x += 1000.0F;
  }
  EXPECT_FALSE(step(tracker, far_off).registration.report.hasConverged());
  EXPECT_EQ(tracker.track().pose().middle.translation, before.translation);
  const Prepared scan = prepared(5);
  EXPECT_TRUE(step(tracker, scan, 2.0).registration.report.hasConverged());
  EXPECT_LT(error(tracker.track().pose().middle, 5), 0.02);
}

TEST(Track, SweepsOfKnownPosesMakeAMapToGoOnFrom)
{
  SpatialSampling sampling;
  std::vector<Sweep> sweeps;
  std::vector<SE3> poses;
  TrackSettings settings;
  for (int k = 0; k < 5; ++k) {
    const Prepared scan = prepared(k);
    settings.side = settings.side > 0.0 ? settings.side : sampling.sideFor(scan.points, 2000);
    Sweep sweep;
    sampling.sample(scan.points, 0.3 * settings.side, sweep.dense);
    sampling.sample(sweep.dense, settings.side, sweep.sample);
    sweep.edges = scan.edges;
    sweeps.push_back(sweep);
    poses.push_back(path(0.5).inverse() * path(k + 0.5));
  }
  const Sweep last = sweeps.back();
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
  back.begin(reversed, {path(0.5).inverse() * path(4.5), poses[3]}, {true, true});
  Sweep before = sweeps[2];
  before.fraction = -before.fraction;
  EXPECT_TRUE(back.step(before).report.hasConverged());
  EXPECT_LT(error(back.pose().middle, 2), 0.02);
}

}  // namespace pcl_floam::test
