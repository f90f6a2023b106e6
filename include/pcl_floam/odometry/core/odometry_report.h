/// \file odometry_report.h
/// What the odometry did with one scan.
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/scan_lines.h>
#include <pcl_floam/odometry/core/odometry_engine.h>
#include <pcl_floam/registration/core/registration_report.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_floam {

/// How a scan's pose came about.
enum class TrackingState : std::uint8_t {
  initialized,  ///< first usable scan: the map begins with it, its pose is the initial pose
  tracked,      ///< registered with the map
  doubtful,     ///< registered, but the pose may be wrong: nothing but the expectation, or the sensor's own pattern,
                ///< holds it along some direction (a smooth tunnel; an open road, until something beside it was seen;
                ///< rings near to walls), or, by surfaces, the map has no surface for most of the scan, several motions
                ///< still explain the first twelve scans, or the lidar has a single layer and height, roll and pitch
                ///< are not locked
  predicted,    ///< no usable data: the pose is the prediction of the constant-velocity model
  not_started   ///< no usable scan yet: the pose is the initial pose
};

[[nodiscard]] const char* toString(TrackingState state);

/// Milliseconds spent in each stage of the data flow.
struct StageTimes {
  double scan_lines = 0.0;  ///< scan lines and times
  double features = 0.0;
  double registration = 0.0;
  double map = 0.0;
  double total = 0.0;
};

/// The outcome of one call of `Odometry::track`.
struct OdometryReport {
  TrackingState state = TrackingState::not_started;
  /// Why it was not `tracked`, or that the sequence was started again. Of a tracked scan: that the poses since the
  /// first scan have turned out to be wrong, and this one jumps, or that it is the scan before once more. Empty
  /// otherwise.
  std::string reason;
  SE3 world_T_sensor;  ///< at the instant of the sweep that the parameters name
  /// Seconds from the scan's stamp to that instant, as the points' times tell; 0 if they have none. Of a scan that is
  /// missing as of the one before.
  double since_stamp = 0.0;
  /// It is not decided yet how the sensor began to move: other motions than this one are still sought, a few each scan
  /// (`start_effort`), or are or were followed beside it, since the first scans do not tell (fast, among traffic;
  /// without times). The poses since the first scan may yet be corrected, by more than `covariance` tells where a
  /// motion turns out to be right that was not followed then. By default it ends after some fifteen scans where one
  /// motion is likely, else when one is left, and its scans were gone through once more.
  bool provisional = false;
  /// What `world_T_sensor` should have been for so many scans before this one, oldest first, where the first ones are
  /// known better by now, have turned out to be wrong (then `reason` says so), or were unknown because the second scan
  /// was missing, and where the sensor has come to rest; for whoever keeps the trajectory. Empty otherwise.
  std::vector<SE3> corrected_poses;
  /// The sensor stands still, as far as poses that are `tracked` tell: ten of them differed by noise alone, and none
  /// has been farther from their mean since than noise leads once in an hour. `world_T_sensor` is that mean, and those
  /// since it came to rest are corrected to it once. What moves by less than the noise from scan to scan is taken for
  /// rest until it has led out of it.
  bool at_rest = false;
  /// By surfaces: part of the registered points, 0 to 1, that lie where the map has them, to three standard deviations.
  /// Less than half is `doubtful`.
  double explained = 0.0;
  /// How well the scan, and by surfaces a hint of its motion, tell where the sensor is, whatever was expected, and by
  /// surfaces less what noise would tell: one standard deviation along the direction of which they tell least, m; a
  /// kilometre where nothing does, as of a pose that is predicted; 0 for the first scan, whose pose is given.
  /// `doubtful` until two scans in a row together tell to 2 cm, and again from one on that tells to no more than 5
  /// cm, after a gap of ten periods, and where a pose was set.
  double scan_only_deviation = 0.0;
  /// Of `world_T_sensor`; order, axes and units are those of the registration's, which is of the middle of the sweep:
  /// towards its ends the velocity counts, too. What the registration may be off against the map; along directions that
  /// the scans said nothing of (weak ones, by surfaces; all of them while poses are predicted) what the velocity may
  /// have been off since they were seen last. While a position is doubtful since nothing but the expectation holds it,
  /// any motion since the scan before counts, up to 4 m a period; what was wrong before that is not in it. Where
  /// several motions are followed, by surfaces, it reaches from this one to the others. By features weak ones have a
  /// variance too large to be used. Zero for the first scan.
  Matrix6 covariance = Matrix6::Zero();
  OdometryEngine engine = OdometryEngine::surfaces;           ///< what the scan was registered by
  ScanLineFailure scan_line_failure = ScanLineFailure::none;  ///< why the scan was worked from space, not scan lines
  ScanLineSource scan_line_source = ScanLineSource::automatic;
  float scan_line_confidence = 0.0F;
  std::size_t scan_lines = 0;  ///< 0: it was worked from space
  /// Left out, since no other one lies beside them, as those of stray light: of scan lines, by surfaces.
  std::size_t isolated_returns = 0;
  /// Where nothing tells which way the head turned, it is clockwise, counterclockwise or none, whichever explains the
  /// scans better (by surfaces).
  ScanTimingSource timing_source = ScanTimingSource::none;
  std::size_t points = 0;  ///< points in the scan
  std::size_t edges = 0;   ///< edge features extracted
  std::size_t planes = 0;  ///< plane features extracted
  bool keyframe = false;   ///< the scan was added to the map
  RegistrationReport registration;
  StageTimes milliseconds;
};

}  // namespace pcl_floam
