// In place of pcl::IterativeClosestPoint: lidar scans and any other cloud.
#include "support/random_motion.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

using Point = pcl::PointXYZI;
using Cloud = pcl::PointCloud<Point>;
using Registration = EdgePlaneRegistration<Point, Point>;
using Base = pcl::Registration<Point, Point>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A scan of the room from a place, in firing order, without rings; the intensity is the point's number.
Cloud::Ptr scanFrom(const SE3& world_T_sensor)
{
  auto cloud = pcl::make_shared<Cloud>();
  for (const Return& r : sweepRoom(Room(), Lidar(), world_T_sensor)) {
    Point point;
    point.getVector3fMap() = r.point.cast<float>();
    point.intensity = static_cast<float>(cloud->size());
    cloud->push_back(point);
  }
  return cloud;
}

/// Points on a box with a half cylinder on its top and a fin, about 1 m across: no lidar took it.
Cloud::Ptr sampledObject(unsigned seed, double scale, int points = 6000)
{
  std::mt19937 random(seed);
  auto cloud = pcl::make_shared<Cloud>();
  for (int i = 0; i < points; ++i) {
    const double u = uniform(random, 0.5);
    const double v = uniform(random, 0.5);
    Eigen::Vector3d p;
    switch (i % 5) {
      case 0: p = {u, v, -0.2}; break;
      case 1: p = {u, 0.5, 0.4 * v}; break;
      case 2: p = {-0.5, u, 0.4 * v}; break;
      case 3: p = {u, 0.3 * std::cos(kPi * (v + 0.5)), 0.2 + 0.3 * std::sin(kPi * (v + 0.5))}; break;
      default: p = {0.1 + 0.3 * u, 0.6 * u + 0.1, 0.6 + 0.4 * v}; break;
    }
    Point point;
    point.getVector3fMap() = (scale * (p + Eigen::Vector3d(2.0, 1.0, 0.5))).cast<float>();
    cloud->push_back(point);
  }
  return cloud;
}

Eigen::Matrix4f motion(double scale)
{
  return exp((Vector6() << 0.06 * scale, -0.04 * scale, 0.03 * scale, 0.03, -0.02, 0.04).finished()).matrix<float>();
}

/// Root mean square distance between a cloud moved by two transforms.
double disagreement(const Cloud& cloud, const Eigen::Matrix4f& a, const Eigen::Matrix4f& b)
{
  double sum = 0.0;
  for (const Point& point : cloud) {
    const Eigen::Vector4f p(point.x, point.y, point.z, 1.0F);
    sum += static_cast<double>(((a - b) * p).squaredNorm());
  }
  return std::sqrt(sum / static_cast<double>(cloud.size()));
}

const SE3 kOther = exp((Vector6() << 0.5, -0.3, 0.05, 0.01, -0.02, 0.08).finished());

TEST(EdgePlaneRegistration, RegistersLidarScansThroughTheBasePointer)
{
  const auto source = scanFrom(kOther);
  const auto target = scanFrom(SE3());
  const Base::Ptr registration = pcl::make_shared<Registration>();
  registration->setInputSource(source);
  registration->setInputTarget(target);
  Cloud output;
  registration->align(output);
  ASSERT_TRUE(registration->hasConverged());
  EXPECT_LT(disagreement(*source, registration->getFinalTransformation(), kOther.matrix<float>()), 0.03);
  EXPECT_LT(registration->getFitnessScore(), 0.1);
  EXPECT_EQ(registration->getFinalTransformation().row(3), Eigen::RowVector4f(0.0F, 0.0F, 0.0F, 1.0F));
}

TEST(EdgePlaneRegistration, TheSameCloudIsAlignedByIdentity)
{
  for (const auto& cloud : {scanFrom(SE3()), sampledObject(1, 1.0)}) {
    Registration registration;
    registration.setInputSource(cloud);
    registration.setInputTarget(cloud);
    Cloud output;
    registration.align(output);
    ASSERT_TRUE(registration.hasConverged());
    EXPECT_LT(disagreement(*cloud, registration.getFinalTransformation(), Eigen::Matrix4f::Identity()), 0.005);
  }
}

