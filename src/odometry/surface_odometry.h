/// \file surface_odometry.h
/// The odometry by surfaces: its stages, scan by scan, and what they remember.
#pragma once

#include "motion/scan_clock.h"
#include "odometry/first_poses.h"
#include "odometry/scan_preparation.h"
#include "odometry/scan_sample.h"
#include "odometry/stopwatch.h"
#include "odometry/tracker.h"

#include <pcl_floam/filters/sweep_motion.h>
#include <pcl_floam/odometry/odometry.h>

#include <optional>
#include <string>

namespace pcl_floam {

/// Within the pipeline, poses are those of mid-sweep, seen from the first one. World poses of other instants are
/// derived when they are given out.
struct SurfaceOdometry {
  explicit SurfaceOdometry(const OdometryParameters& p)
      : parameters(p),
        map(p.map),
        clock(p.scan_period),
        tracker({p.compensation, p.registration.locked, p.map.horizon, p.threads})
  {
  }

  OdometryParameters parameters;
  KeyframeVoxelMap map;
  ScanClock clock;
  Tracker tracker;
  SE3 initial_pose;   ///< of the first scan, at the instant of the parameters
  SE3 world_T_track;  ///< the track's origin is the first scan's mid-sweep
  SE3 world_T_keyframe;
  int keyframes = 0;
  std::optional<MapUse> prior_map;  ///< of a map that was there before the first scan
  PreparedScan scan;
  double sweep_fraction = 0.0;          ///< of the last scan that told of it
  double periods = 0.0;                 ///< since the last scan that was registered
  FirstPoses first_poses;               ///< until it is decided how the sensor moved
  std::vector<FeatureSet> first_scans;  ///< their features, as measured
  OdometryReport report;
  Stopwatch watch;

  const OdometryReport& track(const CloudView& cloud, std::optional<double> stamp)
  {
    beginScan(cloud.size, stamp);
    extractFeatures(cloud);
    if (parameters.structure == ScanStructure::scan_lines && !scan.lines.valid()) {
      return predictOnly(toString(scan.lines.failure));
    }
    if (!hasEnoughPoints()) {
      return predictOnly("too few points");
    }
    if (!tracker.hasBegun() && !prior_map) {
      return start();
    }
    sweep_fraction = scan.sweep_fraction;
    estimatePose();
    if (!report.registration.hasConverged()) {
      return predictOnly(toString(report.registration.termination));
    }
    updateMap(cloud);
    return finish(judge());
  }

  void beginScan(std::size_t points, std::optional<double> stamp)
  {
    report = OdometryReport();
    report.points = points;
    watch.start();
    periods += clock.tick(stamp);
    first_poses.elapse(periods);
  }

  // Sensor Model and Feature Extraction
  void extractFeatures(const CloudView& cloud)
  {
    scan.findStructure(cloud, parameters, clock.period());
    report.milliseconds.scan_lines = watch.lap();
    scan.takePoints(cloud, parameters);
    report.milliseconds.features = watch.lap();
    report.structure = scan.lines.valid() ? ScanStructure::scan_lines : ScanStructure::space;
    report.scan_line_failure = scan.lines.failure;
    report.scan_line_source = scan.lines.source;
    report.scan_line_confidence = scan.lines.confidence;
    report.scan_lines = scan.lines.lines();
    report.timing_source = scan.timing.source;
    report.edges = scan.features.edges.size();
    report.planes = scan.features.planes.size();
  }

  /// A pose that the map does not bear out is not called tracked. The first sweeps' map is too young to tell.
  TrackingState judge()
  {
    constexpr double kLeast = 0.5;
    if (report.explained >= kLeast || tracker.isOpen()) {
      return TrackingState::tracked;
    }
    report.reason = "the map has no surface for most of the scan: the pose may be wrong";
    return TrackingState::doubtful;
  }

  [[nodiscard]] bool hasEnoughPoints() const
  {
    constexpr std::size_t kFewest = 20;
    return scan.points.size() >= kFewest;
  }

  /// The first scan: its motion is found with the second.
  const OdometryReport& start()
  {
    if (first_poses.isOpen()) {
      report.reason = "started again, since the first scan was never matched";
    }
    tracker.step(scan.points, scan.edges, 1.0, scan.sweep_fraction);
    periods = 0.0;
    first_poses.begin();
    map.clear();
    first_scans = {scan.features};
    insertFeatures(scan.features, SweepPose{initial_pose, Vector6::Zero()});
    report.milliseconds.map += watch.lap();
    return finish(TrackingState::initialized);
  }

  // Motion Estimation, Distortion Compensation, Pose Estimation (Eq. 2 to 14)
  void estimatePose()
  {
    constexpr double kShortest = 1e-3;  // periods: stamps that do not advance
    const bool was_open = tracker.isOpen() || !tracker.isTracking();
    const Tracker::Outcome outcome =
        tracker.step(scan.points, scan.edges, std::max(periods, kShortest), scan.sweep_fraction);
    report.registration = outcome.registration.report;
    report.explained = outcome.registration.points > 0 ? static_cast<double>(report.registration.plane_inliers) /
                                                             static_cast<double>(outcome.registration.points)
                                                       : 0.0;
    report.milliseconds.registration += watch.lap();
    if (!report.registration.hasConverged()) {
      return;
    }
    periods = 0.0;
    if (was_open && !prior_map) {
      first_scans.push_back(scan.features);
      first_poses.add();
    }
    if (outcome.corrected && !prior_map) {
      correctFirstPoses();
    }
  }

