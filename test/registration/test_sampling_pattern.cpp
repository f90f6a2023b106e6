// Registration with a sensor's own pattern: what holds a pose, and what only seems to.
#include "registration/sampling_pattern.h"
#include "registration/surface_registration.h"
#include "support/corner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace pcl_floam {
namespace {

constexpr double kAside = 2.0;      // m, from the way to wall and posts
constexpr double kFarApart = 10.0;  // m, posts
constexpr double kNear = 0.05;      // m, posts that are as near to each other as a sensor's columns are

/// A floor, a wall to the left, and posts to the right, so many metres apart.
class Posts : public SurfaceSearch {
public:
  explicit Posts(double apart) : apart_(apart) {}

  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Surface& surface = surfaces[i] = Surface();
      const bool is_post = places[i].y() < -0.9 * kAside;
      surface.kind = is_post ? SurfaceKind::line : SurfaceKind::plane;
      surface.extent = surface.width = 100.0;
      surface.count = 1000;
      surface.wide = Eigen::Vector3d::UnitX();
      if (is_post) {
        surface.center = {std::round(places[i].x() / apart_) * apart_, -kAside, 0.0};
        surface.direction = Eigen::Vector3d::UnitZ();
      } else if (places[i].y() > 0.9 * kAside) {
        surface.center = {0.0, kAside, 0.0};
        surface.direction = Eigen::Vector3d::UnitY();
      } else {
        surface.direction = Eigen::Vector3d::UnitZ();
      }
    }
  }

private:
  double apart_;
};

std::vector<ScanPoint> scanOf(double apart)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> along(-20.0F, 20.0F);
  std::uniform_real_distribution<float> across(-1.0F, 1.0F);
  std::vector<ScanPoint> points(600);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ScanPoint& point = points[i];
    point.x = along(random);
    if (i % 20 == 0) {
      point.x = static_cast<float>(std::round(point.x / apart) * apart);
      point.y = static_cast<float>(-kAside);
    } else {
      point.y = i % 2 == 0 ? static_cast<float>(kAside) : across(random);
    }
    point.z = i % 2 == 0 ? across(random) : 0.0F;
  }
  return points;
}

SurfaceRegistration registered(double apart, bool looks_for_patterns, const PoseFactors* factors = nullptr)
{
  const Posts target(apart);
  const std::vector<ScanPoint> points = scanOf(apart);
  SurfaceProblem problem = test::problemOf(points, target);
  problem.looks_for_patterns = looks_for_patterns;
  problem.factors = factors;
  return registerSurfaces(problem);
}

double toldAlong(const SurfaceRegistration& registration)
{
  return std::sqrt(registration.told(0, 0));
}

TEST(SamplingPattern, IsNotWhatPostsAre)
{
  const SurfaceRegistration found = registered(kFarApart, true);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_TRUE(found.report.weak_directions.empty());
  EXPECT_LT(toldAlong(found), 0.05);
  EXPECT_NEAR(toldAlong(found), toldAlong(registered(kFarApart, false)), 1e-9);
}

/// As rings on a wall, or the columns of a sensor that lies on its side.
TEST(SamplingPattern, HoldsNoPose)
{
  const SurfaceRegistration found = registered(kNear, true);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_LT(toldAlong(registered(kNear, false)), 0.05) << "it does not seem to";
  EXPECT_GT(toldAlong(found), 10.0);
  EXPECT_LT(std::sqrt(found.told(1, 1)), 1e-3 * toldAlong(found)) << "across";
  ASSERT_EQ(found.report.weak_directions.size(), 1U);
  EXPECT_NEAR(std::abs(found.report.weak_directions.front().direction[0]), 1.0, 0.01);
  EXPECT_EQ(found.report.weak_directions.front().eigenvalue, 0.0);
}

/// A place on the way, to a centimetre.
class Milestone : public PoseFactor {
public:
  void addTo(const SE3& target_T_source, PoseEquations& equations) const override
  {
    constexpr double kVariance = 1e-4;  // m^2
    equations.add(target_T_source.translation.x(), Vector6::Unit(0), kVariance);
  }
};

TEST(SamplingPattern, WhatIsKnownBesidesStays)
{
  const PoseFactors factors{{std::make_shared<Milestone>()}, SE3()};
  const SurfaceRegistration found = registered(kNear, true, &factors);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_TRUE(found.report.weak_directions.empty());
  EXPECT_NEAR(toldAlong(found), 0.01, 1e-3);
}

/// Of which the first of some motions is held, and as much as all others promise it.
PullsWhenMoved heldAlong(const Vector6& held)
{
  return [held](const TriedMotions& motions, const Vector6& moved) {
    const Eigen::Vector3d along = motions.transpose() * held;
    return Pulls{1e4 * along * held.dot(moved), 1e4 * motions.leftCols(3).transpose() * motions};
  };
}

