// What code written for pcl::IterativeClosestPoint relies on.
#include "support/constants.h"
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>
#include <pcl/registration/incremental_registration.h>

#include <gtest/gtest.h>

#include <functional>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point>;

TEST(RegistrationContract, AGuessIsWhereItStarts)
{
  const auto target = sampledObject(1, 1.0);
  const Eigen::Matrix4f far = exp((Vector6() << 5.0, -3.0, 1.0, 0.2, 0.3, 1.5).finished()).matrix<float>();
  auto source = pcl::make_shared<Cloud>();
  pcl::transformPointCloud(*sampledObject(2, 1.0), *source, Eigen::Matrix4f(far.inverse() * motion(1.0).inverse()));
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output, far);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_LT(disagreement(*source, registration.getFinalTransformation(), motion(1.0) * far), 0.005);
  Cloud expected;
  pcl::transformPointCloud(*source, expected, registration.getFinalTransformation());
  for (std::size_t i = 0; i < source->size(); ++i) {
    EXPECT_LT((output[i].getVector3fMap() - expected[i].getVector3fMap()).norm(), 1e-5F);
  }
}

TEST(RegistrationContract, OutputIsTheWholeSourceWithAllItsFields)
{
  auto source = scanFrom(kOther);
  source->width = 32;
  source->height = 900;
  source->is_dense = false;
  source->header.frame_id = "lidar";
  source->header.stamp = 42;
  for (std::size_t i = 0; i < source->size(); i += 50) {
    (*source)[i].x = kNan;
  }
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(scanFrom(SE3()));
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < static_cast<int>(source->size()); i += 3) {
    indices->push_back(i);
  }
  for (const bool with_indices : {false, true}) {
    if (with_indices) {
      registration.setIndices(indices);
    }
    Cloud output;
    registration.align(output);
    ASSERT_TRUE(registration.hasConverged());
    ASSERT_EQ(output.size(), source->size());
    EXPECT_EQ(output.width, 32U);
    EXPECT_EQ(output.height, 900U);
    EXPECT_EQ(output.header.frame_id, "lidar");
    EXPECT_EQ(output.header.stamp, 42U);
    for (std::size_t i = 0; i < output.size(); ++i) {
      EXPECT_EQ(output[i].intensity, (*source)[i].intensity);
      EXPECT_EQ(pcl::isFinite(output[i]), pcl::isFinite((*source)[i]));
    }
    EXPECT_EQ(output[0].y, (*source)[0].y);  // not finite: left as it is
  }
}

TEST(RegistrationContract, FailureKeepsTheGuessAndTheNextRunRecovers)
{
  const auto source = scanFrom(kOther);
  auto far = scanFrom(SE3());
  for (Point& point : *far) {
    point.x += 1000.0F;
  }
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(far);
  registration.setMaxCorrespondenceDistance(5.0);
  const Eigen::Matrix4f guess = motion(1.0);
  Cloud output;
  registration.align(output, guess);
  EXPECT_FALSE(registration.hasConverged());
  EXPECT_FALSE(registration.report().hasConverged());
  EXPECT_EQ(registration.getFinalTransformation(), guess);
  Cloud expected;
  pcl::transformPointCloud(*source, expected, guess);
  ASSERT_EQ(output.size(), expected.size());
  EXPECT_LT((output[77].getVector3fMap() - expected[77].getVector3fMap()).norm(), 1e-5F);

  registration.setInputTarget(scanFrom(SE3()));
  registration.align(output);
  EXPECT_TRUE(registration.hasConverged());
  EXPECT_LT(disagreement(*source, registration.getFinalTransformation(), kOther.matrix<float>()), 0.03);
}

