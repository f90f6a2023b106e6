// Laws of the registration of two clouds.
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point, double>;

/// Typical distance of neighbouring points of sampledObject(seed, 1.0).
constexpr double kSpacing = 0.025;

struct Result {
  bool converged = false;
  Eigen::Matrix4d transform;
  RegistrationReport report;
};

Result align(const Cloud::Ptr& source, const Cloud::Ptr& target,
             const Eigen::Matrix4d& guess = Eigen::Matrix4d::Identity(), unsigned threads = 1)
{
  Registration registration;
  registration.setNumberOfThreads(threads);
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output, guess);
  return {registration.hasConverged(), registration.getFinalTransformation(), registration.report()};
}

Cloud::Ptr moved(const Cloud& cloud, const Eigen::Matrix4d& motion)
{
  auto result = pcl::make_shared<Cloud>();
  pcl::transformPointCloud(cloud, *result, motion);
  return result;
}

Cloud::Ptr awayFromTruth(double scale = 1.0)
{
  return moved(*sampledObject(2, scale), motion(scale).cast<double>().inverse());
}

double difference(const Cloud& cloud, const Eigen::Matrix4d& a, const Eigen::Matrix4d& b)
{
  return disagreement(cloud, a.cast<float>(), b.cast<float>());
}

Eigen::Matrix4d turned(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& shift)
{
  const Eigen::Vector3d centre = Eigen::Vector3d(2.0, 1.0, 0.7) + farOff();
  const Eigen::Matrix3d rotation = expSO3(degrees * kPi / 180.0 * axis.normalized());
  return SE3(rotation, centre + shift - rotation * centre).matrix();
}

TEST(CloudRegistration, IdentityInIdentityOut)
{
  const auto cloud = sampledObject(1, 1.0);
  const Result result = align(cloud, cloud);
  ASSERT_TRUE(result.converged);
  EXPECT_LT((result.transform - Eigen::Matrix4d::Identity()).norm(), 1e-6);
  EXPECT_EQ(result.report.termination, Termination::converged);
}

TEST(CloudRegistration, OtherSamplesOfTheSameSurfaceAgreeFarBelowTheirSpacing)
{
  const auto source = awayFromTruth();
  const Result result = align(source, sampledObject(1, 1.0));
  ASSERT_TRUE(result.converged);
  EXPECT_LT(difference(*source, result.transform, motion(1.0).cast<double>()), 0.03 * kSpacing);
}

TEST(CloudRegistration, SwappingSourceAndTargetInvertsTheResult)
{
  const auto source = awayFromTruth();
  const auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4d there = align(source, target).transform;
  const Eigen::Matrix4d back = align(target, source).transform;
  EXPECT_LT(difference(*source, back * there, Eigen::Matrix4d::Identity()), 0.03 * kSpacing);
}

TEST(CloudRegistration, ARigidMotionOfBothCloudsChangesNothing)
{
  const auto source = awayFromTruth();
  const auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4d expected = align(source, target).transform;
  const Eigen::Matrix4d motion_of_both = exp((Vector6() << 1.0, -2.0, 3.0, 0.5, -0.3, 1.2).finished()).matrix();
  const Eigen::Matrix4d result = align(moved(*source, motion_of_both), moved(*target, motion_of_both)).transform;
  EXPECT_LT(difference(*source, motion_of_both.inverse() * result * motion_of_both, expected), 0.005 * kSpacing);
}

TEST(CloudRegistration, TheFrameOfTheSourceChangesNothing)
{
  // What is known of the source's shapes turns with it.
  const auto source = awayFromTruth();
  const auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4d expected = align(source, target).transform;
  const Eigen::Matrix4d turn = exp((Vector6() << 0.4, -0.2, 0.3, 0.6, -0.8, 0.9).finished()).matrix();
  const Eigen::Matrix4d result = align(moved(*source, turn), target, turn.inverse()).transform;
  EXPECT_LT(difference(*source, result * turn, expected), 0.005 * kSpacing);
}

