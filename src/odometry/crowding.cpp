#include "odometry/crowding.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_floam {

namespace {

/// In simulated rooms, halls, corridors, tunnels and cities without a lorry the mean of twenty comparisons stays below
/// 1.1, with a lorry beside it comes to 3; of five it wavers more, but finds out before a corner is over: if every
/// fifth scan were compared all the time, and four counted, the cities would come to 0.10, 0.12 and 0.24 %.
constexpr double kComparisons = 5.0;
constexpr double kMisleads = 1.5;
constexpr double kIsLikely = 0.8;
constexpr double kAgrees = 0.5;

/// Lorries drive along the ground: x, y and the heading. Real floors are not plain, and far ones may lie higher: along
/// the real drive of the tests spread features have the height 2.4 standard deviations lower all the way.
constexpr std::array<int, 3> kAlongTheGround = {0, 1, 5};

/// One comparison must not decide alone.
constexpr double kMostOfOne = 4.0;

/// In the axes of the sensor: a lorry keeps its side in a curve, too.
Matrix6 inSensorAxes(const Matrix6& covariance, const SE3& world_T_sensor)
{
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = world_T_sensor.rotation.transpose();
  turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
  return turn * covariance * turn.transpose();
}

}  // namespace

bool Crowding::isDue()
{
  const bool due = scans_ == 0;
  scans_ = (scans_ + 1) % scansBetween();
  return due;
}

/// Every scan would cost a tenth of the time, mostly for nothing.
int Crowding::scansBetween() const
{
  if (misleads_) {
    return 3;
  }
  return pull_.cwiseAbs().maxCoeff() > kIsLikely ? 1 : 5;
}

void Crowding::suspect()
{
  pull_ = Vector6::Constant(kMisleads);
}

void Crowding::compare(const RegistrationReport& all, const RegistrationReport& spread)
{
  if (!all.hasConverged() || !spread.hasConverged()) {
    return;
  }
  const Vector6 difference = log(all.target_T_source.inverse() * spread.target_T_source);
  const Matrix6 covariance = inSensorAxes(spread.covariance, spread.target_T_source);
  for (const int i : kAlongTheGround) {
    // What is locked has no variance, and doesn't differ.
    const double deviations = covariance(i, i) > 0.0 ? difference[i] / std::sqrt(covariance(i, i)) : 0.0;
    pull_[i] += (std::clamp(deviations, -kMostOfOne, kMostOfOne) - pull_[i]) / kComparisons;
  }
  misleads_ = pull_.cwiseAbs().maxCoeff() > (misleads_ ? kAgrees : kMisleads);
}

}  // namespace pcl_floam
