// Registration of returns along straight runs: of a wall's columns, and of posts.
#include "support/constants.h"
#include "support/corner.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace pcl_floam {

using test::problemOf;

namespace {

using pcl_floam::test::kPi;

/// A wall's returns, one column beside the next, look like posts that stand where the sensor drew them.
class Columns : public SurfaceSearch {
public:
  explicit Columns(SurfaceKind kind) : kind_(kind) {}

  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
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

/// Along the scan line, or across it to the next ones.
using WhichRun = std::array<float, 3> ScanPoint::*;

/// What a sensor turned by a quarter sees of the columns if it is so far along them.
std::vector<ScanPoint> columnsSeen(SurfaceKind kind, double along, float run, WhichRun which)
{
  std::vector<ScanPoint> points(400);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].x = static_cast<float>(Columns::kWall);
    points[i].y = 10.0F - static_cast<float>(i % 20) + static_cast<float>(along);
    points[i].z = kind == SurfaceKind::line ? 0.1F * static_cast<float>(i / 20) : 0.0F;
    points[i].*which = {0.0F, run, 0.0F};
  }
  return points;
}

RegistrationReport registeredWithColumns(SurfaceKind kind, double along, float run, double prior,
                                         WhichRun which = &ScanPoint::run)
{
  const Columns target(kind);
  const std::vector<ScanPoint> points = columnsSeen(kind, along, run, which);
  SurfaceProblem problem = problemOf(points, target);
  problem.prior.pose.rotation = Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  problem.prior.covariance *= prior;
  problem.prior.pose_counts = true;
  problem.locked = {false, false, true, true, true, true};
  return registerSurfaces(problem).report;
}

}  // namespace

TEST(SurfaceRegistration, WhatLiesOnAStraightRunTellsHardlyAnythingAlongIt)
{
  for (const SurfaceKind kind : {SurfaceKind::line, SurfaceKind::point}) {
    const Matrix6 of_posts = registeredWithColumns(kind, 0.0, 0.0F, 1.0).information;
    EXPECT_GT(of_posts(0, 0), 0.5 * of_posts(1, 1));
    for (const WhichRun which : {&ScanPoint::run, &ScanPoint::run_across}) {
      const Matrix6 of_wall = registeredWithColumns(kind, 0.0, 5.0F, 1.0, which).information;
      EXPECT_LT(of_wall(0, 0), 1e-3 * of_posts(0, 0));
      EXPECT_NEAR(of_wall(1, 1), of_posts(1, 1), 1e-6 * of_posts(1, 1));
    }
  }
}

/// A short run, as of a post three returns wide, pulls as much as it tells, against a prior that counts about as much.
TEST(SurfaceRegistration, OfAShortRunPullAndInformationBelongTogether)
{
  constexpr double kOff = 0.01;  // m
  constexpr double kPrior = 3e-4;
  const RegistrationReport lines = registeredWithColumns(SurfaceKind::line, kOff, 0.1F, kPrior);
  const RegistrationReport points = registeredWithColumns(SurfaceKind::point, kOff, 0.1F, kPrior);
  ASSERT_TRUE(lines.hasConverged());
  ASSERT_TRUE(points.hasConverged());
  // Pulled by what was seen, held by what was known: each as strongly as its information says.
  const auto pull = [](const RegistrationReport& report) {
    const double moved = report.target_T_source.translation.x();
    EXPECT_GT(moved, 0.1 * kOff);
    EXPECT_LT(moved, 0.9 * kOff);
    return moved / (kOff - moved);
  };
  EXPECT_NEAR(pull(points) / pull(lines), points.information(0, 0) / lines.information(0, 0), 0.02);
}

}  // namespace pcl_floam
