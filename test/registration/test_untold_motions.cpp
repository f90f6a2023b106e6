// Registration where scans leave motions open: what becomes of the pose along these, and how they are named.
#include "registration/surface_registration.h"
#include "support/corner.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace pcl_floam {

using test::Corner;
using test::problemOf;
using test::sweepOf;

TEST(SurfaceRegistration, WhatCannotBeSeenGetsNoInformationAndKeepsTheGuess)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, -0.2, 0.1));
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
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
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
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

namespace {

/// Of a bare floor, which leaves open two ways and a turn.
SurfaceProblem onAFloor(const std::vector<ScanPoint>& points)
{
  static const Corner floor(1);
  SurfaceProblem problem = problemOf(points, floor);
  problem.prior.pose_counts = true;
  return problem;
}

/// Knows how far the sensor has gone one way.
class OneWay : public PoseFactor {
public:
  explicit OneWay(const Vector6& motion) : motion_(motion) {}

  void addTo(const SE3& /*target_T_source*/, PoseEquations& equations) const override
  {
    equations.add(0.0, motion_, 1e-4);
  }

private:
  Vector6 motion_;
};

/// The directions' parts of a motion, squared: 1 if they span it, 0 if they are at right angles to it.
double share(const std::vector<WeakDirection>& directions, const Vector6& motion)
{
  double share = 0.0;
  for (const WeakDirection& weak : directions) {
    share += std::pow(weak.direction.dot(motion), 2);
  }
  return share;
}

/// Cells of a floor whose normals are off as the noise of their points makes them: they pull along the floor.
class NoisyFloor : public SurfaceSearch {
public:
  NoisyFloor()
  {
    std::mt19937 random(21);
    for (Eigen::Vector2d& tilt : tilts_) {
      tilt = {test::uniform(random, kMostTilt), test::uniform(random, kMostTilt)};
    }
  }

  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      surfaces[i] = Surface();
      if (std::abs(places[i].z() - Corner::kWall) > 1.0) {
        continue;
      }
      const Eigen::Vector2d cell = places[i].head<2>().array().floor();
      const auto number = static_cast<std::size_t>(cell.x() + 16.0 * cell.y() + 1024.0) % tilts_.size();
      surfaces[i].kind = SurfaceKind::plane;
      surfaces[i].center << cell.array() + 0.5, Corner::kWall;
      surfaces[i].direction = Eigen::Vector3d(tilts_[number].x(), tilts_[number].y(), 1.0).normalized();
      surfaces[i].thickness = kThickness;
      surfaces[i].extent = kExtent;
      surfaces[i].count = kCount;
    }
  }

private:
  static constexpr int kCount = 20;
  static constexpr double kThickness = 4e-4;  // m^2
  static constexpr double kExtent = 1.0 / 12.0;
  static constexpr double kMostTilt = 0.027;  // rad; the root of thickness / (count extent) in the mean
  std::array<Eigen::Vector2d, 509> tilts_;
};

/// A point wherever three numbers are whole.
class Lattice : public SurfaceSearch {
public:
  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      surfaces[i] = Surface();
      surfaces[i].kind = SurfaceKind::point;
      surfaces[i].center = places[i].array().round();
      surfaces[i].count = 20;
    }
  }
};

}  // namespace

/// Against what is known otherwise, or told by surfaces, they count for less than their residuals say.
TEST(UntoldMotions, NearestPointsTellSomeByChance)
{
  std::vector<ScanPoint> points;
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      for (const int axis : {0, 1, 2}) {
        Eigen::Vector3f place(static_cast<float>(i), static_cast<float>(j), 3.0F);
        std::swap(place[2], place[axis]);
        points.emplace_back();
        points.back().x = place.x();
        points.back().y = place.y();
        points.back().z = place.z();
      }
    }
  }
  const Lattice lattice;
  const SurfaceRegistration found = registerSurfaces(problemOf(points, lattice));
  ASSERT_TRUE(found.report.hasConverged());
  constexpr double kOfEach = 0.02;  // m, of each
  const double as_residuals = static_cast<double>(points.size()) / (kOfEach * kOfEach);
  EXPECT_LT(found.report.information(0, 0), 0.9 * as_residuals);
  EXPECT_GT(found.report.information(0, 0), 0.5 * as_residuals);
}

/// Also a first motion, of which nothing else is known than where it is looked for.
TEST(UntoldMotions, NoiseDoesNotMoveThePoseAlongThem)
{
  const SE3 truth(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.0, 0.0, 0.1));
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(truth), 900);
  const NoisyFloor floor;
  SurfaceProblem problem = problemOf(points, floor);
  problem.prior.pose.translation.x() = 0.3;
  for (const bool counts : {true, false}) {
    problem.prior.pose_counts = counts;
    const RegistrationReport report = registerSurfaces(problem).report;
    ASSERT_TRUE(report.hasConverged());
    EXPECT_NEAR(report.target_T_source.translation.x(), 0.3, 1e-3) << counts;
    EXPECT_NEAR(report.target_T_source.translation.z(), 0.1, 0.01) << counts;
  }
}

TEST(UntoldMotions, AreNamedAtRightAngles)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  const std::vector<WeakDirection> weak = registerSurfaces(onAFloor(points)).report.weak_directions;
  ASSERT_EQ(weak.size(), 3U);
  for (std::size_t i = 0; i < weak.size(); ++i) {
    for (std::size_t j = 0; j < weak.size(); ++j) {
      EXPECT_NEAR(weak[i].direction.dot(weak[j].direction), i == j ? 1.0 : 0.0, 1e-9);
    }
  }
  for (const int motion : {0, 1, 5}) {
    EXPECT_NEAR(share(weak, Vector6::Unit(motion)), 1.0, 1e-3) << motion;
  }
}

/// Somebody else tells of a way that is none of those that come out first.
TEST(UntoldMotions, WhatAFactorTellsOfIsNotNamedAndNothingElse)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  const Vector6 told = (Vector6::Unit(0) + 2.0 * Vector6::Unit(1)) / std::sqrt(5.0);
  const Vector6 across = (2.0 * Vector6::Unit(0) - Vector6::Unit(1)) / std::sqrt(5.0);
  const PoseFactors factors{{std::make_shared<OneWay>(told)}, SE3()};
  SurfaceProblem problem = onAFloor(points);
  problem.factors = &factors;
  const std::vector<WeakDirection> weak = registerSurfaces(problem).report.weak_directions;
  ASSERT_EQ(weak.size(), 2U);
  EXPECT_NEAR(share(weak, told), 0.0, 1e-3);
  EXPECT_NEAR(share(weak, across), 1.0, 1e-3);
  EXPECT_NEAR(share(weak, Vector6::Unit(5)), 1.0, 1e-3);
}

TEST(UntoldMotions, WhatIsLockedIsNotNamed)
{
  const std::vector<ScanPoint> points = sweepOf(SweepTrajectory(SE3()), 900);
  SurfaceProblem problem = onAFloor(points);
  problem.locked = {false, true, false, false, false, true};
  const std::vector<WeakDirection> weak = registerSurfaces(problem).report.weak_directions;
  ASSERT_EQ(weak.size(), 1U);
  EXPECT_NEAR(share(weak, Vector6::Unit(0)), 1.0, 1e-3);
}

}  // namespace pcl_floam
