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

PreparedScan prepared(int k)
{
  const auto cloud = toCloud(sweepRoom(Room(), Lidar(), [k](double fraction) { return path(k + fraction); }));
  PreparedScan scan;
  scan.findStructure(viewOf(cloud), OdometryParameters(), 0.0);
  scan.takePoints(viewOf(cloud), OdometryParameters());
  return scan;
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
    const PreparedScan scan = prepared(k);
    const Tracker::Outcome outcome = tracker.step(scan.points, scan.edges, 1.0, scan.sweep_fraction);
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
    const PreparedScan scan = prepared(k);
    tracker.step(scan.points, scan.edges, 1.0, scan.sweep_fraction);
  }
  const SE3 before = tracker.track().pose().middle;
  std::vector<ScanPoint> far_off = prepared(4).points;
  for (ScanPoint& point : far_off) {
    point.x += 1000.0F;
  }
  EXPECT_FALSE(tracker.step(far_off, {}, 1.0, 1.0).registration.report.hasConverged());
  EXPECT_EQ(tracker.track().pose().middle.translation, before.translation);
  const PreparedScan scan = prepared(5);
  EXPECT_TRUE(tracker.step(scan.points, scan.edges, 2.0, scan.sweep_fraction).registration.report.hasConverged());
  EXPECT_LT(error(tracker.track().pose().middle, 5), 0.02);
}

TEST(Track, SweepsOfKnownPosesMakeAMapToGoOnFrom)
{
  SpatialSampling sampling;
  std::vector<Sweep> sweeps;
  std::vector<SE3> poses;
  double side = 0.0;
  for (int k = 0; k < 5; ++k) {
    const PreparedScan scan = prepared(k);
    side = side > 0.0 ? side : sampling.sideFor(scan.points, 2000);
    Sweep sweep;
    sampling.sample(scan.points, 0.3 * side, sweep.dense);
    sampling.sample(sweep.dense, side, sweep.sample);
    sweep.edges = scan.edges;
    sweeps.push_back(sweep);
    poses.push_back(path(0.5).inverse() * path(k + 0.5));
  }
  const Sweep last = sweeps.back();
  sweeps.pop_back();
  poses.pop_back();
  Track track({}, side);
  track.begin(sweeps, poses);
  EXPECT_TRUE(track.step(last).report.hasConverged());
  EXPECT_LT(error(track.pose().middle, 4), 0.01);

  // And backwards, with time running the other way.
  Track back({}, side);
  std::vector<Sweep> reversed = {last, sweeps[3]};
  for (Sweep& sweep : reversed) {
    sweep.fraction = -sweep.fraction;
  }
  back.begin(reversed, {path(0.5).inverse() * path(4.5), poses[3]});
  Sweep before = sweeps[2];
  before.fraction = -before.fraction;
  EXPECT_TRUE(back.step(before).report.hasConverged());
  EXPECT_LT(error(back.pose().middle, 2), 0.02);
}

}  // namespace pcl_floam::test
