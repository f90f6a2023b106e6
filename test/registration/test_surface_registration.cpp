// Registration of points with surfaces: known motions, sweeps, what cannot be seen, threads.
#include "registration/surface_registration.h"

#include "map/voxel_pyramid.h"
#include "registration/sweep_points.h"
#include "support/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pcl_floam {

namespace {

/// Two walls and a floor about the origin as functions of the place: exact, with no sampling of their own.
class Corner : public SurfaceSearch {
public:
  explicit Corner(int walls) : walls_(walls) {}

  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, const std::uint32_t* /*lasers*/, std::size_t count,
            Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      surfaces[i] = Surface();
      for (int axis = 2; axis > 2 - walls_; --axis) {
        if (std::abs(places[i][axis] - kWall) < 1.0) {
          surfaces[i].kind = SurfaceKind::plane;
          surfaces[i].direction = Eigen::Vector3d::Unit(axis);
          surfaces[i].center = places[i];
          surfaces[i].center[axis] = kWall;
          surfaces[i].extent = 0.1;
          surfaces[i].count = 20;
        }
      }
    }
  }

  static constexpr double kWall = -4.0;  // m, on each axis

private:
  int walls_;
};

/// Points on the three walls of a corner, seen by a sensor that moves.
std::vector<ScanPoint> sweepOf(const MovingSensor& sensor, std::size_t count)
{
  std::mt19937 random(6);
  std::vector<ScanPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d place(test::uniform(random, 2.5), test::uniform(random, 2.5), test::uniform(random, 2.5));
    place[static_cast<int>(i % 3)] = Corner::kWall;
    points[i].time = static_cast<float>(i) / static_cast<float>(count);
    // What the sensor measures is the place seen from its pose of that moment.
    const double u = MovingSensor::sinceMiddle(points[i]);
    ScanPoint probe = points[i];
    Eigen::Vector3d seen = sensor.pose().inverse() * place;
    for (int iteration = 0; iteration < 20; ++iteration) {
      probe.x = static_cast<float>(seen.x());
      probe.y = static_cast<float>(seen.y());
      probe.z = static_cast<float>(seen.z());
      seen += sensor.pose().inverse() * place - sensor.undistorted(probe);
    }
    EXPECT_LE(std::abs(u), 0.5);
    points[i].x = static_cast<float>(seen.x());
    points[i].y = static_cast<float>(seen.y());
    points[i].z = static_cast<float>(seen.z());
  }
  return points;
}

SurfaceProblem problemOf(const std::vector<ScanPoint>& points, const SurfaceSearch& target)
{
  SurfaceProblem problem;
  problem.scan = {&points, &target};
  problem.reach = 0.1 * Matrix6(Matrix6::Identity());
  problem.prior.covariance = 0.1 * Matrix12(Matrix12::Identity());
  problem.prior.pose_counts = false;
  return problem;
}

double distance(const SE3& a, const SE3& b)
{
  return log(a.inverse() * b).norm();
}

}  // namespace

TEST(MovingSensor, IsTheExponentialOfTheTwist)
{
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    const SE3 pose = exp(test::randomTwist(random, 5.0, 2.0));
    const Vector6 twist = test::randomTwist(random, 2.0, 0.4);
    const Vector6 acceleration = test::randomTwist(random, 0.4, 0.1);
    const MovingSensor sensor(pose, twist, acceleration);
    const ScanPoint point{static_cast<float>(test::uniform(random, 20.0)),      3.0F, -1.0F,
                          static_cast<float>(0.5 + test::uniform(random, 0.5)), 0,    -1};
    const double u = MovingSensor::sinceMiddle(point);
    const SE3 at = pose * exp(u * twist + 0.5 * u * u * acceleration);
    const Eigen::Vector3d expected = at * Eigen::Vector3d(point.x, point.y, point.z);
    EXPECT_LT((sensor.at(point) - expected).norm(), 2e-4);
  }
}

TEST(SurfaceRegistration, FindsAKnownPose)
{
  std::mt19937 random(8);
  for (int i = 0; i < 10; ++i) {
    const SE3 truth = exp(test::randomTwist(random, 0.3, 0.05));
    const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth), 900);
    const Corner corner(3);
    const RegistrationReport report = registerSurfaces(problemOf(points, corner)).report;
    ASSERT_TRUE(report.hasConverged());
    EXPECT_LT(distance(report.target_T_source, truth), 1e-4);
  }
}