  void correctFirstPoses()
  {
    const std::vector<SweepPose>& poses = tracker.poses();
    world_T_track = initial_pose * poses.front().at(fractionOf(parameters.pose_instant)).inverse();
    report.corrected_poses = first_poses.correct(poses, world_T_track, fractionOf(parameters.pose_instant));
    if (first_poses.jumped()) {
      report.reason = "poses since the first scan have turned out to be wrong and are corrected: this one jumps";
    }
    map.clear();
    keyframes = 0;
    for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
      const SweepPose pose = inWorld(poses[i]);
      if (i == 0 || parameters.keyframe.isKeyframe(world_T_keyframe, pose.middle)) {
        insertFeatures(first_scans[i], pose);
      }
    }
  }

  // Mapping Building & Distortion Compensation Update (Eq. 12)
  void updateMap(const CloudView& cloud)
  {
    const SweepPose pose = inWorld(tracker.track().pose());
    report.keyframe = prior_map != MapUse::frozen && parameters.keyframe.isKeyframe(world_T_keyframe, pose.middle);
    if (report.keyframe) {
      forgetWhatHasGone(cloud, pose);
      insertFeatures(scan.features, pose);
    }
    report.milliseconds.map += watch.lap();
  }

  void insertFeatures(const FeatureSet& features, const SweepPose& world_T_sensor)
  {
    FeatureSet undistorted;
    compensate(features, SweepMotion(world_T_sensor.twist, 0.5, world_T_sensor.acceleration), undistorted,
               parameters.threads);
    map.insert(undistorted, world_T_sensor.middle, parameters.threads);
    world_T_keyframe = world_T_sensor.middle;
    ++keyframes;
    report.keyframe = true;
  }

  /// Cars and people leave the places where earlier scans saw them. All of a scan's points tell of that, so it is
  /// looked at only now and then.
  void forgetWhatHasGone(const CloudView& cloud, const SweepPose& pose)
  {
    constexpr int kKeyframesBetween = 7;
    if (map.parameters().see_through_range > 0.0 && keyframes % kKeyframesBetween == kKeyframesBetween - 1) {
      map.forgetSeenThrough(
          undistortedSample(cloud, scan.lines, scan.timing, parameters.features, parameters.vertical_correction,
                            SweepMotion(pose.twist, 0.5, pose.acceleration)),
          pose.middle, parameters.threads);
    }
  }

  const OdometryReport& miss(std::optional<double> stamp)
  {
    beginScan(0, stamp);
    return predictOnly("the scan is missing");
  }

  /// A scan that told nothing, or none at all.
  const OdometryReport& predictOnly(const char* reason)
  {
    report.reason = reason;
    const bool started = tracker.hasBegun() || prior_map.has_value();
    first_poses.miss();
    return finish(started ? TrackingState::predicted : TrackingState::not_started);
  }

  const OdometryReport& finish(TrackingState state)
  {
    report.state = state;
    report.world_T_sensor = initial_pose;
    report.provisional = tracker.isAmbiguous();
    if (tracker.isTracking()) {
      report.world_T_sensor = world_T_track * poseNow().at(fractionOf(parameters.pose_instant));
      turnIntoWorld(report, world_T_track);
    }
    if (state == TrackingState::predicted && tracker.isTracking()) {
      report.covariance = turned(predicted().poseCovariance(), world_T_track);
    } else if (state == TrackingState::tracked || state == TrackingState::doubtful) {
      report.covariance = report.registration.covariance;
    }
    first_poses.give(report.world_T_sensor);
    if (tracker.isTracking() && !tracker.isOpen()) {
      first_poses.close();
      first_scans.clear();
    }
    report.milliseconds.total = watch.total();
    return report;
  }

  [[nodiscard]] SweepPose inWorld(const SweepPose& pose) const
  {
    return {world_T_track * pose.middle, pose.twist, pose.acceleration};
  }

  [[nodiscard]] SweepPose poseNow() const
  {
    if (periods == 0.0) {
      return tracker.track().pose();
    }
    const MotionEstimate motion = predicted();
    return {motion.pose(), sweep_fraction * motion.velocity()};
  }

  /// A velocity is not known for ever.
  [[nodiscard]] MotionEstimate predicted() const
  {
    constexpr double kLongest = 10.0;  // periods
    MotionEstimate motion = tracker.track().motion();
    motion.predict(std::min(periods, kLongest));
    return motion;
  }

  void localizeIn(KeyframeVoxelMap given, MapUse use)
  {
    map = std::move(given);
    prior_map = use;
    world_T_keyframe = initial_pose;
    tracker.localizeIn(map.points(FeatureKind::plane), map.points(FeatureKind::edge), initial_pose,
                       use == MapUse::kept_current);
  }
};

}  // namespace pcl_floam
