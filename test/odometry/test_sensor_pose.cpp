// A sensor that is not at the origin of the frame that its clouds are given in.
#include "common/perturbation.h"
#include "support/moving_room.h"

#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/odometry/odometry.h>

#include <pcl/common/io.h>

#include <gtest/gtest.h>

#include <limits>

namespace pcl_floam::test {
namespace {

using Bare = pcl::PointCloud<pcl::PointXYZ>;

/// The lidar on a vehicle: ahead, above and tilted, so that its scan lines are cones about no axis of the vehicle.
const SE3 kVehicleFromSensor = exp((Vector6() << 1.5, -0.4, 1.8, 0.1, 0.35, 2.0).finished());

/// Without rings and times, which must be found from where the points lie.
Bare bare(int scan, const SE3& frame_T_sensor)
{
  Bare cloud;
  pcl::copyPointCloud(sweep(steadyPath, scan), cloud);
  for (pcl::PointXYZ& point : cloud) {
    point.getVector3fMap() = (frame_T_sensor * point.getVector3fMap().cast<double>().eval()).cast<float>();
  }
  return cloud;
}

/// In axes of the place that a covariance is about.
Matrix6 atTheSensor(const OdometryReport& of_vehicle)
{
  const Matrix6 lever = leverOf(-(of_vehicle.world_T_sensor.rotation * kVehicleFromSensor.translation));
  return lever * of_vehicle.covariance * lever.transpose();
}

/// The odometry of the vehicle's frame after \p scans, and that of the sensor's.
struct Both {
  Both()
  {
    vehicle.setSensorPose(kVehicleFromSensor);
    sensor.reset(kVehicleFromSensor);  // in the vehicle's first frame, as the other
  }

  void track(int scan)
  {
    vehicle.track(bare(scan, kVehicleFromSensor));
    sensor.track(bare(scan, SE3()));
  }

