// Directions of motion that the clouds' surfaces do not hold: nothing slides along them, and the report says so.
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_floam::test {
namespace {

/// A square floor with noise of 1 cm, and a wall along x if there is one, about farOff().
Cloud::Ptr floorOf(unsigned seed, double half_side, bool wall, double noise = 0.01, int points = 4000)
{
  std::mt19937 random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < points; ++i) {
    Eigen::Vector3d p(uniform(random, half_side), uniform(random, half_side), uniform(random, noise));
    if (wall && i % 2 == 0) {
      p = Eigen::Vector3d(p.x(), half_side + p.z(), p.y() + half_side);
    }
    Point point;
    point.getVector3fMap() = (p + farOff()).cast<float>();
    cloud->push_back(point);
  }
  return cloud;
}

/// Half an ellipse with two legs and a head, 4 cm long and flat.
Cloud::Ptr turtle(unsigned seed)
{
  std::mt19937 random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  while (cloud->size() < 3000) {
    const double x = uniform(random, 0.025);
    const double y = uniform(random, 0.025);
    const bool shell = y > 0.0 && std::hypot(x / 0.018, y / 0.012) < 1.0;
    const bool leg = std::abs(y + 0.001) < 0.005 && (std::abs(x - 0.012) < 0.003 || std::abs(x + 0.01) < 0.003);
    const bool head = std::hypot(x - 0.02, y - 0.004) < 0.004;
    if (shell || leg || head) {
      Point point;
      point.getVector3fMap() = (Eigen::Vector3d(x, y, uniform(random, 1e-4)) + farOff()).cast<float>();
      cloud->push_back(point);
    }
  }
  return cloud;
}

struct Result {
  double before = 0.0;  ///< m; how far off the cloud was
  double after = 0.0;
  RegistrationReport report;
  Vector6 error;  ///< about the source's frame's origin
};

Result align(const Cloud::Ptr& sampled, const Cloud::Ptr& target, const Vector6& twist)
{
  const Eigen::Matrix4f truth = motionThere(exp(twist)).matrix<float>();
  auto source = pcl::make_shared<Cloud>();
  pcl::transformPointCloud(*sampled, *source, Eigen::Matrix4f(truth.inverse()));
  EdgePlaneRegistration<Point, Point> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output);
  EXPECT_TRUE(registration.hasConverged());
  const SE3 result(Eigen::Affine3d(registration.getFinalTransformation().cast<double>()));
  const SE3 error = result * SE3(Eigen::Affine3d(truth.cast<double>())).inverse();
  const SE3 there(Eigen::Matrix3d::Identity(), farOff());
  return {disagreement(*source, Eigen::Matrix4f::Identity(), truth),
          disagreement(*source, registration.getFinalTransformation(), truth), registration.report(),
          log(there.inverse() * error * there)};
}

/// How many standard deviations a result is off along each axis, at most.
double deviations(const Result& result)
{
  double most = 0.0;
  for (int i = 0; i < 3; ++i) {
    most = std::max(most, std::abs(result.error[i]) / std::sqrt(result.report.covariance(i, i)));
  }
  return most;
}

TEST(WeakDirections, ABareFloorDoesNotSlide)
{
  const Result result = align(floorOf(1, 8.0, false), floorOf(2, 8.0, false), Vector6::Zero());
  EXPECT_LT(result.after, 0.001);
  EXPECT_EQ(result.report.weak_directions.size(), 3U);
}

TEST(WeakDirections, NothingIsClaimedOfTheWaysAlongAFloor)
{
  const Vector6 twist = (Vector6() << 0.08, -0.06, 0.02, 0.01, -0.01, 0.05).finished();
  const Result result = align(floorOf(1, 2.0, false), floorOf(2, 2.0, false), twist);
  EXPECT_EQ(result.report.weak_directions.size(), 3U);
  EXPECT_LT(result.after, 1.05 * result.before);
  EXPECT_LT(deviations(result), 3.0);
  EXPECT_LT(std::abs(result.error[2]), 0.001);
}

TEST(WeakDirections, NothingIsClaimedOfTheWayAlongFloorAndWall)
{
  const Vector6 twist = (Vector6() << 0.08, -0.06, 0.02, 0.01, -0.01, 0.05).finished();
  const Result result = align(floorOf(1, 2.0, true), floorOf(2, 2.0, true), twist);
  ASSERT_EQ(result.report.weak_directions.size(), 1U);
  EXPECT_LT(result.after, 1.05 * result.before);
  EXPECT_LT(std::abs(result.error[0]), 3.0 * std::sqrt(result.report.covariance(0, 0)));
  EXPECT_GT(std::sqrt(result.report.covariance(0, 0)), 0.01);
  EXPECT_LT(std::abs(result.error[1]), 0.001);
  EXPECT_LT(std::abs(result.error[2]), 0.001);
}

TEST(WeakDirections, NoiseThatHidesASurfaceHoldsNoMotionAlongIt)
{
  // Many neighbourhoods are as thick as wide: each of these points seems to hold the pose in all directions.
  constexpr double kNoise = 0.02;  // m, of points 2.8 to 4 cm apart
  const Vector6 twist = (Vector6() << 0.08, -0.06, 0.02, 0.01, -0.01, 0.05).finished();
  for (const bool wall : {false, true}) {
    const auto cloud = [&](unsigned seed) { return floorOf(seed, 2.0, wall, wall ? 1.5 * kNoise : kNoise, 20000); };
    const Result result = align(cloud(1), cloud(2), twist);
    EXPECT_EQ(result.report.weak_directions.size(), wall ? 1U : 3U) << wall;
    EXPECT_LT(result.after, 1.05 * result.before) << wall;
    EXPECT_LT(std::abs(result.error[0]), 3.0 * std::sqrt(result.report.covariance(0, 0))) << wall;
    EXPECT_LT(std::abs(result.error[2]), 0.2 * kNoise) << wall;
  }
}

TEST(WeakDirections, AFlatCloudDoesNotGetWorseUnseen)
{
  for (const double turn : {0.05, 0.2}) {
    const Vector6 twist = (Vector6() << 0.001, -0.00075, 0.00025, 0.01, -0.01, turn).finished();
    const Result result = align(turtle(1), turtle(2), twist);
    EXPECT_LT(result.after, 1.05 * result.before) << turn;
    EXPECT_LT(deviations(result), 3.0) << turn;
    EXPECT_EQ(result.report.weak_directions.size(), 3U) << turn;
  }
}

}  // namespace
}  // namespace pcl_floam::test
