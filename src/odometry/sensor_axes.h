/// \file sensor_axes.h
/// Covariances of poses in the axes of the target and of the sensor.
#pragma once

#include <pcl_floam/registration/registration_report.h>

#include <Eigen/Core>

namespace pcl_floam {

/// A covariance in other axes.
inline Matrix6 turned(const Eigen::Matrix3d& rotation, const Matrix6& covariance)
{
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = rotation;
  return turn * covariance * turn.transpose();
}

/// The registered pose's covariance, in the sensor's axes.
inline Matrix6 poseCovarianceInSensorAxes(const RegistrationReport& registration)
{
  return turned(registration.target_T_source.rotation.transpose(), registration.covariance);
}

}  // namespace pcl_floam
