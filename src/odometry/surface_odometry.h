/// \file surface_odometry.h
/// The odometry by surfaces: its stages, scan by scan, and what they remember.
#pragma once

#include "common/side_by_side.h"
#include "odometry/odometry_run.h"
#include "odometry/tracker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_floam {

/// Within the pipeline, poses are those of mid-sweep, seen from the first one. World poses of other instants are
/// derived when they are given out.
struct SurfaceOdometry : OdometryRun {
  SurfaceOdometry(const OdometryParameters& p, const OdometryComponents& c)
      : OdometryRun(p, c), tracker({p.compensation, p.registration.locked, p.map.horizon, p.threads, p.start_effort, c})
  {
  }

  Tracker tracker;
  SE3 world_T_track;  ///< the track's origin is near the first scan's mid-sweep
  Sweep sweep;
  bool has_enough_points = false;

  void track(const CloudView& cloud, std::optional<double> stamp)
  {
    beginScan(cloud.size, stamp);
    extractFeatures(cloud);
    if (!has_enough_points) {
      return predictOnly("too few points");
    }
    if (!tracker.hasBegun() && !map_building.hasPrior()) {
      return start();
    }
    sweep_fraction = scan.sweep_fraction;
    estimatePose();
    if (!report.registration.hasConverged()) {
      return predictOnly(toString(report.registration.termination));
    }
    updateMap(cloud);
    finish(judge());
  }

  // Sensor Model and Feature Extraction
  void extractFeatures(const CloudView& cloud)
  {
    scan.findStructure(cloud, parameters, clock.period());
    sweep.is_direction_known = !scan.assumeTimes(cloud, parameters);
    report.milliseconds.scan_lines = watch.lap();
    sideBySide(
        parameters.threads, [&] { scan.takeFeatures(cloud, parameters); }, [&] { samplePoints(cloud); });
    scan.takeEdges(sweep.edges);
    report.milliseconds.features = watch.lap();
    describeScan();
    if (!scan.lines.valid()) {
      scan.takeForMap(cloud, sweep.dense);
    }
  }

  void samplePoints(const CloudView& cloud)
  {
    constexpr std::size_t kFewest = 20;
    const ScanReturns returns = scan.returnsOf(cloud, parameters);
    has_enough_points = returns.areAtLeast(kFewest);
    sweep.dense.clear();  // the last scan's
    sweep.sample.clear();
    if (has_enough_points) {
      tracker.sample(returns, sweep);
    }
  }

  TrackingState judge()
  {
    const char* doubt = tracker.reasonToDoubt(scan.lines.failure, report.explained);
    if (doubt != nullptr) {
      report.reason = doubt;
      return TrackingState::doubtful;
    }
    return toldState();
  }

  bool beginMap(const FeatureSet& features)
  {
    first_scans.begin(features);
    map_building.clear();
    return map_building.add(features, {initial_pose}, parameters);
  }

  /// The first scan: its motion is found with the second.
  void start()
  {
    if (first_scans.isOpen()) {
      report.reason = "started again, since the first scan was never matched";
    }
    sweep.periods = 1.0;
    registerSweep();
    reachScan();
    report.keyframe = beginMap(scan.features);
    report.milliseconds.map += watch.lap();
    finish(TrackingState::initialized);
  }

  // Motion Estimation, Distortion Compensation, Pose Estimation (Eq. 2 to 14)
  void estimatePose()
  {
    constexpr double kShortest = 1e-3;  // periods: stamps that do not advance
    const bool may_correct = tracker.mayCorrect() || !tracker.isTracking();
    sweep.periods = std::max(periods, kShortest);
    const bool was_tracking = tracker.isTracking();
    const Tracker::Outcome outcome = registerSweep();
    report.registration = outcome.registration.report;
    report.explained = outcome.registration.explained();
    report.milliseconds.registration += watch.lap();
    if (!report.registration.hasConverged()) {
      return;
    }
    noteTold(outcome.registration.told, was_tracking ? sweep.hint : std::nullopt);  // the first is only sought by it
    reachScan();
    if (may_correct && !map_building.hasPrior()) {
      first_scans.add(tracker.isBorneOut() ? scan.features : FeatureSet());
    }
    if (outcome.changed_track && !map_building.hasPrior()) {
      placeTrack();
    }
    if (outcome.corrected && !map_building.hasPrior()) {
      correctFirstPoses();
    }
  }

  Tracker::Outcome registerSweep()
  {
    sweep.fraction = scan.sweep_fraction;
    sweep.periods_error = errorOfPeriods();
    sweep.hint = hint.sinceLast();
    const bool is_placed = tracker.isTracking() || map_building.hasPrior();
    sweep.factors = {components.factors, is_placed ? world_T_track : initial_pose};
    return tracker.step(sweep);
  }

  void placeTrack() { world_T_track = initial_pose * tracker.firstPose(poseFraction()).inverse(); }

