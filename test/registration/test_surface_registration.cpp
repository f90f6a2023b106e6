// Registration of points with surfaces: known motions, sweeps, locks, evidence, threads.
#include "registration/surface_registration.h"

#include "map/edge_lines.h"
#include "map/voxel_pyramid.h"
#include "registration/surface_residuals.h"
#include "support/constants.h"
#include "support/corner.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pcl_floam {

using test::Corner;
using test::problemOf;
using test::sweepOf;

namespace {

double distance(const SE3& a, const SE3& b)
{
  return log(a.inverse() * b).norm();
}

/// The same piece of surface wherever one looks, so far off.
class Everywhere : public SurfaceSearch {
public:
  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      surfaces[i] = surface;
      surfaces[i].center = places[i] + Eigen::Vector3d(off, 0.0, 0.0);
    }
  }

  Surface surface;
  double off = 0.0;
};

double evidenceIn(Everywhere& map, double off)
{
  map.off = off;
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  SurfaceProblem problem = problemOf(points, map);
  problem.evidence = Evidence::total;
  problem.locked = {true, true, true, true, true, true};
  return registerSurfaces(problem).evidence;
}

/// Of six posts, every 15 cm.
std::vector<Eigen::Vector3d> edgesOfPosts(double lowest, const Eigen::Vector3d& shift)
{
  std::vector<Eigen::Vector3d> edges;
  for (int post = 0; post < 6; ++post) {
    for (int i = 0; i < 20; ++i) {
      edges.push_back(shift + Eigen::Vector3d(2.0 + post % 3, 3.0 * (post / 3) - 1.5, lowest + 0.15 * i));
    }
  }
  return edges;
}

EdgeLines linesOf(const std::vector<Eigen::Vector3d>& edges)
{
  EdgeLines lines;
  lines.insert(edges.data(), edges.size());
  return lines;
}

}  // namespace

/// Lines of edges are kept while these stay: of one registration, not of the next.
TEST(SurfaceRegistration, EdgesHoldThePoseAndLeaveNothingToTheNextOne)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  const Corner corner(1);
  std::vector<ScanPoint> edges;
  for (const Eigen::Vector3d& p : edgesOfPosts(-1.4, Eigen::Vector3d::Zero())) {
    edges.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  SurfaceRoom room;
  for (const double aside : {0.03, -0.05, 0.0}) {
    const EdgeLines lines = linesOf(edgesOfPosts(-1.5, {0.0, aside, 0.0}));
    SurfaceProblem problem = problemOf(points, corner);
    problem.edges = {&edges, &lines};
    const SurfaceRegistration alone = registerSurfaces(problem);
    EXPECT_EQ(alone.report.edge_correspondences, static_cast<int>(edges.size()));
    EXPECT_NEAR(alone.report.target_T_source.translation.y(), aside, 1e-3);
    problem.room = &room;
    for (const int threads : {1, 4}) {
      problem.threads = threads;
      const SurfaceRegistration shared = registerSurfaces(problem);
      EXPECT_EQ(shared.report.target_T_source.matrix(), alone.report.target_T_source.matrix());
      EXPECT_EQ(shared.posterior, alone.posterior);
    }
  }
}

TEST(SurfaceRegistration, FindsAKnownPose)
{
  std::mt19937 random(8);
  for (int i = 0; i < 10; ++i) {
    const SE3 truth = exp(test::randomTwist(random, 0.3, 0.05));
    const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
    const Corner corner(3);
    const RegistrationReport report = registerSurfaces(problemOf(points, corner)).report;
    ASSERT_TRUE(report.hasConverged());
    EXPECT_LT(distance(report.target_T_source, truth), 1e-4);
  }
}

/// It is the next sweep's prior: what were left would grow from sweep to sweep, until the prior pushes away.
TEST(SurfaceRegistration, ThePosteriorIsSymmetricToTheBit)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  const Corner corner(3);
  const SurfaceRegistration found = registerSurfaces(problemOf(points, corner));
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_EQ(found.posterior, found.posterior.transpose());
}