TEST(RegistrationContract, ATargetThatHoldsNothingFiniteIsNoTarget)
{
  auto nothing = pcl::make_shared<Cloud>(100, 1);
  for (Point& point : *nothing) {
    point.x = kNan;
  }
  nothing->is_dense = false;
  Registration registration;
  registration.setInputSource(sampledObject(1, 1.0));
  registration.setInputTarget(nothing);
  Cloud output;
  registration.align(output);
  EXPECT_FALSE(registration.hasConverged());
  EXPECT_EQ(registration.getFinalTransformation(), Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
}

TEST(RegistrationContract, OneIterationAtATimeIntoTheSourceItself)
{
  // As the interactive tutorial does it.
  const auto target = sampledObject(1, 1.0);
  const auto cloud = pcl::make_shared<Cloud>();
  pcl::transformPointCloud(*sampledObject(2, 1.0), *cloud, Eigen::Matrix4f(motion(1.0).inverse()));
  const Cloud before = *cloud;
  Registration registration;
  registration.setMaximumIterations(1);
  registration.setInputSource(cloud);
  registration.setInputTarget(target);
  Eigen::Matrix4f total = Eigen::Matrix4f::Identity();
  for (int i = 0; i < 30; ++i) {
    registration.align(*cloud);
    ASSERT_TRUE(registration.hasConverged());
    EXPECT_EQ(registration.report().iterations, 1);
    total = registration.getFinalTransformation() * total;
  }
  EXPECT_LT(disagreement(before, total, motion(1.0)), 0.005);
}

TEST(RegistrationContract, ATargetChangedInPlaceAndSetAgainIsNew)
{
  const auto source = sampledObject(2, 1.0);
  const auto target = sampledObject(1, 1.0);
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output);
  pcl::transformPointCloud(*target, *target, motion(1.0));
  registration.setInputTarget(target);
  registration.align(output);
  EXPECT_LT(disagreement(*source, registration.getFinalTransformation(), motion(1.0)), 0.005);
}

TEST(RegistrationContract, NewInputForgetsTheLastResult)
{
  const auto source = sampledObject(2, 1.0);
  Registration registration;
  Cloud output;
  const auto setSource = [&] { registration.setInputSource(source); };
  const auto setTarget = [&] { registration.setInputTarget(sampledObject(1, 1.0)); };
  setSource();
  setTarget();
  for (const std::function<void()>& renew : {std::function<void()>(setSource), std::function<void()>(setTarget)}) {
    registration.align(output);
    ASSERT_TRUE(registration.hasConverged());
    ASSERT_TRUE(registration.report().hasConverged());
    renew();
    EXPECT_FALSE(registration.hasConverged());
    EXPECT_EQ(registration.report().termination, Termination::not_run);
  }
}

TEST(RegistrationContract, AnEarlierSourceLeavesNoTrace)
{
  // Denser and sparser sources ask for other thinned targets.
  const auto target = sampledObject(1, 1.0, 20000);
  const Eigen::Matrix4f away =
      motionThere(exp((Vector6() << 0.2, -0.1, 0.1, 0.2, 0.1, 0.3).finished())).matrix<float>();
  const auto source = [&](int points) {
    auto cloud = pcl::make_shared<Cloud>();
    pcl::transformPointCloud(*sampledObject(2, 1.0, points), *cloud, away);
    return cloud;
  };
  const auto align = [](Registration& registration, const Cloud::Ptr& cloud) {
    Cloud output;
    registration.setInputSource(cloud);
    registration.align(output);
    return registration.getFinalTransformation();
  };
  Registration fresh;
  fresh.setInputTarget(target);
  const Eigen::Matrix4f expected = align(fresh, source(20000));
  Registration used;
  used.setInputTarget(target);
  align(used, source(3000));
  EXPECT_EQ(align(used, source(20000)), expected);
}

TEST(RegistrationContract, FitnessScoreSurvivesWhatIsNotFinite)
{
  const auto source = sampledObject(2, 1.0);
  const auto target = sampledObject(1, 1.0);
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output);
  const double score = registration.getFitnessScore();
  EXPECT_LT(score, 0.01);
  (*source)[5].x = kNan;
  (*source)[6].z = std::numeric_limits<float>::infinity();
  source->is_dense = false;
  registration.align(output);
  EXPECT_TRUE(registration.hasConverged());
  EXPECT_NEAR(registration.getFitnessScore(), score, 0.01 * score);
}

TEST(RegistrationContract, WorksInsideIncrementalRegistration)
{
  pcl::registration::IncrementalRegistration<Point> incremental;
  incremental.setRegistration(pcl::make_shared<Registration>());
  const auto first = sampledObject(1, 1.0);
  const auto second = pcl::make_shared<Cloud>();
  pcl::transformPointCloud(*sampledObject(2, 1.0), *second, Eigen::Matrix4f(motion(1.0).inverse()));
  EXPECT_TRUE(incremental.registerCloud(first));
  EXPECT_TRUE(incremental.registerCloud(second));
  EXPECT_LT(disagreement(*second, incremental.getAbsoluteTransform(), motion(1.0)), 0.005);
}

}  // namespace
}  // namespace pcl_floam::test
