#include "odometry/reason_to_doubt.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// Part of a scan: a pose is in doubt if less lies on surfaces of the map, whatever is usual in the scene.
constexpr double kMostOfTheScan = 0.5;

bool keepsLevel(const DegreesOfFreedom& locked)
{
  return std::equal(locked.begin(), locked.end(), kPlanarMotion.begin(),
                    [](bool is, bool asked) { return is || !asked; });
}

}  // namespace

const char* reasonToDoubt(const Tracker& tracker, ScanLineFailure failure, double explained,
                          const DegreesOfFreedom& locked)
{
  if (tracker.isUndecided()) {
    return "several motions explain the first scans: the pose may be wrong";
  }
  if (explained < kMostOfTheScan && !tracker.isOpen()) {
    return "the map has no surface for most of the scan: the pose may be wrong";
  }
  if (failure == ScanLineFailure::single_layer && !keepsLevel(locked)) {
    return "the scan is a single layer: height, roll and pitch may be wrong";
  }
  return nullptr;
}

}  // namespace pcl_floam
