/// \file sensor_frame.h
/// Between the frame that clouds are given in and the sensor's own.
#pragma once

#include <pcl_floam/common/core/moved_cloud.h>
#include <pcl_floam/common/se3.h>
#include <pcl_floam/motion/motion_hint.h>
#include <pcl_floam/odometry/core/odometry_report.h>

namespace pcl_floam {

/// Clouds, poses and hints of a frame in which the sensor stands still, a vehicle's, and the same of the sensor.
class SensorFrame {
public:
  /// Clouds are given in the sensor's own frame.
  SensorFrame() = default;
  /// \throws std::invalid_argument for a pose that is not finite
  explicit SensorFrame(const SE3& frame_T_sensor);

  [[nodiscard]] const SE3& pose() const { return sensor_.get(); }

  /// As the sensor sees it; valid until the next call.
  [[nodiscard]] CloudView ofSensor(const CloudView& cloud) { return sensor_.ofSensor(cloud); }
  [[nodiscard]] SE3 ofSensor(const SE3& world_T_frame) const { return world_T_frame * pose(); }
  [[nodiscard]] MotionHint ofSensor(const MotionHint& hint) const;

  /// Takes the last report on the sensor, and says what it tells of the frame.
  void tell(const OdometryReport& of_sensor);
  /// \param of_sensor the last report on the sensor
  [[nodiscard]] const OdometryReport& report(const OdometryReport& of_sensor) const
  {
    return sensor_.isIdentity() ? of_sensor : report_;
  }

private:
  SensorPose sensor_;
  SE3 sensor_T_frame_;
  OdometryReport report_;
};

}  // namespace pcl_floam
