// Inside PCL's classes that take a registration.
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>
#include <pcl/registration/elch.h>
#include <pcl/registration/incremental_registration.h>
#include <pcl/registration/meta_registration.h>

#include <gtest/gtest.h>

#include <thread>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point>;

Cloud::Ptr moved(const Cloud& cloud, const Eigen::Matrix4f& motion)
{
  auto result = pcl::make_shared<Cloud>();
  pcl::transformPointCloud(cloud, *result, motion);
  return result;
}

/// motion(1.0), so many times.
Eigen::Matrix4f motions(int times)
{
  Eigen::Matrix4f result = Eigen::Matrix4f::Identity();
  for (int i = 0; i < times; ++i) {
    result = result * motion(1.0);
  }
  return result;
}

TEST(RegistrationComposition, IncrementalRegistration)
{
  pcl::registration::IncrementalRegistration<Point> incremental;
  incremental.setRegistration(pcl::make_shared<Registration>());
  Cloud::Ptr last;
  for (int i = 0; i < 4; ++i) {
    last = moved(*sampledObject(static_cast<unsigned>(i + 1), 1.0), motions(i).inverse());
    EXPECT_TRUE(incremental.registerCloud(last));
  }
  EXPECT_LT(disagreement(*last, incremental.getAbsoluteTransform(), motions(3)), 0.01);
}

TEST(RegistrationComposition, MetaRegistration)
{
  pcl::registration::MetaRegistration<Point> meta;
  meta.setRegistration(pcl::make_shared<Registration>());
  Cloud::Ptr last;
  for (int i = 0; i < 4; ++i) {
    last = moved(*sampledObject(static_cast<unsigned>(i + 1), 1.0), motions(i).inverse());
    EXPECT_TRUE(meta.registerCloud(last));
    EXPECT_LT(disagreement(*last, meta.getAbsoluteTransform(), motions(i)), 0.005);
  }
  EXPECT_EQ(meta.getMetaCloud()->size(), 4 * last->size());
}

TEST(RegistrationComposition, Elch)
{
  // A loop of four clouds whose last has drifted off the first.
  pcl::registration::ELCH<Point> elch;
  std::vector<Cloud::Ptr> clouds;
  for (int i = 0; i < 4; ++i) {
    Eigen::Matrix4f drift = Eigen::Matrix4f::Identity();
    drift(0, 3) = 0.02F * static_cast<float>(i);
    clouds.push_back(moved(*sampledObject(static_cast<unsigned>(i + 1), 1.0), drift));
    elch.addPointCloud(clouds.back());
  }
  elch.setReg(pcl::make_shared<Registration>());
  elch.setLoopStart(0);
  elch.setLoopEnd(3);
  elch.compute();
  EXPECT_NEAR(elch.getLoopTransform()(0, 3), -0.06F, 0.03F);
}

TEST(RegistrationComposition, ThroughPointersToIcpAndRegistration)
{
  const pcl::IterativeClosestPoint<Point, Point>::Ptr icp = pcl::make_shared<Registration>();
  icp->setUseReciprocalCorrespondences(false);
  icp->setMaximumIterations(50);
  const pcl::Registration<Point, Point>::Ptr registration = icp;
  const auto source = moved(*sampledObject(2, 1.0), motion(1.0).inverse());
  registration->setInputSource(source);
  registration->setInputTarget(sampledObject(1, 1.0));
  Cloud output;
  registration->align(output);
  EXPECT_TRUE(registration->hasConverged());
  EXPECT_LT(disagreement(*source, registration->getFinalTransformation(), motion(1.0)), 0.001);
}

TEST(RegistrationComposition, TwoObjectsInTwoThreads)
{
  const auto target = sampledObject(1, 1.0);
  const auto source = moved(*sampledObject(2, 1.0), motion(1.0).inverse());
  Eigen::Matrix4f results[2];
  const auto work = [&](Eigen::Matrix4f& result) {
    for (int i = 0; i < 3; ++i) {
      Registration registration;
      registration.setInputTarget(target);
      registration.setInputSource(source);
      Cloud output;
      registration.align(output);
      result = registration.getFinalTransformation();
    }
  };
  std::thread other(work, std::ref(results[0]));
  work(results[1]);
  other.join();
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace pcl_floam::test
