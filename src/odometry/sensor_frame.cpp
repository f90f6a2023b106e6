#include "odometry/sensor_frame.h"

#include "common/covariance.h"
#include "common/perturbation.h"

namespace pcl_floam {

SensorFrame::SensorFrame(const SE3& frame_T_sensor) : sensor_T_frame_(frame_T_sensor.inverse())
{
  sensor_.set(frame_T_sensor);
}

MotionHint SensorFrame::ofSensor(const MotionHint& hint) const
{
  const Matrix6 turned = adjoint(sensor_T_frame_);
  return {sensor_T_frame_ * hint.last_T_now * pose(), propagated(turned, hint.covariance)};
}

void SensorFrame::tell(const OdometryReport& of_sensor)
{
  if (sensor_.isIdentity()) {
    return;
  }
  const Matrix6 turned = adjoint(pose());
  const Matrix6 lever = leverOf(-(of_sensor.world_T_sensor.rotation * sensor_T_frame_.translation));
  report_ = of_sensor;
  report_.world_T_sensor = of_sensor.world_T_sensor * sensor_T_frame_;
  report_.covariance = propagated(lever, of_sensor.covariance);
  for (SE3& pose : report_.corrected_poses) {
    pose = pose * sensor_T_frame_;
  }
  report_.registration.sweep_twist = turned * of_sensor.registration.sweep_twist;
  report_.registration.sweep_acceleration = turned * of_sensor.registration.sweep_acceleration;
}

}  // namespace pcl_floam