TEST(SurfaceRegistration, FindsThePoseOfASweepAndItsMotionWithIt)
{
  std::mt19937 random(9);
  for (int i = 0; i < 10; ++i) {
    const SE3 truth = exp(test::randomTwist(random, 0.3, 0.05));
    const Vector6 twist = test::randomTwist(random, 0.3, 0.08);
    const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth, twist), 900);
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
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth, twist, 0.5 * (twist - before)), 900);
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
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth), 900);
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.placement = SweepPlacement::held;
  problem.prior.covariance.topRightCorner<6, 6>() = 0.05 * Matrix6(Matrix6::Identity());
  problem.prior.covariance.bottomLeftCorner<6, 6>() = 0.05 * Matrix6(Matrix6::Identity());
  const SurfaceRegistration found = registerSurfaces(problem);
  EXPECT_LT((found.velocity.head<3>() - 0.5 * truth.translation).norm(), 1e-3);
}

TEST(SurfaceRegistration, WhatCannotBeSeenGetsNoInformationAndKeepsTheGuess)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, -0.2, 0.1));
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth), 900);
  const Corner floor(1);
  SurfaceProblem problem = problemOf(points, floor);
  problem.prior.pose_counts = true;
  const RegistrationReport report = registerSurfaces(problem).report;
  ASSERT_TRUE(report.hasConverged());
  EXPECT_NEAR(report.target_T_source.translation.z(), 0.1, 1e-3);
  EXPECT_NEAR(report.target_T_source.translation.x(), 0.0, 1e-3);
  EXPECT_NEAR(report.information(0, 0), 0.0, 1e-11 * report.information(2, 2));
  EXPECT_NEAR(report.information(5, 5), 0.0, 1e-11 * report.information(3, 3));
  EXPECT_NEAR(report.covariance(0, 0), 0.1, 0.02);
  EXPECT_LT(report.covariance(2, 2), 1e-4);
}

/// It is expected that whoever goes on goes up, by a slope that is a matter of noise: seen is that the sensor is higher
/// than was expected, and that says nothing of how far it has gone.
TEST(SurfaceRegistration, WhatIsSeenDoesNotMoveThePoseAlongWhatIsNot)
{
  constexpr double kUnseen = 1.0;  // m, standard deviation
  constexpr double kSlope = 0.02;
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.0, 0.02));
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth), 900);
  const Corner corridor(2);  // along x
  SurfaceProblem problem = problemOf(points, corridor);
  problem.prior.pose_counts = true;
  problem.prior.covariance = 1e-6 * Matrix12(Matrix12::Identity());
  const Eigen::Vector3d along(kUnseen, 0.0, kUnseen * kSlope);
  problem.prior.covariance.topLeftCorner<3, 3>() += along * along.transpose();
  const RegistrationReport report = registerSurfaces(problem).report;
  ASSERT_TRUE(report.hasConverged());
  EXPECT_NEAR(report.target_T_source.translation.z(), 0.02, 2e-3);
  EXPECT_NEAR(report.target_T_source.translation.x(), 0.0, 0.01 * kUnseen);
  EXPECT_NEAR(std::sqrt(report.covariance(0, 0)), kUnseen, 0.1 * kUnseen);
}

/// A wall's returns, one column beside the next, look like posts that stand where the sensor drew them.
class Columns : public SurfaceSearch {
public:
  explicit Columns(SurfaceKind kind) : kind_(kind) {}

  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, const std::uint32_t* /*lasers*/, std::size_t count,
            Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      surfaces[i] = Surface();
      surfaces[i].kind = kind_;
      surfaces[i].center = {std::round(places[i].x()), kWall, 0.0};
      if (kind_ == SurfaceKind::line) {
        surfaces[i].direction = Eigen::Vector3d::UnitZ();
        surfaces[i].extent = 0.1;
      }
      surfaces[i].count = 20;
    }
  }

  static constexpr double kWall = 2.0;  // m, aside

private:
  SurfaceKind kind_;
};

/// What a sensor turned by a quarter sees of the columns if it is so far along them.
std::vector<ScanPoint> columnsSeen(SurfaceKind kind, double along, float run)
{
  std::vector<ScanPoint> points(400);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].x = static_cast<float>(Columns::kWall);
    points[i].y = 10.0F - static_cast<float>(i % 20) + static_cast<float>(along);
    points[i].z = kind == SurfaceKind::line ? 0.1F * static_cast<float>(i / 20) : 0.0F;
    points[i].run = {0.0F, run, 0.0F};
  }
  return points;
}

RegistrationReport registeredWithColumns(SurfaceKind kind, double along, float run, double prior)
{
  const Columns target(kind);
  const std::vector<ScanPoint> points = columnsSeen(kind, along, run);
  SurfaceProblem problem = problemOf(points, target);
  problem.prior.pose.rotation = Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  problem.prior.covariance *= prior;
  problem.prior.pose_counts = true;
  problem.locked = {false, false, true, true, true, true};
  return registerSurfaces(problem).report;
}

