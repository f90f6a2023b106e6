/// \file scan_preparation.h
/// What the odometry takes from one scan (the paper's "Sensor Model and Feature Extraction").
#pragma once

#include "filters/feature_selection.h"
#include "filters/isolated_returns.h"
#include "filters/line_grouping.h"
#include "filters/scan_returns.h"

#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/odometry/core/odometry_parameters.h>
#include <pcl_floam/odometry/core/odometry_report.h>

#include <vector>

namespace pcl_floam {

/// Kept from scan to scan: its memory is used again.
struct PreparedScan {
  ScanLines lines;
  ScanTiming timing;
  double sweep_fraction = 0.0;  ///< duration of the sweep in periods; 0 if its points are of one instant
  FeatureSet features;          ///< E_k and S_k as measured; none without scan lines

  /// \param period s, from sweep to sweep; 0 if it is not known
  void findStructure(const CloudView& scan, const OdometryParameters& parameters, double period);
  /// Takes times from the azimuth where nothing else tells them: where the points' order does not either, as of a head
  /// that turns clockwise from the rear. \return whether it had to: it may turn the other way, or the scan was
  /// compensated
  bool assumeTimes(const CloudView& scan, const OdometryParameters& parameters);
  void takeFeatures(const CloudView& scan, const OdometryParameters& parameters);
  /// All but isolated ones; apart from the features, so that both can be taken at a time.
  [[nodiscard]] ScanReturns returnsOf(const CloudView& scan, const OdometryParameters& parameters) const;
  /// E_k as points, once there are features.
  void takeEdges(std::vector<ScanPoint>& edges) const;
  /// What a map is made of where there are no scan lines, and so no features: points taken by space, as planes.
  void takeForMap(const CloudView& scan, const std::vector<ScanPoint>& by_space);
  void describeIn(OdometryReport& report) const;

private:
  bool turns_ = false;                ///< as an earlier scan showed
  std::size_t isolated_returns_ = 0;  ///< that were left out
  LineGrouping grouping_;
  IsolatedReturns isolated_;
  std::vector<FeatureSelection> selections_;
};

}  // namespace pcl_floam
