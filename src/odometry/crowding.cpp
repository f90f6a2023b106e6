#include "odometry/crowding.h"

#include "odometry/sensor_axes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pcl_floam {

namespace {

/// The mean of many comparisons is steadier; that of five finds out before a corner is over.
constexpr double kComparisons = 5.0;
constexpr double kMisleads = 1.5;
constexpr double kIsLikely = 0.8;

/// Where the lorry's pull changes its side, its mean is small for a while, too: one small mean does not end it. Many in
/// a row would keep spread features, which tell less, for too long.
constexpr double kAgrees = 0.5;
constexpr int kAgreements = 5;

/// Lorries drive along the ground: x, y and the heading. Real floors are not plain, and far ones may lie higher: along
/// the real drive of the tests spread features have the height 2.4 standard deviations lower all the way.
constexpr std::array<int, 3> kAlongTheGround = {0, 1, 5};

/// One comparison must not decide alone.
constexpr double kMostOfOne = 4.0;

/// Along directions that are not seen both keep to the prediction, and agree whatever fills the view.
bool tells(const RegistrationReport& report)
{
  return report.hasConverged() && report.weak_directions.empty();
}

}  // namespace

bool Crowding::isDue()
{
  const bool due = ++scans_since_ >= scansBetween();
  if (due) {
    scans_since_ = 0;
  }
  return due;
}

/// One scan in five costs 3 % of the time; each would cost five times that, mostly for nothing.
int Crowding::scansBetween() const
{
  if (misleads_) {
    return 3;
  }
  return pull_.cwiseAbs().maxCoeff() > kIsLikely ? 1 : kScansBetween;
}

void Crowding::suspect()
{
  misleads_ = true;
  agreements_ = 0;
}

void Crowding::compare(const RegistrationReport& all, const RegistrationReport& spread)
{
  if (!tells(all) || !tells(spread)) {
    return;
  }
  const Vector6 difference = log(all.target_T_source.inverse() * spread.target_T_source);
  const Matrix6 covariance = poseCovarianceInSensorAxes(spread);  // a lorry keeps its side in a curve, too
  Eigen::Vector3d deviations = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const int axis = kAlongTheGround[i];
    const double variance = covariance(axis, axis);
    if (variance > 0.0) {  // what is locked has none, and doesn't differ
      deviations[i] = std::clamp(difference[axis] / std::sqrt(variance), -kMostOfOne, kMostOfOne);
    }
  }
  pull_ += (deviations - pull_) / kComparisons;
  const double pull = pull_.cwiseAbs().maxCoeff();
  agreements_ = pull > kAgrees ? 0 : agreements_ + 1;
  misleads_ = pull > kMisleads || (misleads_ && agreements_ < kAgreements);
}

}  // namespace pcl_floam
