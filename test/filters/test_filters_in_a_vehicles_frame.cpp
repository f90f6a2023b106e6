// Clouds that are given in a vehicle's frame: filters that are told where the sensor is do as in the sensor's own.
#define PCL_NO_PRECOMPILE
#include "support/constants.h"
#include "support/synthetic_cloud.h"

#include <pcl_floam/filters/feature_extraction.h>
#include <pcl_floam/filters/motion_compensation.h>
#include <pcl_floam/filters/vertical_correction.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace pcl_floam::test {
namespace {

using Bare = pcl::PointCloud<pcl::PointXYZ>;

/// Ahead, above and tilted, so that its scan lines are cones about no axis of the vehicle.
const SE3 kVehicleFromSensor = exp((Vector6() << 1.5, -0.4, 1.8, 0.1, 0.35, 2.0).finished());

/// A room without rings and times, which must be found from where its points lie.
Bare::Ptr roomScan(const Vector6& twist = Vector6::Zero())
{
  return pcl::make_shared<Bare>(
      toPositions(sweepRoom(Room(), Lidar(), [&](double fraction) { return exp(Vector6(fraction * twist)); })));
}

Bare::Ptr moved(const Bare& cloud, const SE3& target_T_source)
{
  auto result = pcl::make_shared<Bare>(cloud);
  for (pcl::PointXYZ& point : *result) {
    point.getVector3fMap() = (target_T_source * point.getVector3fMap().cast<double>().eval()).cast<float>();
  }
  return result;
}

void expectNear(const Bare& a, const Bare& b, float limit)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_LT((a[i].getVector3fMap() - b[i].getVector3fMap()).norm(), limit) << i;
  }
}

TEST(FiltersInAVehiclesFrame, FindTheSensorsFeaturesInIt)
{
  FeatureSet of_sensor;
  FeatureSet of_vehicle;
  FeatureExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(roomScan());
  ASSERT_TRUE(extraction.extract(of_sensor));
  extraction.setInputCloud(moved(*roomScan(), kVehicleFromSensor));
  extraction.setSensorPose(kVehicleFromSensor);
  EXPECT_EQ(extraction.getSensorPose().translation, kVehicleFromSensor.translation);
  ASSERT_TRUE(extraction.extract(of_vehicle));
  // Rounding decides between a few that are about as sharp.
  EXPECT_NEAR(static_cast<double>(of_vehicle.edges.size()), static_cast<double>(of_sensor.edges.size()),
              0.02 * static_cast<double>(of_sensor.edges.size()));
  const auto expectMostThere = [](const std::vector<Feature>& found, const std::vector<Feature>& others, double most) {
    std::size_t same = 0;
    for (const Feature& feature : found) {
      for (const Feature& other : others) {
        const Eigen::Vector3d there = kVehicleFromSensor * Eigen::Vector3d(other.x, other.y, other.z);
        if (feature.index == other.index) {
          EXPECT_LT((there - Eigen::Vector3d(feature.x, feature.y, feature.z)).norm(), 1e-3);
          ++same;
        }
      }
    }
    EXPECT_GT(static_cast<double>(same), most * static_cast<double>(others.size()));
  };
  expectMostThere(of_vehicle.edges, of_sensor.edges, 0.95);
  expectMostThere(of_vehicle.planes, of_sensor.planes, 0.85);  // of a wall many are as smooth
}

TEST(FiltersInAVehiclesFrame, UndoItsMotionByTheSensorsAzimuths)
{
  const Vector6 twist = (Vector6() << 0.4, 0.1, 0.0, 0.0, 0.0, 0.1).finished();  // of the sensor
  MotionCompensation<pcl::PointXYZ> compensation;
  Bare of_sensor;
  compensation.setInputCloud(roomScan(twist));
  compensation.setTwist(twist);
  compensation.filter(of_sensor);
  ASSERT_EQ(compensation.getScanTiming().source, ScanTimingSource::azimuth);
  Bare of_vehicle;
  compensation.setInputCloud(moved(*roomScan(twist), kVehicleFromSensor));
  compensation.setSensorPose(kVehicleFromSensor);
  compensation.setMotion(kVehicleFromSensor * exp(twist) * kVehicleFromSensor.inverse());
  compensation.filter(of_vehicle);
  EXPECT_EQ(compensation.getScanTiming().source, ScanTimingSource::azimuth);
  expectNear(of_vehicle, *moved(of_sensor, kVehicleFromSensor), 1e-4F);
}

TEST(FiltersInAVehiclesFrame, RaisePointsAsTheSensorSeesThem)
{
  VerticalCorrection<pcl::PointXYZ> correction;
  correction.setAngle(1.0);
  Bare of_sensor;
  correction.setInputCloud(roomScan());
  correction.filter(of_sensor);
  Bare of_vehicle;
  correction.setInputCloud(moved(*roomScan(), kVehicleFromSensor));
  correction.setSensorPose(kVehicleFromSensor);
  correction.filter(of_vehicle);
  expectNear(of_vehicle, *moved(of_sensor, kVehicleFromSensor), 1e-4F);
}

TEST(FiltersInAVehiclesFrame, TurnNormalsAndLeaveNoReturnsWhereTheyAre)
{
  pcl::PointCloud<pcl::PointNormal> cloud(3, 1);
  cloud[0].getVector3fMap() = (kVehicleFromSensor * Eigen::Vector3d(5.0, 1.0, 0.5)).cast<float>();
  cloud[0].getNormalVector3fMap() = (kVehicleFromSensor.rotation * Eigen::Vector3d(0.0, 0.0, 1.0)).cast<float>();
  cloud[1].getVector3fMap().setZero();
  cloud[2].getVector3fMap() = kVehicleFromSensor.translation.cast<float>();
  VerticalCorrection<pcl::PointNormal> correction;
  correction.setInputCloud(cloud.makeShared());
  correction.setAngle(1.0);
  correction.setSensorPose(kVehicleFromSensor);
  pcl::PointCloud<pcl::PointNormal> output;
  correction.filter(output);
  const Eigen::Vector3d normal =
      kVehicleFromSensor.rotation.transpose() * output[0].getNormalVector3fMap().cast<double>();
  const Eigen::Vector3d back(-5.0, -1.0, 0.0);  // a normal that stood upright leans back by the angle
  EXPECT_NEAR(std::acos(normal.z()), kPi / 180.0, 1e-3);
  EXPECT_GT(normal.dot(back), 0.0);
  EXPECT_EQ(output[1].getVector3fMap(), cloud[1].getVector3fMap());
  EXPECT_EQ(output[2].getVector3fMap(), cloud[2].getVector3fMap());
}

TEST(FiltersInAVehiclesFrame, RefuseAPoseThatIsNotFinite)
{
  const SE3 nowhere(Eigen::Matrix3d::Identity(), {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  EXPECT_THROW(FeatureExtraction<pcl::PointXYZ>().setSensorPose(nowhere), std::invalid_argument);
  EXPECT_THROW(MotionCompensation<pcl::PointXYZ>().setSensorPose(nowhere), std::invalid_argument);
  EXPECT_THROW(VerticalCorrection<pcl::PointXYZ>().setSensorPose(nowhere), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_floam::test