/// Whichever axes are tried.
TEST(SamplingPattern, IsWhereNothingPullsAndNowhereElse)
{
  Matrix6 information = 1e6 * Matrix6(Matrix6::Identity());
  information.topLeftCorner<3, 3>() = Eigen::Vector3d(1e4, 1e4, 1e6).asDiagonal();
  information(0, 4) = information(4, 0) = 3e4;  // whoever goes on nods
  for (const double turn : {0.0, 0.3, 0.8}) {
    Vector6 direction = Vector6::Zero();
    direction.head<2>() = Eigen::Vector2d(std::cos(turn), std::sin(turn));
    const Motions motions = motionsToldByPattern(information, {}, heldAlong(direction));
    ASSERT_EQ(motions.cols(), 1) << turn;
    const Vector6 motion = motions.col(0);
    EXPECT_NEAR(motion.head<3>().norm(), 1.0, 1e-9);
    EXPECT_NEAR(motion.dot(direction), 0.0, 1e-6) << turn;
    const Matrix6 left = propagated(apartFrom(motions, Matrix6::Identity(), information).transpose(), information);
    EXPECT_LT((left * motion).norm(), 1e-6) << turn;
    EXPECT_NEAR(left(2, 2), information(2, 2), 1e-6);
    EXPECT_GT(direction.dot(left * direction), 0.9e4);
  }
}

TEST(SamplingPattern, IsNotLookedForInWhatIsLockedOrKnownWell)
{
  const PullsWhenMoved nothing = [](const TriedMotions& /*motions*/, const Vector6& /*moved*/) { return Pulls(); };
  Matrix6 information = 1e6 * Matrix6(Matrix6::Identity());
  EXPECT_EQ(motionsToldByPattern(information, {}, nothing).cols(), 0);
  information(0, 0) = 1e4;
  EXPECT_EQ(motionsToldByPattern(information, {}, nothing).cols(), 1);
  const PullsWhenMoved not_a_number = [](const TriedMotions& /*motions*/, const Vector6& /*moved*/) {
    return Pulls{Eigen::Vector3d::Constant(std::nan("")), Eigen::Matrix3d::Constant(std::nan(""))};
  };
  const Motions motions = motionsToldByPattern(information, {}, not_a_number);
  EXPECT_EQ(motions.cols(), 1);
  EXPECT_TRUE(motions.allFinite());
  EXPECT_EQ(motionsToldByPattern(information, {true, false, false, false, false, false}, nothing).cols(), 0);
}

/// However it was looked for, and whatever was projected out before: nothing is taken out twice.
TEST(SamplingPattern, IsTakenOutOnce)
{
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    Matrix6 root;
    for (Eigen::Index k = 0; k < root.size(); ++k) {
      root.data()[k] = normal(random);
    }
    const Matrix6 information = root * root.transpose();
    Motions motions = Motions::Zero(6, 1 + i % 3);
    motions.topRows(motions.cols()).setIdentity();
    Matrix6 onto = Matrix6::Identity();
    onto(0, 0) = i % 2 == 0 ? 1.0 : 0.0;  // told by nothing
    const Matrix6 once = apartFrom(motions, onto, information);
    EXPECT_LT((apartFrom(motions, once, information) - once).norm(), 1e-6 * once.norm()) << i;
    EXPECT_LT((once * motions).norm(), 1e-6 * once.norm()) << i;
  }
}

/// Posts pull the pose to the nearest of them, whatever is expected; unless others than the scans have told of the
/// motion, and it is only posts.
TEST(SamplingPattern, YieldsToAHint)
{
  constexpr double kHinted = 0.015;  // m along the way, where no post is
  const Posts target(kNear);
  const std::vector<ScanPoint> points = scanOf(kNear);
  for (const double hint : {0.0, 0.01, 100.0}) {  // m, one standard deviation; 0: there is none
    const bool has_hint = hint > 0.0 && hint < 1.0;
    SurfaceProblem problem = test::problemOf(points, target);
    problem.looks_for_patterns = true;
    problem.prior.pose.translation.x() = kHinted;
    problem.prior.pose_counts = true;
    problem.prior.hinted = (hint > 0.0 ? 1.0 / (hint * hint) : 0.0) * Matrix6::Identity();
    const SurfaceRegistration found = registerSurfaces(problem);
    ASSERT_TRUE(found.report.hasConverged());
    EXPECT_NEAR(found.report.target_T_source.translation.x(), has_hint ? kHinted : 0.0, 3e-3);
    EXPECT_LT(found.report.target_T_source.translation.tail<2>().norm(), 1e-3);
    EXPECT_NEAR(found.posterior(0, 0) / problem.prior.covariance(0, 0), has_hint ? 1.0 : 0.0, 0.1);
  }
}

/// The trial leaves nothing behind.
TEST(SamplingPattern, ChangesNothingElse)
{
  const std::vector<ScanPoint> points = scanOf(kNear);
  const Posts target(kNear);
  SurfaceProblem problem = test::problemOf(points, target);
  problem.edges = problem.scan;
  problem.evidence = Evidence::of_points;
  const SurfaceRegistration plain = registerSurfaces(problem);
  problem.looks_for_patterns = true;
  for (const int threads : {1, 2, 3}) {
    problem.threads = threads;
    const SurfaceRegistration tried = registerSurfaces(problem);
    EXPECT_EQ(tried.report.weak_directions.size(), 1U);
    EXPECT_EQ(tried.report.target_T_source.translation, plain.report.target_T_source.translation);
    EXPECT_EQ(tried.evidence, plain.evidence);
    EXPECT_EQ(tried.point_evidence, plain.point_evidence);
    EXPECT_EQ(tried.posterior, plain.posterior);
  }
}

}  // namespace
}  // namespace pcl_floam