TEST(SurfaceRegistration, WhatLiesOnAStraightRunTellsHardlyAnythingAlongIt)
{
  for (const SurfaceKind kind : {SurfaceKind::line, SurfaceKind::point}) {
    const Matrix6 of_posts = registeredWithColumns(kind, 0.0, 0.0F, 1.0).information;
    const Matrix6 of_wall = registeredWithColumns(kind, 0.0, 5.0F, 1.0).information;
    EXPECT_GT(of_posts(0, 0), 0.5 * of_posts(1, 1));
    EXPECT_LT(of_wall(0, 0), 1e-3 * of_posts(0, 0));
    EXPECT_NEAR(of_wall(1, 1), of_posts(1, 1), 1e-6 * of_posts(1, 1));
  }
}

/// A short run, as of a post three returns wide, pulls as much as it tells: against a prior that counts about as much
/// lines and points come to the same pose.
TEST(SurfaceRegistration, OfAShortRunPullAndInformationBelongTogether)
{
  constexpr double kOff = 0.01;  // m
  constexpr double kPrior = 3e-4;
  const RegistrationReport lines = registeredWithColumns(SurfaceKind::line, kOff, 0.1F, kPrior);
  const RegistrationReport points = registeredWithColumns(SurfaceKind::point, kOff, 0.1F, kPrior);
  ASSERT_TRUE(lines.hasConverged());
  ASSERT_TRUE(points.hasConverged());
  const double moved = lines.target_T_source.translation.x();
  EXPECT_GT(moved, 0.1 * kOff);
  EXPECT_LT(moved, 0.9 * kOff);
  EXPECT_NEAR(points.target_T_source.translation.x(), moved, 0.02 * kOff);
  EXPECT_NEAR(points.information(0, 0), lines.information(0, 0), 0.01 * lines.information(0, 0));
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
      const double azimuth = test::uniform(random, M_PI);
      point.x = static_cast<float>(range * std::cos(azimuth));
      point.y = static_cast<float>(range * std::sin(azimuth));
      point.z = static_cast<float>(Corner::kWall);
    }
    SurfaceProblem problem = problemOf(points, floor);
    problem.locked = {true, true, false, true, true, true};
    const double information = registerSurfaces(problem).report.information(2, 2);
    if (range < 10.0) {
      near_information = information;
    }
    EXPECT_TRUE(range < 10.0 || information < 0.2 * near_information) << information << " of " << near_information;
    EXPECT_GT(information, 0.0);
  }
}

TEST(SurfaceRegistration, LockedDegreesOfFreedomKeepTheGuess)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, -0.2, 0.1));
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth), 900);
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
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(truth), 900);
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.wants_evidence = true;
  const double found = registerSurfaces(problem).evidence;
  problem.locked = {true, true, true, true, true, true};
  EXPECT_GT(found, registerSurfaces(problem).evidence + 100.0);
}

/// A road that fits a little better elsewhere must not outvote the few points that tell of the way along it.
TEST(SurfaceRegistration, WhatTellsOfTheOpenDirectionIsTheEvidence)
{
  constexpr double kAlong = 0.5;
  constexpr double kRough = 0.03;
  std::vector<ScanPoint> points = sweepOf(MovingSensor(SE3()), 900);
  points.erase(
      std::remove_if(points.begin(), points.end(), [](const ScanPoint& p) { return p.x < -3.9F && p.time > 0.1F; }),
      points.end());  // few of the wall ahead are left
  const Corner corner(3);
  SurfaceProblem problem = problemOf(points, corner);
  problem.wants_evidence = true;
  problem.locked = {true, true, true, true, true, true};
  const auto evidenceAt = [&](double x, double z, const Eigen::Vector3d& open) {
    problem.prior.pose.translation = {x, 0.0, z};
    problem.open = open;
    return registerSurfaces(problem).evidence;
  };
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  EXPECT_LT(evidenceAt(0.0, kRough, Eigen::Vector3d::Zero()), evidenceAt(kAlong, 0.0, Eigen::Vector3d::Zero()));
  EXPECT_GT(evidenceAt(0.0, kRough, ahead), evidenceAt(kAlong, 0.0, ahead));
}

TEST(SurfaceRegistration, SomethingInTheWayDoesNotDrawThePose)
{
  std::vector<ScanPoint> points = sweepOf(MovingSensor(SE3()), 900);
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
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(exp(Vector6::Constant(0.05))), 3000);
  VoxelPyramid map(0.3);
  for (const ScanPoint& point : points) {
    map.insert({point.x, point.y, point.z}, static_cast<std::uint32_t>(point.time * 16.0F));
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
  const std::vector<ScanPoint> points = sweepOf(MovingSensor(SE3()), 900);
  const VoxelPyramid nothing(0.3);
  EXPECT_EQ(registerSurfaces(problemOf(points, nothing)).report.termination, Termination::empty_target);
  const std::vector<ScanPoint> few(points.begin(), points.begin() + 10);
  const Corner corner(3);
  EXPECT_EQ(registerSurfaces(problemOf(few, corner)).report.termination, Termination::too_few_correspondences);
}

}  // namespace pcl_floam