TEST(CloudRegistration, TwoKilometresFromTheOriginAreNoDifference)
{
  const auto source = awayFromTruth(100.0);
  const auto target = sampledObject(1, 100.0);
  const Eigen::Matrix4d expected = align(source, target).transform;
  Eigen::Matrix4d away = Eigen::Matrix4d::Identity();
  away.topRightCorner<3, 1>() << 2000.0, -1500.0, 100.0;
  const Eigen::Matrix4d result = align(moved(*source, away), moved(*target, away)).transform;
  EXPECT_LT(difference(*source, away.inverse() * result * away, expected), 1e-3);
}

TEST(CloudRegistration, TheOrderOfThePointsChangesNothing)
{
  auto source = awayFromTruth();
  auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4d expected = align(source, target).transform;
  std::mt19937 random(5);
  for (const auto& cloud : {source, target}) {
    std::shuffle(cloud->begin(), cloud->end(), random);
  }
  EXPECT_LT((align(source, target).transform - expected).norm(), 1e-6);
}

TEST(CloudRegistration, TheGuessDoesNotChangeAConvergedAnswer)
{
  const auto source = awayFromTruth();
  const auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4d expected = align(source, target).transform;
  for (const double degrees : {2.0, 10.0, 25.0}) {
    const Eigen::Matrix4d guess = turned(degrees, {0.3, -0.5, 1.0}, {0.05, 0.1, -0.05});
    EXPECT_LT(difference(*source, align(source, target, guess).transform, expected), 0.01 * kSpacing) << degrees;
  }
}

TEST(CloudRegistration, LargeOffsetsAreFound)
{
  const auto source = awayFromTruth();
  const auto target = sampledObject(1, 1.0);
  for (const double degrees : {15.0, 30.0, 45.0}) {
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(1.0, 0.4, 0.2)}) {
      const Eigen::Matrix4d guess = turned(degrees, axis, {0.2, -0.1, 0.1}) * motion(1.0).cast<double>();
      const Result result = align(source, target, guess);
      EXPECT_TRUE(result.converged);
      EXPECT_LT(difference(*source, result.transform, motion(1.0).cast<double>()), 0.05 * kSpacing) << degrees;
    }
  }
}

TEST(CloudRegistration, AnyNumberOfThreadsGivesTheSameBits)
{
  const auto source = awayFromTruth();
  const auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4d guess = turned(20.0, {0.0, 0.0, 1.0}, {0.1, 0.0, 0.0});
  const Result expected = align(source, target, guess, 1);
  for (const unsigned threads : {2U, 3U, 7U}) {
    const Result result = align(source, target, guess, threads);
    EXPECT_EQ(result.transform, expected.transform);
    EXPECT_EQ(result.report.covariance, expected.report.covariance);
  }
}

