/// \file sweep.h
/// One sweep as the odometry takes it.
#pragma once

#include "registration/pose_factors.h"

#include <pcl_floam/filters/core/scan_point.h>
#include <pcl_floam/motion/motion_hint.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_floam {

/// The points of one sweep, in the sensor's frame, each at the instant of its own measurement.
struct Sweep {
  std::vector<ScanPoint> dense;       ///< what enters the map: no closer together than its cells tell apart
  std::vector<ScanPoint> sample;      ///< what is registered: one of each of the map's finest cells
  std::vector<std::uint32_t> places;  ///< of each of these the number of the place that it is in, while motions compete
  std::vector<ScanPoint> edges;       ///< the paper's edge features
  double periods = 1.0;               ///< since the sweep before, > 0 ...
  double periods_error = 0.0;         ///< ... and how far off that may be, one standard deviation
  /// Duration in periods; 0 if its points are of one instant, less than 0 if time is followed backwards.
  double fraction = 1.0;
  bool is_direction_known = true;  ///< of time: else it may run the other way, or the points may be of one instant
  bool is_pattern_new = false;     ///< not drawn again and again, as rings are: it looks elsewhere
  std::optional<MotionHint> hint;  ///< of the motion since the sweep before
  PoseFactors factors;             ///< what else is known of its pose
};

}  // namespace pcl_floam
