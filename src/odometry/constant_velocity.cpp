#include "odometry/constant_velocity.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

constexpr double kMaxExtrapolation = 10.0;  // periods
constexpr double kFarthest = 4.0;           // m; beyond it the nearest surface is as likely as not another one

/// A pose's covariance is that of an average scene. Where little tells of a direction its errors are larger and go on
/// from scan to scan.
constexpr double kPoseErrorsPerVariance = 4.0;

}  // namespace

SE3 ConstantVelocity::motion(double periods) const
{
  return exp(std::min(periods, kMaxExtrapolation) * twist_);
}

void ConstantVelocity::set(const Vector6& twist)
{
  twist_ = twist;
  covariance_ = VelocityNoise().variance().asDiagonal();
  known_ = true;
}

Vector6 ConstantVelocity::observe(const Vector6& measured, const Matrix6& pose_covariance, const Vector6& noise,
                                  double periods)
{
  using Matrix6d = Eigen::Matrix<double, 6, 6>;  // Eigen 3.4's solvers do not take unaligned types
  // Between two poses, each as well known as the present one.
  const Matrix6d measurement = 2.0 * kPoseErrorsPerVariance / (periods * periods) * pose_covariance;
  const Matrix6d predicted = covariance_ + Matrix6((periods * noise).asDiagonal());
  const Matrix6d gain = Matrix6d(predicted + measurement).ldlt().solve(predicted).transpose();
  Vector6 change = gain * (measured - twist_);
  const Matrix6d left = predicted - gain * predicted;
  covariance_ = 0.5 * (left + left.transpose());
  twist_ += change;
  return change;
}

void PredictionError::observe(const SE3& predicted_T_estimated, double typical_range)
{
  const double displacement =
      predicted_T_estimated.translation.norm() + rotationAngle(predicted_T_estimated.rotation) * typical_range;
  constexpr double kForgetting = 0.8;  // about five scans of memory
  squared_ = kForgetting * squared_ + (1.0 - kForgetting) * displacement * displacement;
}

double PredictionError::bound(double periods) const
{
  return std::min(kFarthest, 3.0 * std::sqrt(squared_) * std::max(1.0, periods));
}

void VelocityNoise::observe(const Vector6& change, double periods)
{
  if (!(periods > 0.0)) {
    return;
  }
  constexpr double kForgetting = 0.8;  // about five scans of memory
  translation_ = kForgetting * translation_ + (1.0 - kForgetting) * change.head<3>().squaredNorm() / (3.0 * periods);
  rotation_ = kForgetting * rotation_ + (1.0 - kForgetting) * change.tail<3>().squaredNorm() / (3.0 * periods);
}

Vector6 VelocityNoise::variance() const
{
  constexpr double kLeastChange = 0.01;  // m per period
  constexpr double kLeastTurn = 0.005;   // rad per period
  Vector6 variance;
  variance.head<3>().setConstant(std::max(translation_, kLeastChange * kLeastChange));
  variance.tail<3>().setConstant(std::max(rotation_, kLeastTurn * kLeastTurn));
  return variance;
}

MotionPrior VelocityNoise::prior(const SE3& predicted, const Vector6& sweep_twist, double periods,
                                 double sweep_fraction) const
{
  constexpr double kLeastSpread = 0.15;  // m
  constexpr double kMostSpread = 0.3;    // m
  constexpr double kPoseRotation = 0.1;  // rad
  const auto spread = [&](double pose, double noise) {
    MotionPrior::Spread result;
    const double slope = sweep_fraction / periods;  // a pose further on by 1 was reached with a twist larger by this
    result.pose = pose * pose * periods;
    result.common = slope * result.pose;
    result.twist = slope * slope * result.pose + sweep_fraction * sweep_fraction * noise * periods;
    return result;
  };
  MotionPrior prior;
  prior.pose = predicted;
  prior.twist = sweep_twist;
  // A velocity that has just changed, mostly along one direction, may be wrong by as much.
  const double pose_spread = std::clamp(2.0 * std::sqrt(3.0 * translation_), kLeastSpread, kMostSpread);
  const Vector6 variances = variance();
  prior.translation = spread(pose_spread, variances[0]);
  prior.rotation = spread(kPoseRotation, variances[5]);
  return prior;
}

}  // namespace pcl_floam