TEST(SurfaceRegistration, FindsThePoseOfASweepAndItsMotionWithIt)
{
  std::mt19937 random(9);
  for (int i = 0; i < 10; ++i) {
    const SE3 truth = exp(test::randomTwist(random, 0.3, 0.05));
    const Vector6 twist = test::randomTwist(random, 0.3, 0.08);
    const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth, twist), 900);
    const Corner corner(3);
    SurfaceProblem problem = problemOf(points, corner);
    EXPECT_GT(distance(registerSurfaces(problem).report.target_T_source, truth), 1e-3)
        << "the sweep's motion must matter";
    problem.prior.fraction = 0.8;
    const SurfaceRegistration found = registerSurfaces(problem);
    EXPECT_LT(distance(found.report.target_T_source, truth), 3e-4);
    EXPECT_LT((found.report.sweep_twist - twist).norm(), 2e-3);
    EXPECT_LT((0.8 * found.velocity - twist).norm(), 2e-3);
  }
}

TEST(SurfaceRegistration, FindsTheAccelerationFromTheVelocityBefore)
{
  std::mt19937 random(10);
  const SE3 truth = exp(test::randomTwist(random, 0.3, 0.05));
  const Vector6 before = test::randomTwist(random, 0.2, 0.05);
  const Vector6 twist = test::randomTwist(random, 0.2, 0.05);
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth, twist, 0.5, 0.5 * (twist - before)), 900);
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.prior.fraction = 1.0;
  problem.prior.velocity_before = before;
  problem.prior.periods_between = 2.0;
  EXPECT_LT(distance(registerSurfaces(problem).report.target_T_source, truth), 3e-4);
  problem.prior.periods_between = 0.0;
  EXPECT_GT(distance(registerSurfaces(problem).report.target_T_source, truth), 6e-4) << "it must matter";
}

/// Where the velocity is known to follow the pose, a sweep without freedom of its own tells of it all the same.
TEST(SurfaceRegistration, TheVelocityFollowsThePoseAsThePriorHasIt)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.1, 0.05, 0.0));
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.placement = SweepPlacement::held;
  problem.prior.covariance.topRightCorner<6, 6>() = 0.05 * Matrix6(Matrix6::Identity());
  problem.prior.covariance.bottomLeftCorner<6, 6>() = 0.05 * Matrix6(Matrix6::Identity());
  const SurfaceRegistration found = registerSurfaces(problem);
  EXPECT_LT((found.velocity.head<3>() - 0.5 * truth.translation).norm(), 1e-3);
}

/// A laser that points a little elsewhere than it is said to misses a floor by the more the farther it is.
TEST(SurfaceRegistration, AFloorFarAwayTellsLessOfTheHeight)
{
  std::mt19937 random(12);
  const Corner floor(1);
  double near_information = 0.0;
  for (const double range : {4.0, 100.0}) {
    std::vector<ScanPoint> points(900);
    for (ScanPoint& point : points) {
      const double azimuth = test::uniform(random, test::kPi);
      point.x = static_cast<float>(range * std::cos(azimuth));
      point.y = static_cast<float>(range * std::sin(azimuth));
      point.z = static_cast<float>(Corner::kWall);
    }
    SurfaceProblem problem = problemOf(points, floor);
    problem.locked = {true, true, false, true, true, true};
    const double information = registerSurfaces(problem).report.information(2, 2);
    near_information = range < 10.0 ? information : near_information;
    EXPECT_TRUE(range < 10.0 || information < 0.2 * near_information) << information << " of " << near_information;
    EXPECT_GT(information, 0.0);
  }
}

TEST(SurfaceRegistration, LockedDegreesOfFreedomKeepTheGuess)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, -0.2, 0.1));
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.locked = kPlanarMotion;
  const RegistrationReport report = registerSurfaces(problem).report;
  EXPECT_EQ(report.target_T_source.translation.z(), 0.0);
  EXPECT_LT((report.target_T_source.translation - truth.translation).head<2>().norm(), 2e-3);
  EXPECT_EQ(report.covariance(2, 2), 0.0);
}

