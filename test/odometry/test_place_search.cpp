// Where a sweep is found whose points may be farther off than surfaces are apart.
#include "odometry/place_search.h"

#include "motion/motion_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pcl_floam {
namespace {

constexpr double kApart = 0.5;   // m, one shelf above the other
constexpr double kBeside = 4.0;  // m: there is the floor alone

/// Shelves that are all alike, and beside them the floor, which is not.
class Shelves : public SurfaceSearch {
public:
  [[nodiscard]] bool empty() const override { return false; }
  void find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const override
  {
    for (std::size_t i = 0; i < count; ++i) {
      Surface plane;
      plane.kind = SurfaceKind::plane;
      const bool is_floor = places[i].x() > kBeside;
      const double height = is_floor ? 0.0 : kApart * std::round(places[i].z() / kApart);
      plane.center = {places[i].x(), places[i].y(), height};
      plane.direction = Eigen::Vector3d::UnitZ();
      plane.thickness = 1e-6;
      plane.extent = 0.1;
      plane.count = 20;
      surfaces[i] = plane;
    }
  }
};

/// As a sensor sees them that is one shelf higher than it is supposed to be.
std::vector<ScanPoint> seenFromAbove()
{
  std::vector<ScanPoint> points;
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) {
      const auto x = static_cast<float>(0.3 * i);
      const double height = static_cast<double>(x) > kBeside ? 0.0 : kApart * ((i + 20) % 4);
      points.push_back({x, static_cast<float>(0.3 * k), static_cast<float>(height - kApart)});
      points.back().time = 0.5F;
    }
  }
  return points;
}

/// Of the height little is known, of all else much.
SurfaceProblem expectedBelow(const std::vector<ScanPoint>& points, const Shelves& shelves)
{
  SurfaceProblem expected;
  expected.scan = {&points, &shelves};
  Vector6 deviations = Vector6::Constant(1e-3);
  deviations[2] = 0.4;
  expected.guess_covariance = deviations.cwiseAbs2().asDiagonal();
  expected.prior.covariance.topLeftCorner<6, 6>() = expected.guess_covariance;
  return expected;
}

}  // namespace

TEST(RegisterAround, FindsTheLikeliestOfPlacesThatAreAlike)
{
  const Shelves shelves;
  const std::vector<ScanPoint> points = seenFromAbove();
  const SurfaceProblem expected = expectedBelow(points, shelves);
  const SurfaceRegistration alone = registerSurfaces(expected);
  ASSERT_TRUE(alone.report.hasConverged());
  EXPECT_NEAR(alone.report.target_T_source.translation.z(), 0.0, 0.2) << "it is found anyway";
  const SurfaceRegistration found = registerAround(expected, 0.5);
  ASSERT_TRUE(found.report.hasConverged());
  EXPECT_NEAR(found.report.target_T_source.translation.z(), kApart, 0.01);
}

TEST(RegisterAround, LeavesAloneWhatIsLocked)
{
  const Shelves shelves;
  const std::vector<ScanPoint> points = seenFromAbove();
  SurfaceProblem expected = expectedBelow(points, shelves);
  expected.locked[2] = true;
  EXPECT_EQ(registerAround(expected, 0.5).report.target_T_source.translation.z(), 0.0);
}

TEST(RegisterAround, OfNoPointsIsNoPose)
{
  const Shelves shelves;
  const std::vector<ScanPoint> none;
  const SurfaceRegistration found = registerAround(expectedBelow(none, shelves), 0.5);
  EXPECT_FALSE(found.report.hasConverged());
  EXPECT_TRUE(found.report.target_T_source.isFinite());
}

/// After a period a pose is off as far as its velocity was.
TEST(SweepPrior, TheVelocityFollowsThePose)
{
  MotionEstimate motion(SE3(), (Vector6() << 1.0, 0.0, 0.0, 0.0, 0.0, 0.2).finished());
  motion.predict(1.0);
  SweepPrior prior;
  prior.pose = motion.pose();
  prior.velocity = motion.velocity();
  prior.covariance = motion.covariance();
  const Vector6 off = (Vector6() << 0.0, 0.1, 0.0, 0.0, 0.0, 0.0).finished();
  const SweepPrior::State moved = prior.movedBy(off);
  EXPECT_LT((moved.pose.translation - prior.pose.translation - off.head<3>()).norm(), 1e-12);
  const Eigen::Vector3d faster = prior.pose.rotation * (moved.velocity - prior.velocity).head<3>();
  EXPECT_NEAR(faster.y(), 0.1, 0.02);
  EXPECT_EQ(prior.movedBy(Vector6::Zero()).pose.matrix(), prior.pose.matrix());
}

}  // namespace pcl_floam
