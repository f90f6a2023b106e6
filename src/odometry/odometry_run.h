/// \file odometry_run.h
/// What every engine of the odometry keeps from scan to scan.
#pragma once

#include "common/sweep_trajectory.h"
#include "motion/motion_estimate.h"
#include "motion/pending_hint.h"
#include "motion/rest.h"
#include "motion/scan_clock.h"
#include "odometry/first_scans.h"
#include "odometry/map_building.h"
#include "odometry/scan_preparation.h"
#include "odometry/stopwatch.h"
#include "odometry/told_motion.h"

#include <pcl_floam/odometry/odometry.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace pcl_floam {

struct OdometryRun {
  OdometryRun(const OdometryParameters& p, const OdometryComponents& c)
      : parameters(p), components(c), map_building(p), clock(p.scan_period)
  {
  }

  OdometryParameters parameters;
  OdometryComponents components;
  MapBuilding map_building;
  ScanClock clock;
  FirstScans first_scans;  ///< of the engine 'surfaces': until it is decided how the sensor moved
  SE3 initial_pose;        ///< of the first scan, at the instant of the parameters
  PreparedScan scan;
  PendingHint hint;
  ToldMotion told_motion;
  Rest rest;
  bool rests_since_first = false;    ///< among its poses is the first scan's
  double sweep_fraction = 0.0;       ///< of the last scan that told of it
  double periods = 0.0;              ///< since the last scan that was registered ...
  double periods_error = 0.0;        ///< ... and how far off that may be, besides what stamps jitter
  std::optional<double> scan_stamp;  ///< s
  double since_stamp = 0.0;          ///< of the poses, s; of the last scan that told of it
  OdometryReport report;
  Stopwatch watch;

  void beginScan(std::size_t points, std::optional<double> stamp)
  {
    scan_stamp = stamp;
    report = OdometryReport();
    report.points = points;
    report.since_stamp = since_stamp;
    watch.start();
    hint.elapse();
    periods += clock.tick(stamp);
    periods_error = std::hypot(periods_error, clock.error());
    first_scans.elapse(periods);
  }

  /// The last scan came once more: what was told of it still holds.
  void repeatScan()
  {
    hint.elapse();
    first_scans.repeat();
    report.keyframe = false;
    report.corrected_poses.clear();
    report.milliseconds = {};
    report.reason = "the scan is the last one again";
  }

  /// What was found out about the scan.
  void describeScan()
  {
    scan.describeIn(report);
    since_stamp = scan.timing.sinceStamp(fractionOf(parameters.pose_instant), scan_stamp.value_or(scan.timing.start));
    report.since_stamp = since_stamp;
  }

  void reachScan()
  {
    periods = 0.0;
    periods_error = 0.0;
    hint.reach();
  }

  /// \param told       covariance of the pose as the scan alone tells it
  /// \param pose_takes a hint: what it tells counts as far as the pose goes by it
  void noteTold(const Matrix6& told, const std::optional<MotionHint>& pose_takes)
  {
    told_motion.take(toldPosition(told, report.registration.target_T_source.rotation, pose_takes), periods);
    report.scan_only_deviation = told_motion.deviation();
  }

  /// A pose that only the expectation holds is not called tracked.
  TrackingState toldState()
  {
    if (told_motion.isTold()) {
      return TrackingState::tracked;
    }
    report.reason = "the scans hardly tell how the sensor moves along some direction: the pose may be wrong";
    return TrackingState::doubtful;
  }

  /// Of the pose that is given out, which is not that of mid-sweep: the velocity may be off, and change meanwhile.
  [[nodiscard]] Matrix6 covarianceAtInstant(MotionEstimate at_middle, double sweep) const
  {
    at_middle.predict((fractionOf(parameters.pose_instant) - SweepTrajectory::kMiddle) * sweep);
    const Matrix6 covariance = at_middle.poseCovariance();
    return 0.5 * (covariance + covariance.transpose());  // but for rounding
  }

  /// A sensor that stands still is where its poses are in the mean. Those since it came to rest are corrected as soon
  /// as it is known that it did, but for the first scan's, which is given.
  void noteRest()
  {
    if (report.state != TrackingState::tracked && report.state != TrackingState::initialized) {
      rest = Rest();
      return;
    }
    std::vector<SE3>& corrected = report.corrected_poses;
    if (!corrected.empty()) {
      rest = Rest();
      std::for_each(corrected.begin(), corrected.end(),
                    [&](const SE3& pose) { rest.take(pose, report.registration.covariance); });
      rests_since_first = rest.poses() == static_cast<int>(corrected.size());
    }
    const bool was_known = rest.isAtRest() && corrected.empty();
    rest.take(report.world_T_sensor, report.registration.covariance);
    rests_since_first = report.state == TrackingState::initialized || (rests_since_first && rest.poses() > 1);
    report.at_rest = rest.isAtRest();
    if (!report.at_rest) {
      return;
    }
    report.world_T_sensor = rest.pose();
    if (!was_known) {
      const auto before = static_cast<std::size_t>(rest.poses() - (rests_since_first ? 2 : 1));
      corrected.resize(std::max(before, corrected.size()));
      std::fill_n(corrected.rbegin(), before, rest.pose());
      if (rests_since_first && corrected.size() > before) {
        corrected.front() = initial_pose;
      }
    }
  }

  /// Of the periods since the last scan that was registered.
  [[nodiscard]] double errorOfPeriods() const { return std::hypot(periods_error, clock.jitter()); }

  /// Motion Estimation (Eq. 2).
  [[nodiscard]] MotionEstimate predictedFrom(MotionEstimate motion, double over) const
  {
    motion.predict(over, hint.sinceLast(), errorOfPeriods());
    return motion;
  }

  /// Periods since the last scan that a velocity holds for: it is not known for ever.
  [[nodiscard]] double periodsKnown() const { return std::min(periods, kLongestKnown); }
};

}  // namespace pcl_floam
