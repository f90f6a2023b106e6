// Registration with a sensor's own pattern: what holds a pose, and what only seems to.
#include "registration/held_information.h"
#include "registration/surface_registration.h"
#include "support/corner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace pcl_floam {
namespace {

constexpr double kAside = 2.0;         // m, from the way to wall and posts
constexpr double kPointSpacing = 0.4;  // m, of the scan's points
constexpr double kFarApart = 10.0;     // m, posts

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

SurfaceRegistration registered(double apart, double spacing, const PoseFactors* factors = nullptr)
{
  const Posts target(apart);
  const std::vector<ScanPoint> points = scanOf(apart);
  SurfaceProblem problem = test::problemOf(points, target);
  problem.spacing = spacing;
  problem.factors = factors;
  return registerSurfaces(problem);
}

double toldAlong(const SurfaceRegistration& registration)
{
  return std::sqrt(registration.told(0, 0));
}

TEST(HeldInformation, PostsHoldAPose)
{
  const SurfaceRegistration found = registered(kFarApart, kPointSpacing);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_TRUE(found.report.weak_directions.empty());
  EXPECT_LT(toldAlong(found), 0.05);
  EXPECT_NEAR(toldAlong(found), toldAlong(registered(kFarApart, 0.0)), 1e-9);
}

/// As rings on a wall, or the columns of a sensor that lies on its side.
TEST(HeldInformation, APatternThatIsTheSameAQuarterOfACellFartherDoesNot)
{
  const SurfaceRegistration found = registered(0.05, kPointSpacing);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_LT(toldAlong(registered(0.05, 0.0)), 0.05) << "it does not seem to";
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

TEST(HeldInformation, WhatIsKnownBesidesStays)
{
  const PoseFactors factors{{std::make_shared<Milestone>()}, SE3()};
  const SurfaceRegistration found = registered(0.05, kPointSpacing, &factors);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_TRUE(found.report.weak_directions.empty());
  EXPECT_NEAR(toldAlong(found), 0.01, 1e-3);
}

TEST(HeldInformation, TakesNothingFromOtherMotions)
{
  Matrix6 information = Matrix6::Identity() * 1e6;
  information(0, 0) = 1e4;
  const auto nothing = [](const Vector6& /*motion*/, double /*way*/) { return Pull(); };
  const HeldInformation held = heldInformation(information, {}, 0.1, nothing);
  ASSERT_EQ(held.not_held.size(), 1U);
  Matrix6 rest = information;
  rest(0, 0) = 0.0;
  EXPECT_LT((held.information - rest).norm(), 1e-3);
  DegreesOfFreedom locked = {};
  locked[0] = true;
  EXPECT_TRUE(heldInformation(information, locked, 0.1, nothing).not_held.empty()) << "it is not sought";
}

TEST(PullGrowth, IsAllOfWhatASpringPromises)
{
  constexpr double kStiffness = 7.0;
  constexpr double kOff = 0.02;  // m: the pose need not be where the pull ends
  const auto spring = [](double way) { return Pull{kStiffness * (way + kOff), kStiffness}; };
  EXPECT_NEAR(shareOfGrowth(spring(-0.1), spring(0.1), 0.1), 1.0, 1e-12);
  EXPECT_NEAR(shareOfGrowth(Pull{0.3, 2.0}, Pull{0.3, 5.0}, 0.1), 0.0, 1e-12);
}

}  // namespace
}  // namespace pcl_floam
