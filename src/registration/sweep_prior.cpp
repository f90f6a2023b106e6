#include "registration/sweep_prior.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace pcl_floam {

Matrix12 SweepPrior::information() const
{
  using Square = Eigen::Matrix<double, 6, 6>;
  constexpr double kLeastVariance = 1e-12;
  const Square pose_covariance = covariance.topLeftCorner<6, 6>() + kLeastVariance * Matrix6::Identity();
  const Square common = covariance.topRightCorner<6, 6>();
  const Square gain = pose_covariance.ldlt().solve(common).transpose();
  const Square rest = covariance.bottomRightCorner<6, 6>() - gain * common + kLeastVariance * Square::Identity();
  const Square known = rest.inverse();
  Matrix12 information;
  information << gain.transpose() * known * gain, -gain.transpose() * known, -known * gain, known;
  information.topLeftCorner<6, 6>() +=
      pose_counts ? Square(pose_covariance.inverse()) : Square(kNothingKnown * Square::Identity());
  return information;
}

SweepPrior SweepPrior::apartFrom(const Matrix6& onto) const
{
  using Square = Eigen::Matrix<double, 12, 12>;
  Square these = Square::Zero();
  these.topLeftCorner<6, 6>() = onto;
  these.bottomRightCorner<6, 6>() = onto;
  const Square others = Square::Identity() - these;
  const Square all = covariance;
  SweepPrior apart = *this;
  apart.covariance = others * all * others.transpose() + these * all * these.transpose();
  return apart;
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