TEST(EdgePlaneRegistration, RegistersAnObjectOfAnySize)
{
  for (const double scale : {0.01, 1.0, 100.0}) {
    const auto target = sampledObject(1, scale);
    auto source = pcl::make_shared<Cloud>();
    pcl::transformPointCloud(*sampledObject(2, scale), *source, Eigen::Matrix4f(motion(scale).inverse()));
    Registration registration;
    registration.setInputSource(source);
    registration.setInputTarget(target);
    Cloud output;
    registration.align(output);
    ASSERT_TRUE(registration.hasConverged()) << "scale " << scale;
    EXPECT_LT(disagreement(*source, registration.getFinalTransformation(), motion(scale)), 0.005 * scale)
        << "scale " << scale;
  }
}

TEST(EdgePlaneRegistration, AGuessIsWhereItStarts)
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

TEST(EdgePlaneRegistration, OutputIsTheWholeSourceWithAllItsFields)
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

TEST(EdgePlaneRegistration, SurvivesNoReturnsAndWhatIsNotFinite)
{
  auto source = sampledObject(2, 1.0);
  auto target = sampledObject(1, 1.0);
  for (const auto& cloud : {source, target}) {
    for (std::size_t i = 0; i < cloud->size(); i += 10) {
      (*cloud)[i].getVector3fMap() = i % 20 == 0 ? Eigen::Vector3f(kNan, 0.0F, 0.0F) : Eigen::Vector3f::Zero();
    }
    cloud->is_dense = false;
  }
  pcl::transformPointCloud(*source, *source, Eigen::Matrix4f(motion(1.0).inverse()));
  for (std::size_t i = 10; i < source->size(); i += 20) {
    (*source)[i].getVector3fMap().setZero();
  }
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  Cloud output;
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_LT(disagreement(*sampledObject(2, 1.0), registration.getFinalTransformation(), motion(1.0)), 0.005);
}

TEST(EdgePlaneRegistration, FailureKeepsTheGuessAndTheNextRunRecovers)
{
  const auto source = scanFrom(kOther);
  auto far = scanFrom(SE3());
  for (Point& point : *far) {
    point.x += 1000.0F;
  }
  Registration registration;
  registration.setInputSource(source);
  registration.setInputTarget(far);
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

TEST(EdgePlaneRegistration, ATargetThatHoldsNothingFiniteIsNoTarget)
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

TEST(EdgePlaneRegistration, OneIterationAtATimeIntoTheSourceItself)
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

TEST(EdgePlaneRegistration, ATargetChangedInPlaceAndSetAgainIsNew)
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

TEST(EdgePlaneRegistration, RegistersFeaturesWithAMap)
{
  auto map = pcl::make_shared<KeyframeVoxelMap>();
  map->insert(featuresOf(toCloud(sweepRoom(Room(), Lidar()))), SE3());
  const auto source = scanFrom(kOther);
  EdgePlaneRegistration<Point, Point, double> registration;
  registration.setSourceFeatures(featuresOf(toCloud(sweepRoom(Room(), Lidar(), kOther))));
  registration.setInputTargetMap(map);
  registration.setInputSource(source);
  registration.setNumberOfThreads(2);
  Cloud output;
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_LT((registration.getFinalTransformation() - kOther.matrix()).norm(), 0.03);
  EXPECT_EQ(registration.report().termination, Termination::converged);
}

TEST(EdgePlaneRegistration, PointTypesOfSourceAndTargetMayBeXyz)
{
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  pcl::copyPointCloud(*sampledObject(1, 1.0), *cloud);
  EdgePlaneRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(cloud);
  registration.setInputTarget(cloud);
  pcl::PointCloud<pcl::PointXYZ> output;
  registration.align(output);
  EXPECT_TRUE(registration.hasConverged());
  RegistrationParameters parameters;
  parameters.min_correspondences = 1;
  EXPECT_THROW(registration.setParameters(parameters), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam::test