TEST(SurfaceRegistration, EvidenceIsHighestAtTheTruth)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, -0.2, 0.1));
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.evidence = Evidence::total;
  const double found = registerSurfaces(problem).evidence;
  problem.locked = {true, true, true, true, true, true};
  EXPECT_GT(found, registerSurfaces(problem).evidence + 100.0);
}

/// Else a map that has been smeared by a false motion, with something near everywhere, would be as good as a clear one.
TEST(SurfaceRegistration, WhatFillsItsCellIsNoEvidence)
{
  Everywhere map;
  map.surface.kind = SurfaceKind::point;
  map.surface.observability.setZero();
  EXPECT_NEAR(evidenceIn(map, 0.0), 0.0, 1e-9);
  EXPECT_NEAR(evidenceIn(map, 0.1), 0.0, 1e-9);
}

/// A density in as many dimensions as the surface tells.
TEST(SurfaceRegistration, WhatIsInOnePlaceTellsMoreThanWhatIsInOnePlane)
{
  Everywhere plane;
  plane.surface.kind = SurfaceKind::plane;
  plane.surface.direction = Eigen::Vector3d::UnitX();
  plane.surface.extent = 1.0;
  plane.surface.count = 100;
  Everywhere line;
  line.surface.kind = SurfaceKind::line;
  line.surface.direction = Eigen::Vector3d::UnitZ();
  Everywhere place;
  place.surface.kind = SurfaceKind::point;
  const double in_one_plane = evidenceIn(plane, 0.0);
  EXPECT_GT(in_one_plane, 0.0);
  EXPECT_NEAR(evidenceIn(line, 0.0) / in_one_plane, 2.0, 0.1);
  EXPECT_NEAR(evidenceIn(place, 0.0) / in_one_plane, 3.0, 0.1);
  EXPECT_LT(evidenceIn(place, 0.3), 0.0);  // and is less likely to be there if it is not
}

TEST(SurfaceRegistration, SomethingInTheWayDoesNotDrawThePose)
{
  std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  for (std::size_t i = 0; i < points.size(); i += 5) {  // a fifth lies 0.7 m off its wall
    points[i].x += 0.7F;
    points[i].y += 0.7F;
    points[i].z += 0.7F;
  }
  const Corner corner(3);
  EXPECT_LT(registerSurfaces(problemOf(points, corner)).report.target_T_source.translation.norm(), 2e-3);
}

TEST(SurfaceRegistration, ThreadsGiveTheSameBits)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(exp(Vector6::Constant(0.05))), 3000);
  VoxelPyramid map(0.3);
  for (const ScanPoint& point : points) {
    const Eigen::Vector3d place(point.x, point.y, point.z);
    const auto laser = static_cast<std::uint32_t>(point.time * 16.0F);
    map.insert(&place, &laser, 1);
  }
  SurfaceProblem problem = problemOf(points, map);
  problem.prior.pose.translation.x() = 0.1;
  const RegistrationReport one = registerSurfaces(problem).report;
  for (const int threads : {2, 3, 8}) {
    problem.threads = threads;
    const RegistrationReport other = registerSurfaces(problem).report;
    EXPECT_EQ(one.target_T_source.rotation, other.target_T_source.rotation);
    EXPECT_EQ(one.target_T_source.translation, other.target_T_source.translation);
    EXPECT_EQ(one.covariance, other.covariance);
  }
}

TEST(SurfaceRegistration, TellsWhenThereIsNothingToRegisterWith)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  const VoxelPyramid nothing(0.3);
  EXPECT_EQ(registerSurfaces(problemOf(points, nothing)).report.termination, Termination::empty_target);
  const std::vector<ScanPoint> few(points.begin(), points.begin() + 10);
  const Corner corner(3);
  EXPECT_EQ(registerSurfaces(problemOf(few, corner)).report.termination, Termination::too_few_correspondences);
}

}  // namespace pcl_floam
