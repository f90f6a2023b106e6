// Clouds that constrain no pose, and settings that make no sense: an answer with a reason, never NaN or a crash.
#include "support/constants.h"
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point>;

Cloud::Ptr cloudOf(const std::vector<Eigen::Vector3f>& positions)
{
  auto cloud = pcl::make_shared<Cloud>();
  for (const Eigen::Vector3f& position : positions) {
    Point point;
    point.getVector3fMap() = position + farOff().cast<float>();
    cloud->push_back(point);
  }
  return cloud;
}

Cloud::Ptr allNan()
{
  auto cloud = cloudOf(std::vector<Eigen::Vector3f>(50, {kNan, kNan, kNan}));
  cloud->is_dense = false;
  return cloud;
}

Cloud::Ptr collinear(int count)
{
  std::vector<Eigen::Vector3f> positions;
  for (int i = 0; i < count; ++i) {
    positions.emplace_back(0.01F * static_cast<float>(i * i % 997), 0.0F, 1.0F);
  }
  return cloudOf(positions);
}

Cloud::Ptr coplanar(unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<Eigen::Vector3f> positions;
  for (int i = 0; i < 2000; ++i) {
    positions.emplace_back(static_cast<float>(uniform(random, 1.0)), static_cast<float>(uniform(random, 1.0)), 0.5F);
  }
  return cloudOf(positions);
}

/// Registers, checks that nothing is NaN, and gives the report.
RegistrationReport align(Registration& registration, const Eigen::Matrix4f& guess = Eigen::Matrix4f::Identity())
{
  Cloud output;
  registration.align(output, guess);
  EXPECT_TRUE(registration.getFinalTransformation().allFinite());
  EXPECT_TRUE(registration.getLastIncrementalTransformation().allFinite());
  EXPECT_TRUE(registration.report().target_T_source.isFinite());
  EXPECT_TRUE(registration.report().covariance.allFinite());
  EXPECT_FALSE(std::isnan(registration.getFitnessScore()));
  EXPECT_EQ(registration.hasConverged(), registration.report().hasConverged());
  if (!registration.hasConverged()) {
    EXPECT_NE(registration.report().termination, Termination::not_run);
  }
  return registration.report();
}

RegistrationReport align(const Cloud::Ptr& source, const Cloud::Ptr& target)
{
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  return align(registration);
}

TEST(RegistrationBadInput, CloudsWithoutPointsAreNoSourceAndNoTarget)
{
  const auto object = sampledObject(1, 1.0);
  EXPECT_EQ(align(allNan(), object).termination, Termination::too_few_features);
  EXPECT_EQ(align(object, allNan()).termination, Termination::empty_target);
  EXPECT_FALSE(align(allNan(), allNan()).hasConverged());
}

/// What is printed to standard error meanwhile.
template <typename Action>
std::string printedBy(const Action& action)
{
  testing::internal::CaptureStderr();
  action();
  return testing::internal::GetCapturedStderr();
}

TEST(RegistrationBadInput, EmptyCloudsAreRefusedAloudAndTheOnesBeforeStay)
{
  const auto source = sampledObject(2, 1.0);
  const auto target = sampledObject(1, 1.0);
  Registration registration;
  pcl::IterativeClosestPoint<Point, Point> icp;
  for (auto* each : {static_cast<pcl::IterativeClosestPoint<Point, Point>*>(&registration), &icp}) {
    each->setInputSource(source);
    each->setInputTarget(target);
    Cloud output;
    each->align(output);
    ASSERT_TRUE(each->hasConverged());
    const Eigen::Matrix4f result = each->getFinalTransformation();
    const auto empty = pcl::make_shared<Cloud>();
    EXPECT_NE(printedBy([&] { each->setInputSource(empty); }).find("setInputSource] Invalid or empty"),
              std::string::npos);
    EXPECT_NE(printedBy([&] { each->setInputTarget(empty); }).find("setInputTarget] Invalid or empty"),
              std::string::npos);
    EXPECT_EQ(each->getInputSource(), source);
    EXPECT_EQ(each->getInputTarget(), target);
    EXPECT_TRUE(each->hasConverged());
    each->align(output);
    EXPECT_EQ(each->getFinalTransformation(), result);
  }
  EXPECT_NE(printedBy([&] { registration.setInputSource(nullptr); }), "");
  EXPECT_NE(printedBy([&] { registration.setInputTarget(nullptr); }), "");
  EXPECT_EQ(registration.getInputSource(), source);
  EXPECT_EQ(registration.getInputTarget(), target);
  EXPECT_TRUE(registration.report().hasConverged());
}

TEST(RegistrationBadInput, FailureIsSaidAloudAndSuccessIsNot)
{
  const auto object = sampledObject(1, 1.0);
  const auto alignWith = [](const Cloud::Ptr& source, const Cloud::Ptr& target) {
    return printedBy([&] { EXPECT_NE(align(source, target).termination, Termination::not_run); });
  };
  EXPECT_EQ(alignWith(object, object), "");
  EXPECT_NE(
      alignWith(cloudOf({{2.0F, 1.0F, 0.3F}}), object).find("[pcl::EdgePlaneRegistration::computeTransformation]"),
      std::string::npos);
  EXPECT_NE(alignWith(allNan(), object).find("too few features"), std::string::npos);
}

