#include "registration/sweep_prior.h"

namespace pcl_floam {

namespace {

/// In any unit: what is known for certain has an inverse, too.
Matrix6 leastCovariance()
{
  constexpr double kLeastVariance = 1e-12;
  return kLeastVariance * Matrix6::Identity();
}

/// Inverse of the pose's covariance.
Matrix6 ofPose(const Matrix12& covariance)
{
  return inverseOf(Matrix6(covariance.topLeftCorner<6, 6>() + leastCovariance()));
}

}  // namespace

Matrix12 SweepPrior::information() const
{
  const Matrix6 of_pose = ofPose(covariance);
  const Matrix6 common = covariance.topRightCorner<6, 6>();
  const Matrix6 gain = product(common.transpose(), of_pose);
  const Matrix6 known =
      inverseOf(Matrix6(covariance.bottomRightCorner<6, 6>() - product(gain, common) + leastCovariance()));
  const Matrix6 following = product(known, gain);
  const Matrix6 pose_alone = pose_counts ? of_pose : Matrix6(kNothingKnown * Matrix6::Identity());
  return inBlocks(product(gain.transpose(), following) + pose_alone, -following.transpose(), -following, known);
}

SweepPrior SweepPrior::apartFrom(const Matrix6& onto) const
{
  const Matrix12 these = inBlocks(onto, Matrix6::Zero(), Matrix6::Zero(), onto);
  SweepPrior apart = *this;
  apart.covariance = propagated(Matrix12::Identity() - these, covariance) + propagated(these, covariance);
  return apart;
}

SweepPrior::State SweepPrior::movedBy(const Vector6& off) const
{
  if (off.isZero(0.0)) {
    return {pose, velocity};
  }
  const Vector6 faster = covariance.bottomLeftCorner<6, 6>() * (ofPose(covariance) * off);
  const Eigen::Matrix3d back = pose.rotation.transpose();
  State moved = {SE3(nearestRotation(expSO3(off.tail<3>()) * pose.rotation), pose.translation + off.head<3>()),
                 velocity};
  moved.velocity.head<3>() += back * faster.head<3>();
  moved.velocity.tail<3>() += back * faster.tail<3>();
  return moved;
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