  /// Of the sweep, as time runs in it.
  [[nodiscard]] double poseFraction() const
  {
    const double fraction = fractionOf(parameters.pose_instant);
    return direction() < 0.0 ? 1.0 - fraction : fraction;
  }

  [[nodiscard]] double direction() const
  {
    return sweep.is_direction_known ? 1.0 : tracker.track().settings().direction;
  }

  /// The report speaks of the sweep as it was.
  void describeTime()
  {
    if (direction() == 0.0) {
      report.timing_source = ScanTimingSource::none;
    } else if (direction() < 0.0 && report.timing_source != ScanTimingSource::none) {  // those of a scan, by azimuth
      const bool was_clockwise = report.timing_source == ScanTimingSource::clockwise;
      report.timing_source = was_clockwise ? ScanTimingSource::counterclockwise : ScanTimingSource::clockwise;
      report.registration.sweep_twist = -report.registration.sweep_twist;
    }
  }

  void correctFirstPoses()
  {
    const std::vector<SweepPose>& poses = tracker.poses();
    placeTrack();
    report.corrected_poses = first_scans.correct(poses, world_T_track, poseFraction());
    if (first_scans.jumped()) {
      report.reason = "poses since the first scan have turned out to be wrong and are corrected: this one jumps";
    }
    map_building.clear();
    const std::vector<FeatureSet>& features = first_scans.features();
    const std::size_t before = poses.size() - features.size();
    for (std::size_t i = 0; i + 1 < features.size(); ++i) {
      map_building.add(features[i], world_T_track * poses[before + i], parameters);
    }
  }

  void updateMap(const CloudView& cloud)
  {
    const SweepPose world_T_sweep = world_T_track * tracker.track().pose();
    sideBySide(
        parameters.threads, [&] { tracker.updateMap(sweep); },
        [&] { report.keyframe = tracker.isBorneOut() && map_building.add(cloud, scan, world_T_sweep, parameters); });
    report.milliseconds.map += watch.lap();
  }

  /// A scan that told nothing, or none at all.
  void predictOnly(const char* reason)
  {
    report.reason = reason;
    report.scan_only_deviation = ToldMotion::kNothing;
    first_scans.miss();
    finish(tracker.hasBegun() || map_building.hasPrior() ? TrackingState::predicted : TrackingState::not_started);
  }

  void finish(TrackingState state)
  {
    report.state = state;
    report.world_T_sensor = initial_pose;
    report.provisional = tracker.isAmbiguous();
    if (tracker.isTracking()) {
      describeTime();
      report.world_T_sensor = world_T_track * poseNow().at(poseFraction());
      turnIntoWorld(report, world_T_track);
    }
    noteCovariance();
    noteRest();
    first_scans.give(report.world_T_sensor);
    if (tracker.isTracking() && !tracker.mayCorrect()) {
      first_scans.close();
    }
    report.milliseconds.total = watch.total();
  }

  void noteCovariance()
  {
    if (report.state == TrackingState::predicted && tracker.isTracking()) {
      report.covariance = turned(covarianceNow(predicted()) + tracker.rivalCovariance(), world_T_track);
    } else if (report.state == TrackingState::tracked || report.state == TrackingState::doubtful) {
      Matrix6 besides = tracker.rivalCovariance();
      besides.topLeftCorner<3, 3>() += told_motion.open();
      report.covariance = turned(covarianceNow(tracker.track().motion()) + besides, world_T_track);
    }
  }

  [[nodiscard]] Matrix6 covarianceNow(const MotionEstimate& at_middle) const
  {
    return covarianceAtInstant(at_middle, std::abs(direction()) * sweep_fraction);
  }

  [[nodiscard]] SweepPose poseNow() const
  {
    if (periods == 0.0) {
      return tracker.track().pose();
    }
    const MotionEstimate motion = predicted();
    return {motion.pose(), direction() * sweep_fraction * motion.velocity()};
  }

  [[nodiscard]] MotionEstimate predicted() const { return predictedFrom(tracker.track().motion(), periodsKnown()); }

  void setPose(const SE3& world_T_sensor)
  {
    rest = Rest();
    hint.placeNext();
    if (!tracker.isTracking()) {
      initial_pose = world_T_sensor;
      tracker.place(world_T_sensor);
      if (first_scans.isOpen()) {
        beginMap(FeatureSet(first_scans.features().front()));
        first_scans.give(initial_pose);
      }
      return;
    }
    const bool had_first_poses = tracker.mayCorrect() && !map_building.hasPrior();
    tracker.keepBest();
    if (had_first_poses) {
      placeTrack();  // it may be another one
    }
    tracker.place(world_T_track.inverse() * world_T_sensor);
    told_motion.forget();
    first_scans.close();
    periods = periods_error = 0.0;
  }

  void localizeIn(KeyframeVoxelMap given, MapUse use)
  {
    tracker.localizeIn(
        {given.points(FeatureKind::plane), given.points(FeatureKind::edge), initial_pose, use == MapUse::kept_current});
    map_building.begin(std::move(given), use, initial_pose);
  }
};

}  // namespace pcl_floam
