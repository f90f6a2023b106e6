// What is registered: lidar scans, maps and any other cloud.
#include "support/constants.h"
#include "support/registration_clouds.h"

#include <pcl_floam/registration/edge_plane_registration.h>

#include <pcl/common/transforms.h>

#include <gtest/gtest.h>

namespace pcl_floam::test {
namespace {

using Registration = EdgePlaneRegistration<Point, Point>;
using Base = pcl::Registration<Point, Point>;

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

/// A floor and a wall say nothing of the way along both.
TEST(EdgePlaneRegistration, AFactorTellsWhatTheCloudsDoNot)
{
  class Along : public PoseFactor {
  public:
    void addTo(const SE3& target_T_source, PoseEquations& equations) const override
    {
      equations.add(target_T_source.translation.x(), Vector6::Unit(0), 1e-6);
    }
  };
  const auto corner = [](unsigned seed) {
    std::mt19937 random(seed);
    auto cloud = pcl::make_shared<Cloud>();
    for (int i = 0; i < 20000; ++i) {
      Eigen::Vector3d place(uniform(random, 2.0), uniform(random, 2.0), uniform(random, 2.0));
      place[i % 2 == 0 ? 1 : 2] = uniform(random, 0.002) - 2.0;
      Point point;
      point.getVector3fMap() = (place + farOff()).cast<float>();
      cloud->push_back(point);
    }
    return cloud;
  };
  Registration registration;
  registration.setInputSource(corner(1));
  registration.setInputTarget(corner(2));
  Cloud output;
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  guess(0, 3) = 0.05F;
  registration.align(output, guess);
  EXPECT_NEAR(registration.getFinalTransformation()(0, 3), 0.05, 0.01);
  EXPECT_GT(std::sqrt(registration.report().covariance(0, 0)), 0.1);
  registration.addFactor(std::make_shared<Along>());
  registration.align(output, guess);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_NEAR(registration.getFinalTransformation()(0, 3), 0.0, 5e-3);
  EXPECT_LT(std::sqrt(registration.report().covariance(0, 0)), 0.02);
  EXPECT_THROW(registration.addFactor(nullptr), std::invalid_argument);
  registration.clearFactors();
  EXPECT_TRUE(registration.getFactors().empty());
}

TEST(EdgePlaneRegistration, TheResultScalesWithTheScene)
{
  // By powers of two, so that nothing but absolute lengths in the code can make a difference.
  const auto result = [](float scale) {
    auto source = sampledObject(2, 1.0);
    auto target = sampledObject(1, 1.0);
    pcl::transformPointCloud(*source, *source, Eigen::Matrix4f(motion(1.0).inverse()));
    for (const auto& cloud : {source, target}) {
      for (Point& point : *cloud) {
        point.getVector3fMap() *= scale;
      }
    }
    Registration registration;
    registration.setInputSource(source);
    registration.setInputTarget(target);
    Cloud output;
    registration.align(output);
    Eigen::Matrix4f unscaled = registration.getFinalTransformation();
    unscaled.topRightCorner<3, 1>() /= scale;
    return std::make_pair(unscaled, registration.report().iterations);
  };
  const auto [expected, iterations] = result(1.0F);
  for (const float scale : {1.0F / 1024.0F, 1.0F / 32.0F, 512.0F}) {
    const auto [transformation, iterations_scaled] = result(scale);
    EXPECT_LT((transformation - expected).norm(), 1e-6F) << "scale " << scale;
    EXPECT_EQ(iterations_scaled, iterations) << "scale " << scale;
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

TEST(EdgePlaneRegistration, FeaturesMeetThoseOfTheTargetAlsoAfterTwoCloudsHaveMet)
{
  Registration registration;
  registration.setInputSource(scanFrom(kOther));
  registration.setInputTarget(scanFrom(SE3()));
  Cloud output;
  registration.align(output);
  EXPECT_GT(registration.report().point_correspondences, 0);
  EXPECT_EQ(registration.getSourceFeatures(), nullptr);
  const FeatureSet features = featuresOf(toCloud(sweepRoom(Room(), Lidar(), kOther)));
  registration.setSourceFeatures(features);
  ASSERT_NE(registration.getSourceFeatures(), nullptr);
  EXPECT_EQ(registration.getSourceFeatures()->planes.size(), features.planes.size());
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  EXPECT_EQ(registration.report().point_correspondences, 0);
  EXPECT_GT(registration.report().edge_correspondences, 0);
  EXPECT_LT((registration.getFinalTransformation() - kOther.matrix<float>()).norm(), 0.05F);
  registration.clearSourceFeatures();
  EXPECT_EQ(registration.getSourceFeatures(), nullptr);
  registration.align(output);
  EXPECT_GT(registration.report().point_correspondences, 0);
}

TEST(EdgePlaneRegistration, AnotherMapOrNoneReplacesTheOneBefore)
{
  const auto mapOf = [](const SE3& world_T_sensor) {
    auto map = pcl::make_shared<KeyframeVoxelMap>();
    map->insert(featuresOf(toCloud(sweepRoom(Room(), Lidar(), world_T_sensor))), SE3());
    return map;
  };
  Registration registration;
  registration.setInputSource(scanFrom(kOther));
  registration.setInputTargetMap(mapOf(SE3()));
  Cloud output;
  registration.align(output);
  EXPECT_LT(registration.getFitnessScore(), 0.3);
  auto far = pcl::make_shared<KeyframeVoxelMap>();
  far->insert(featuresOf(toCloud(sweepRoom(Room(), Lidar()))), SE3(Eigen::Matrix3d::Identity(), {100.0, 0.0, 0.0}));
  registration.setInputTargetMap(far);
  registration.align(output);
  EXPECT_GT(registration.getFitnessScore(), 1000.0);
  registration.setInputTargetMap(mapOf(SE3()));
  registration.align(output);
  ASSERT_TRUE(registration.hasConverged());
  registration.setInputTargetMap(nullptr);
  EXPECT_EQ(registration.getInputTarget(), nullptr);
  registration.align(output);
  EXPECT_FALSE(registration.hasConverged());
  EXPECT_EQ(registration.report().termination, Termination::not_run);

  const auto cloud = scanFrom(SE3());
  registration.setInputTarget(cloud);
  registration.setInputTargetMap(far);
  registration.setInputTargetMap(nullptr);
  EXPECT_EQ(registration.getInputTarget(), cloud);
}

TEST(EdgePlaneRegistration, ScansInAVehiclesFrameAreRegisteredThere)
{
  const SE3 vehicle_T_sensor = exp((Vector6() << 1.5, -0.4, 1.8, 0.1, 0.35, 2.0).finished());
  const auto ofVehicle = [&](const Cloud::ConstPtr& scan) {
    auto moved = pcl::make_shared<Cloud>();
    pcl::transformPointCloud(*scan, *moved, vehicle_T_sensor.matrix<float>());
    return moved;
  };
  Registration of_sensor;
  of_sensor.setInputSource(scanFrom(kOther));
  of_sensor.setInputTarget(scanFrom(SE3()));
  Registration of_vehicle;
  of_vehicle.setInputSource(ofVehicle(scanFrom(kOther)));
  of_vehicle.setInputTarget(ofVehicle(scanFrom(SE3())));
  Cloud output;
  of_vehicle.align(output);  // prepares the target as if the sensor were at the vehicle's origin
  of_vehicle.setSensorPose(vehicle_T_sensor);
  EXPECT_EQ(of_vehicle.getSensorPose().translation, vehicle_T_sensor.translation);
  of_sensor.align(output);
  of_vehicle.align(output);
  ASSERT_TRUE(of_vehicle.hasConverged());
  const SE3 expected = vehicle_T_sensor * of_sensor.report().target_T_source * vehicle_T_sensor.inverse();
  EXPECT_LT(log(expected.inverse() * of_vehicle.report().target_T_source).norm(), 1e-3);
  EXPECT_NEAR(of_vehicle.report().edge_correspondences, of_sensor.report().edge_correspondences,
              0.05 * of_sensor.report().edge_correspondences);
}

TEST(EdgePlaneRegistration, FeatureParametersOutOfRangeAreRefused)
{
  Registration registration;
  FeatureParameters parameters;
  parameters.max_range = 50.0F;
  registration.setFeatureParameters(parameters);
  EXPECT_EQ(registration.getFeatureParameters().max_range, 50.0F);
  parameters.max_range = 0.1F;  // less than the least
  EXPECT_THROW(registration.setFeatureParameters(parameters), std::invalid_argument);
  EXPECT_EQ(registration.getFeatureParameters().max_range, 50.0F);
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
}

}  // namespace
}  // namespace pcl_floam::test