  Odometry<pcl::PointXYZ> vehicle{defaults()};
  Odometry<pcl::PointXYZ> sensor{defaults()};
};

double distanceBetween(const SE3& vehicle, const SE3& sensor)
{
  const SE3 off = (vehicle * kVehicleFromSensor).inverse() * sensor;
  return off.translation.norm() + rotationAngle(off.rotation);
}

TEST(SensorPose, PosesAreTheVehicles)
{
  Both both;
  for (int scan = 0; scan < kScans; ++scan) {
    both.track(scan);
    const OdometryReport& report = both.vehicle.report();
    EXPECT_EQ(report.state, both.sensor.report().state) << scan;
    EXPECT_EQ(report.scan_lines, both.sensor.report().scan_lines) << scan;
    EXPECT_LT(distanceBetween(report.world_T_sensor, both.sensor.getPose()), 2e-3) << scan;
    EXPECT_LT((atTheSensor(report) - both.sensor.report().covariance).norm(),
              0.2 * both.sensor.report().covariance.norm() + 1e-12)
        << scan;
    const Vector6 twist = adjoint(kVehicleFromSensor) * both.sensor.report().registration.sweep_twist;
    EXPECT_LT((report.registration.sweep_twist - twist).norm(), 5e-3) << scan;
  }
  const SE3 truth = kVehicleFromSensor * steadyPath(1.0).inverse() * steadyPath(kScans) * kVehicleFromSensor.inverse();
  EXPECT_LT((both.vehicle.getPose().translation - truth.translation).norm(), 0.05);
}

TEST(SensorPose, WhatIsGivenIsTheVehiclesToo)
{
  Both both;
  for (int scan = 0; scan < 4; ++scan) {
    both.track(scan);
  }
  MotionHint hint;
  hint.last_T_now =
      kVehicleFromSensor * exp((Vector6() << 0.3, 0.0, 0.0, 0.0, 0.0, 0.0).finished()) * kVehicleFromSensor.inverse();
  hint.covariance = 1e-10 * Matrix6::Identity();
  both.vehicle.setMotionHint(hint);
  MotionHint of_sensor;
  of_sensor.last_T_now = exp((Vector6() << 0.3, 0.0, 0.0, 0.0, 0.0, 0.0).finished());
  const Matrix6 turned = adjoint(kVehicleFromSensor.inverse());
  of_sensor.covariance = turned * hint.covariance * turned.transpose();
  both.sensor.setMotionHint(of_sensor);
  both.vehicle.trackMissing();
  both.sensor.trackMissing();
  EXPECT_LT(distanceBetween(both.vehicle.getPose(), both.sensor.getPose()), 2e-3);

  const SE3 elsewhere = exp((Vector6() << 0.5, 0.2, 0.0, 0.0, 0.0, 0.1).finished()) * both.vehicle.getPose();
  both.vehicle.setPose(elsewhere);
  both.sensor.setPose(elsewhere * kVehicleFromSensor);
  both.track(5);
  EXPECT_LT(distanceBetween(both.vehicle.getPose(), both.sensor.getPose()), 2e-3);

  both.vehicle.reset(elsewhere);
  EXPECT_LT((both.vehicle.getPose().translation - elsewhere.translation).norm(), 1e-12);
  EXPECT_EQ(both.vehicle.getSensorPose().translation, kVehicleFromSensor.translation);
}

TEST(SensorPose, ACopyAndAnIdentityChangeNothing)
{
  Odometry<pcl::PointXYZ> plain(defaults());
  Odometry<pcl::PointXYZ> told(defaults());
  told.setSensorPose(SE3());
  for (int scan = 0; scan < 3; ++scan) {
    plain.track(bare(scan, SE3()));
    const OdometryPipeline copy = told;
    told = Odometry<pcl::PointXYZ>(defaults());
    static_cast<OdometryPipeline&>(told) = copy;
    told.track(bare(scan, SE3()));
    EXPECT_EQ(plain.getPose().translation, told.getPose().translation) << scan;
  }
  SE3 nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(told.setSensorPose(nowhere), std::invalid_argument);
  OdometryParameters planar = defaults();
  planar.registration.locked = kPlanarMotion;
  EXPECT_THROW(Odometry<pcl::PointXYZ>(planar).setSensorPose(kVehicleFromSensor), std::invalid_argument);
}

TEST(MovedCloud, MovesPointsAndKeepsWhatIsNone)
{
  pcl::PointCloud<PointXYZIRT> cloud;
  cloud.push_back(PointXYZIRT(1.0F, 2.0F, 3.0F, 7.0F, 5, 0.25F));
  cloud.push_back(PointXYZIRT(0.0F, 0.0F, 0.0F, 7.0F, 6, 0.5F));
  MovedCloud moved;
  const CloudView view = moved.take(viewOf(cloud), kVehicleFromSensor);
  const Eigen::Vector3d there = kVehicleFromSensor * Eigen::Vector3d(1.0, 2.0, 3.0);
  EXPECT_NEAR(view.x(0), there.x(), 1e-5);
  EXPECT_NEAR(view.y(0), there.y(), 1e-5);
  EXPECT_NEAR(view.z(0), there.z(), 1e-5);
  EXPECT_EQ(view.ring.read(view.point(0)), 5.0);
  EXPECT_EQ(view.x(1), 0.0F);
  const pcl::PointXYZ place(static_cast<float>(kVehicleFromSensor.translation.x()),
                            static_cast<float>(kVehicleFromSensor.translation.y()),
                            static_cast<float>(kVehicleFromSensor.translation.z()));
  pcl::PointCloud<pcl::PointXYZ> carried;  // no return, as a driver that moves clouds gives it
  carried.push_back(place);
  EXPECT_EQ(moved.take(viewOf(carried), kVehicleFromSensor.inverse()).x(0), 0.0F);
  EXPECT_EQ(cloud[0].x, 1.0F);
}

}  // namespace
}  // namespace pcl_floam::test