TEST(RegistrationBadInput, OneOrTwoPointsGiveNoPose)
{
  const auto object = sampledObject(1, 1.0);
  const auto one = cloudOf({{2.0F, 1.0F, 0.3F}});
  const auto two = cloudOf({{2.0F, 1.0F, 0.3F}, {2.1F, 1.0F, 0.3F}});
  for (const auto& few : {one, two}) {
    EXPECT_EQ(align(few, object).termination, Termination::too_few_correspondences);
    EXPECT_EQ(align(few, few).termination, Termination::too_few_correspondences);
  }
  EXPECT_TRUE(align(object, one).target_T_source.isFinite());
}

TEST(RegistrationBadInput, EqualPointsAreMovedOntoEachOtherAndDoNotTurn)
{
  const auto source = cloudOf(std::vector<Eigen::Vector3f>(100, {1.0F, 2.0F, 3.0F}));
  const auto target = cloudOf(std::vector<Eigen::Vector3f>(100, {1.5F, 2.0F, 3.0F}));
  const RegistrationReport report = align(source, target);
  if (report.hasConverged()) {
    const Eigen::Vector3d point = Eigen::Vector3d(1.0, 2.0, 3.0) + farOff();
    EXPECT_LT((report.target_T_source * point - point - Eigen::Vector3d(0.5, 0.0, 0.0)).norm(), 1e-5);
    EXPECT_EQ(report.weak_directions.size(), 3U);
    EXPECT_LT(rotationAngle(report.target_T_source.rotation), 1e-6);
  }
}

TEST(RegistrationBadInput, ALineLeavesTheTurnAboutItWeak)
{
  const auto target = collinear(500);
  auto source = pcl::make_shared<Cloud>(*target);
  for (Point& point : *source) {
    point.z += 0.05F;
  }
  const RegistrationReport report = align(source, target);
  ASSERT_TRUE(report.hasConverged());
  const Eigen::Vector3d point = Eigen::Vector3d(3.0, 0.0, 1.05) + farOff();
  EXPECT_NEAR((report.target_T_source * point - point).z(), -0.05, 1e-3);
  ASSERT_FALSE(report.weak_directions.empty());
  EXPECT_NEAR(std::abs(report.weak_directions[0].direction[3]), 1.0, 1e-3);
}

TEST(RegistrationBadInput, APlaneIsReachedAndItsSlidesAreWeak)
{
  auto source = coplanar(2);
  pcl::transformPointCloud(*source, *source, Eigen::Matrix4f(motion(0.5).inverse()));
  const RegistrationReport report = align(source, coplanar(1));
  ASSERT_TRUE(report.hasConverged());
  const Eigen::Vector3d normal =
      report.target_T_source.rotation * motion(0.5).inverse().topLeftCorner<3, 3>().cast<double>().col(2);
  EXPECT_GT(std::abs(normal.z()), 1.0 - 1e-6);
  EXPECT_EQ(report.weak_directions.size(), 3U);
}

TEST(RegistrationBadInput, TheSameCloudForBoth)
{
  const auto cloud = coplanar(1);
  const RegistrationReport report = align(cloud, cloud);
  ASSERT_TRUE(report.hasConverged());
  EXPECT_LT((report.target_T_source.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-5);
}

TEST(RegistrationBadInput, IndicesOutOfRangeAreRefusedUntilTheyFit)
{
  const auto small = sampledObject(2, 1.0, 100);
  const auto large = sampledObject(2, 1.0, 1000);
  for (const int outside : {-1, 100, 999}) {
    Registration registration;
    const auto indices = pcl::make_shared<pcl::Indices>();
    for (int i = 0; i < 100; ++i) {
      indices->push_back(i);
    }
    indices->push_back(outside);
    registration.setIndices(indices);
    registration.setInputTarget(sampledObject(1, 1.0));
    registration.setInputSource(small);
    EXPECT_EQ(align(registration).termination, Termination::invalid_input) << outside;
    EXPECT_EQ(indices->size(), 101U);
    registration.setInputSource(large);
    EXPECT_EQ(align(registration).hasConverged(), outside > 0) << outside;
    registration.setInputSource(small);
    indices->pop_back();
    registration.setIndices(pcl::IndicesConstPtr(indices));
    EXPECT_TRUE(align(registration).hasConverged()) << outside;
  }
}

TEST(RegistrationBadInput, AGuessThatIsNotFiniteIsRefused)
{
  Registration registration;
  registration.setInputSource(sampledObject(2, 1.0));
  registration.setInputTarget(sampledObject(1, 1.0));
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  guess(1, 3) = kNan;
  EXPECT_EQ(align(registration, guess).termination, Termination::invalid_input);
  guess(1, 3) = std::numeric_limits<float>::infinity();
  EXPECT_EQ(align(registration, guess).termination, Termination::invalid_input);
}

TEST(RegistrationBadInput, HugeCoordinatesAndOutliersDoNoHarm)
{
  auto source = sampledObject(2, 1.0);
  auto target = sampledObject(1, 1.0);
  (*source)[0].getVector3fMap() = Eigen::Vector3f(3e38F, -3e38F, 3e38F);
  (*target)[0].getVector3fMap() = Eigen::Vector3f(-3e38F, 1e20F, 0.0F);
  (*target)[1].getVector3fMap() = Eigen::Vector3f(1e6F, 0.0F, 0.0F);
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output);
  EXPECT_TRUE(registration.getFinalTransformation().allFinite());
}

}  // namespace
}  // namespace pcl_floam::test