TEST(CloudRegistration, OnePreparedTargetServesSeveralThreads)
{
  const auto target = sampledObject(1, 1.0, 20000);
  const PreparedCloud prepared(viewOf(*target), {}, 1);
  CloudRegistrationRun run;
  run.guess = SE3(Eigen::Affine3d(turned(20.0, {0.0, 0.0, 1.0}, {0.1, 0.0, 0.0})));
  const auto align = [&run](const PreparedCloud& to, int points) {
    const auto source = sampledObject(2, 1.0, points);
    return registerClouds(PreparedCloud(viewOf(*source), {}, 1), to, run).target_T_source.matrix();
  };
  const std::vector<int> sizes = {20000, 3000, 9000};
  std::vector<Eigen::Matrix4d> results(sizes.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    threads.emplace_back([&, i] { results[i] = align(prepared, sizes[i]); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_EQ(results[i], align(PreparedCloud(viewOf(*target), {}, 1), sizes[i])) << sizes[i];
  }
}

TEST(CloudRegistration, TwoThousandOrHalfAMillionPointsThickOrThin)
{
  for (const int points : {100, 1000, 100000}) {
    auto source = moved(*sampledObject(2, 1.0, points), motion(1.0).cast<double>().inverse());
    const Result result = align(source, sampledObject(1, 1.0, points));
    ASSERT_TRUE(result.converged) << points;
    const double spacing = kSpacing * std::sqrt(6000.0 / points);
    EXPECT_LT(difference(*source, result.transform, motion(1.0).cast<double>()), (points < 500 ? 0.5 : 0.05) * spacing)
        << points;
  }
}

TEST(CloudRegistration, WithoutStructureItIsDrawnPointToPoint)
{
  // Points in a volume, seen twice: neither lines nor planes.
  std::mt19937 random(3);
  auto target = pcl::make_shared<Cloud>();
  for (int i = 0; i < 400; ++i) {
    Point point;
    point.getVector3fMap() =
        (farOff() + Eigen::Vector3d(uniform(random, 1.0), uniform(random, 1.0), uniform(random, 1.0))).cast<float>();
    target->push_back(point);
  }
  const Eigen::Matrix4d truth =
      motionThere(exp((Vector6() << 0.02, -0.01, 0.03, 0.02, -0.03, 0.01).finished())).matrix();
  const auto source = moved(*target, truth.inverse());
  const Result result = align(source, target);
  ASSERT_TRUE(result.converged);
  EXPECT_LT(difference(*source, result.transform, truth), 1e-4);
  EXPECT_GT(result.report.point_correspondences, result.report.edge_correspondences);
}

TEST(CloudRegistration, ScanLinesAreNoStructureOfTheScene)
{
  // Points of one laser lie on its cone: taken for a plane or a line, they hold the sensor where it was.
  const SE3 truth = exp((Vector6() << 0.1, -0.05, 0.02, 0.01, -0.01, 0.05).finished());
  for (const int columns : {1800, 3600}) {
    Lidar lidar;
    lidar.rings = 16;
    lidar.columns = columns;
    const auto scan = [&lidar](unsigned seed, const SE3& world_T_sensor) {
      std::mt19937 random(seed);
      auto cloud = pcl::make_shared<Cloud>();
      for (const Return& r : sweepRoom(Room(), lidar, world_T_sensor)) {
        Point point;
        point.getVector3fMap() = (r.point + uniform(random, 0.02) * r.point.normalized()).cast<float>();
        cloud->push_back(point);
      }
      return cloud;
    };
    const auto source = scan(2, truth);
    const Result result = align(source, scan(1, SE3()));
    ASSERT_TRUE(result.converged) << columns;
    EXPECT_LT(difference(*source, result.transform, truth.matrix()), 0.01) << columns;
  }
}

TEST(CloudRegistration, TheReportTellsLinesFromPlanes)
{
  auto cloud = pcl::make_shared<Cloud>();
  std::mt19937 random(4);
  for (int i = 0; i < 3000; ++i) {
    Point point;
    point.getVector3fMap() = i % 3 == 0 ? Eigen::Vector3f(0.0F, 3.0F, static_cast<float>(uniform(random, 2.0)))
                                        : Eigen::Vector3f(static_cast<float>(uniform(random, 1.0)),
                                                          static_cast<float>(uniform(random, 1.0)), 0.0F);
    cloud->push_back(point);
  }
  const Result result = align(cloud, cloud);
  EXPECT_NEAR(result.report.edge_correspondences, 1000, 20);
  EXPECT_NEAR(result.report.plane_correspondences, 2000, 20);
}

TEST(CloudRegistration, TheCovarianceFitsTheSpreadOfTheResults)
{
  const auto noisy = [](unsigned seed) {
    auto cloud = sampledObject(seed, 1.0, 3000);
    std::mt19937 random(seed);
    for (Point& point : *cloud) {
      for (int axis = 0; axis < 3; ++axis) {
        point.getVector3fMap()[axis] += static_cast<float>(uniform(random, 0.005) + uniform(random, 0.005));
      }
    }
    return cloud;
  };
  const auto target = noisy(100);
  double normalized = 0.0;
  constexpr int kRuns = 20;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const Result result = align(noisy(seed), target);
    const Vector6 error = log(SE3(Eigen::Affine3d(result.transform)));
    normalized += error.dot(Eigen::Matrix<double, 6, 6>(result.report.covariance).inverse() * error) / 6.0 / kRuns;
  }
  EXPECT_GT(normalized, 0.5);
  EXPECT_LT(normalized, 2.0);
}

}  // namespace
}  // namespace pcl_floam::test
