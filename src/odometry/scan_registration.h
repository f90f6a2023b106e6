/// \file scan_registration.h
/// A scan is registered in the map: with all of its features, or with those that are spread over the scene.
#pragma once

#include "odometry/crowding.h"

#include <pcl_floam/filters/features.h>
#include <pcl_floam/registration/feature_registration.h>

namespace pcl_floam {

/// The pose estimation of the odometry (Eq. 5 to 14), and what it remembers from scan to scan of crowded views.
class ScanRegistration {
public:
  /// Takes it for granted that what fills a part of the view misleads, until comparisons agree again and again; those
  /// so far don't count any more.
  void suspectCrowding()
  {
    crowding_ = Crowding();
    crowding_.suspect();
  }

  [[nodiscard]] RegistrationReport registerScan(const FeatureSet& measured, const FeatureTarget& target,
                                                const RegistrationRun& run, const RegistrationParameters& parameters);

  /// Whether the last scan's pose is that of its spread features alone.
  [[nodiscard]] bool usedSpreadFeatures() const { return used_spread_features_; }

private:
  Crowding crowding_;
  bool used_spread_features_ = false;
};

}  // namespace pcl_floam
