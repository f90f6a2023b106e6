#include "registration/sweep_prior.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace pcl_floam {

Matrix12 SweepPrior::information() const
{
  constexpr double kLeastVariance = 1e-12;
  const Square6 pose_covariance = covariance.topLeftCorner<6, 6>() + kLeastVariance * Matrix6::Identity();
  const Square6 common = covariance.topRightCorner<6, 6>();
  const Square6 gain = pose_covariance.ldlt().solve(common).transpose();
  const Square6 rest = covariance.bottomRightCorner<6, 6>() - gain * common + kLeastVariance * Square6::Identity();
  const Square6 known = rest.inverse();
  Matrix12 information;
  information << gain.transpose() * known * gain, -gain.transpose() * known, -known * gain, known;
  information.topLeftCorner<6, 6>() +=
      pose_counts ? Square6(pose_covariance.inverse()) : Square6(kNothingKnown * Square6::Identity());
  return information;
}

Vector12 SweepPrior::offset(const SE3& target_T_sensor, const Vector6& at_velocity) const
{
  const Vector6 faster = at_velocity - velocity;
  Vector12 off;
  off << target_T_sensor.translation - pose.translation, logSO3(target_T_sensor.rotation * pose.rotation.transpose()),
      target_T_sensor.rotation * faster.head<3>(), target_T_sensor.rotation * faster.tail<3>();
  return off;
}

}  // namespace pcl_floam
