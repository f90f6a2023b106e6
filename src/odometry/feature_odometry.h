/// \file feature_odometry.h
/// The odometry by features: its stages, scan by scan, and what they remember.
#pragma once

#include "motion/scan_clock.h"
#include "odometry/constant_velocity.h"
#include "odometry/first_motion.h"
#include "odometry/motion_model.h"
#include "odometry/relocalization.h"
#include "odometry/scan_registration.h"
#include "odometry/scan_sample.h"
#include "odometry/start_hypotheses.h"
#include "odometry/stopwatch.h"
#include "odometry/vertical_correction.h"
#include "odometry/waiting_scans.h"

#include <pcl_floam/filters/feature_extractor.h>
#include <pcl_floam/filters/sweep_motion.h>
#include <pcl_floam/odometry/odometry.h>
#include <pcl_floam/registration/feature_registration.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace pcl_floam {

/// A map of fewer keyframes is sparse, and may hold more of the traffic than of the world: until then features
/// are spread. All the way that would cost accuracy.
inline constexpr int kYoungMap = 60;

/// Root mean square distance of the features: what a rotation error is multiplied with.
inline double typicalRange(const FeatureSet& features)
{
  double sum = 0.0;
  for (const Feature& f : features.planes) {
    sum += static_cast<double>(f.x) * f.x + static_cast<double>(f.y) * f.y + static_cast<double>(f.z) * f.z;
  }
  return features.planes.empty() ? 1.0 : std::sqrt(sum / static_cast<double>(features.planes.size()));
}

/// Within the pipeline, every pose is the sensor's at \ref kReference of its sweep. Other instants are derived when
/// poses are given out.
struct FeatureOdometry {
  explicit FeatureOdometry(const OdometryParameters& p)
      : parameters(p), map(p.map), clock(p.scan_period), motion(p.compensation)
  {
    // Five points of a finer map lie closer together.
    constexpr double kVoxelsWide = 0.25;
    double& plane_width = parameters.registration.plane_width;
    plane_width = std::min(plane_width, kVoxelsWide * parameters.map.plane_voxel_size);
  }

  OdometryParameters parameters;
  KeyframeVoxelMap map;
  ScanClock clock;
  MotionModel motion;
  SE3 initial_pose;      ///< of the first scan, at the instant of the parameters
  SE3 world_T_keyframe;  ///< last keyframe
  bool started = false;
  int failed_starts = 0;
  int keyframes = 0;
  std::optional<MapUse> prior_map;  ///< of a map that was there before the first scan

  ScanLines lines;
  ScanTiming timing;
  FeatureSet measured;          ///< E_k and S_k as measured
  FeatureSet undistorted;       ///< compensated to the reference instant
  FeatureSet first;             ///< the first scan as measured, until its motion is known
  WaitingScans waiting;         ///< until then
  double periods = 1.0;         ///< since the last scan
  double sweep_fraction = 1.0;  ///< duration of the sweep in periods
  SE3 world_T_predicted;
  double prediction_bound = 0.0;  ///< m, of its error
  OdometryReport report;
  Stopwatch watch;
  StartHypotheses starts;  ///< open for the first scans, if these are ambiguous
  ScanRegistration scan_registration;

  const OdometryReport& track(const CloudView& scan, std::optional<double> stamp)
  {
    beginScan(scan.size, stamp);
    extractFeatures(scan);
    if (!hasEnoughFeatures()) {
      return seeNothing(lines.valid() ? "too few features" : toString(lines.failure));
    }
    if (!started) {
      return start();
    }
    if (!motion.isKnown() && !prior_map && !findFirstMotion()) {
      return startAgain();
    }
    if (hasStartedOtherwise()) {
      return finish(TrackingState::tracked);
    }
    predictMotion();
    estimatePose();
    if (!report.registration.hasConverged()) {
      return predictOnly(toString(report.registration.termination));
    }
    updateMap(scan);
    return finish(TrackingState::tracked);
  }

  void beginScan(std::size_t points, std::optional<double> stamp)
  {
    report = OdometryReport();
    report.points = points;
    watch.start();
    periods = clock.tick(stamp);
    if (started) {
      motion.elapse(periods);
      waiting.elapse(periods);
    }
  }

  // Sensor Model and Feature Extraction
  void extractFeatures(const CloudView& scan)
  {
    findScanLines(scan, parameters.sensor, parameters.scan_line_source, lines, parameters.threads);
    timing = findScanTiming(scan, lines, parameters.timing_source, parameters.rotation, parameters.threads);
    sweep_fraction = 1.0;
    if (timing.duration > 0.0 && clock.period() > 0.0) {
      sweep_fraction = std::min(1.0, timing.duration / clock.period());
    }
    motion.setSweep(sweep_fraction, timing.valid());
    report.milliseconds.scan_lines = watch.lap();

    pcl_floam::extractFeatures(scan, lines, timing, parameters.features, measured, {}, parameters.threads);
    correctVerticalAngle(parameters.vertical_correction, measured);
    report.milliseconds.features = watch.lap();

    report.structure = lines.valid() ? ScanStructure::scan_lines : ScanStructure::space;
    report.scan_line_failure = lines.failure;
    report.scan_line_source = lines.source;
    report.scan_line_confidence = lines.confidence;
    report.scan_lines = lines.lines();
    report.timing_source = timing.source;
    report.edges = measured.edges.size();
    report.planes = measured.planes.size();
  }

  [[nodiscard]] bool hasEnoughFeatures() const
  {
    return static_cast<int>(measured.edges.size() + measured.planes.size()) >=
           parameters.registration.min_correspondences;
  }

  // Motion Estimation (Eq. 2)
  void predictMotion()
  {
    constexpr double kLong = 3.5;         // periods: a car's motion is known for longer, a hand's is not
    constexpr double kRelocalized = 0.3;  // m
    world_T_predicted = motion.predictedPose();
    prediction_bound = motion.predictionBound();
    if (motion.isKnown() && motion.periodsSinceTracked() > kLong) {
      world_T_predicted = relocalize(measured, target(), registrationFrom(world_T_predicted), parameters.registration,
                                     motion.trackedPose());
      prediction_bound = kRelocalized;
    }
  }

  // Pose Estimation (Eq. 5 to 14)
  void estimatePose()
  {
    report.registration = scan_registration.registerScan(measured, target(), registrationFrom(world_T_predicted),
                                                         parameters.registration);
    report.crowded = scan_registration.usedSpreadFeatures();
    report.milliseconds.registration += watch.lap();
  }

  [[nodiscard]] FeatureTarget target() { return {&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)}; }

  RegistrationRun registrationFrom(const SE3& guess)
  {
    RegistrationRun run;
    run.guess = guess;
    run.guess_uncertainty = prediction_bound;
    run.threads = parameters.threads;
    run.sweep = motion.sweepModel(guess);
    const bool is_young = !prior_map && keyframes < kYoungMap;
    run.spread_features = is_young;
    run.sparse_target = is_young;
    return run;
  }

  /// The second scan: its motion and the first one's are found together, and the map is built anew with them.
  /// \return false when they can't be found; with a registration that has converged, when there are several too far
  /// apart
  bool findFirstMotion()
  {
    // With scans missing between, the candidates of an ambiguous start lie too far apart.
    constexpr double kTooLong = 1.5;
    const FirstScans scans{first, measured, std::max(motion.periodsSinceTracked(), 1e-3), motion.compensatedFraction(),
                           kReference};
    const auto found = pcl_floam::findFirstMotion(scans, parameters, report.registration);
    report.milliseconds.registration += watch.lap();
    if (!found || (!found->others.empty() && motion.periodsSinceTracked() > kTooLong)) {
      return false;
    }
    const FirstScan first_scan{first, initial_pose, motion, waiting.first(), waiting.others()};
    StartHypothesis start = startWith(found->twist, first_scan, parameters);
    if (!found->others.empty()) {
      starts = StartHypotheses(first_scan, start, found->others, parameters);
      // There may be more traffic than world, such as a lorry beside the sensor.
      scan_registration.suspectCrowding();  // from this scan on
    }
    correctPoses(start.poses);
    goOnFrom(std::move(start));
    report.milliseconds.registration += watch.lap();
    return true;
  }

  /// Whether the scans so far have shown that the drive began with another motion than was found.
  bool hasStartedOtherwise()
  {
    if (!starts.areOpen()) {
      return false;
    }
    auto start = starts.track({measured, periods, sweep_fraction, timing.valid(), typicalRange(measured)}, parameters);
    report.milliseconds.registration += watch.lap();
    if (start) {
      report.registration = start->registration;
      report.keyframe = start->keyframe;
      report.reason = "poses since the first scan have turned out to be wrong and are corrected: this one jumps";
      start->poses.pop_back();  // this scan's own
      correctPoses(start->poses);
      goOnFrom(std::move(*start));
      report.crowded = true;                // starts are followed with spread features
      scan_registration.suspectCrowding();  // what was compared so far was so in another map
    }
    return start.has_value();
  }

  void correctPoses(const std::vector<SE3>& poses)
  {
    report.corrected_poses = poses;
    if (!poses.empty() && report.reason.empty()) {
      report.reason = "only now a motion is known: the poses of scans since the first one are corrected";
    }
  }

  void goOnFrom(StartHypothesis start)
  {
    motion = start.motion;
    map = std::move(start.map);
    world_T_keyframe = start.world_T_keyframe;
    keyframes = start.keyframes;
  }

  // Mapping Building & Distortion Compensation Update (Eq. 12)
  void updateMap(const CloudView& scan)
  {
    motion.update(report.registration, world_T_predicted, typicalRange(measured));
    report.keyframe = prior_map != MapUse::frozen && parameters.keyframe.isKeyframe(world_T_keyframe, motion.pose());
    if (report.keyframe) {
      // The map takes the sweep as it was registered, not with its turn refined (SweepTurn): the poses are those that
      // fit the former.
      compensate(measured, motion.sweep(), undistorted, parameters.threads);
      report.milliseconds.compensation += watch.lap();
      forgetWhatHasGone(scan);
      map.insert(undistorted, motion.pose(), parameters.threads);
      if (!prior_map) {  // what an earlier map is kept up to date with counts for less than the map
        motion.enterMap();
      }
      world_T_keyframe = motion.pose();
      ++keyframes;
    }
    report.milliseconds.map += watch.lap();
  }

  /// Cars and people leave the places where earlier scans saw them. All of a scan's points tell of that, so it is
  /// looked at only now and then.
  void forgetWhatHasGone(const CloudView& scan)
  {
    constexpr int kKeyframesBetween = 7;
    if (map.parameters().see_through_range > 0.0 && keyframes % kKeyframesBetween == kKeyframesBetween - 1) {
      map.forgetSeenThrough(
          undistortedSample(scan, lines, timing, parameters.features, parameters.vertical_correction, motion.sweep()),
          motion.pose(), parameters.threads);
    }
  }

  /// The first usable scan.
  const OdometryReport& start()
  {
    waiting = WaitingScans();
    return beginWithThis();
  }

  /// The first usable scan after the one whose pose is given, or that one.
  const OdometryReport& beginWithThis()
  {
    started = true;
    first = measured;
    motion.begin(initial_pose);
    map.clear();
    map.insert(first, motion.pose());
    world_T_keyframe = motion.pose();
    report.keyframe = true;
    report.milliseconds.map += watch.lap();
    return finish(TrackingState::initialized);
  }

  /// A scan that could not be registered with the first one. A bad first scan must not hold up the rest for ever.
  const OdometryReport& startAgain()
  {
    constexpr int kMaxFailures = 5;
    if (report.registration.hasConverged()) {
      report.registration = RegistrationReport();
      waiting.beginWithLast();
      beginWithThis();
      report.reason =
          "started again, since scans are missing between the first one and this one, which fits it in several ways";
      return report;
    }
    const char* reason = toString(report.registration.termination);
    if (++failed_starts < kMaxFailures) {
      return predictOnly(reason);
    }
    failed_starts = 0;
    start();
    report.reason = std::string("started again, since the first scan was never matched: ") + reason;
    return report;
  }

  const OdometryReport& miss(std::optional<double> stamp)
  {
    beginScan(0, stamp);
    return seeNothing("the scan is missing");
  }

  void localizeIn(KeyframeVoxelMap given, MapUse use)
  {
    map = std::move(given);
    prior_map = use;
    started = true;
    motion.begin(initial_pose);
    world_T_keyframe = initial_pose;
  }

  /// A scan without features, or none at all.
  const OdometryReport& seeNothing(const char* reason)
  {
    starts.miss(periods, parameters);
    return predictOnly(reason);
  }

  const OdometryReport& predictOnly(const char* reason)
  {
    report.reason = reason;
    if (!started) {
      return finish(TrackingState::not_started);
    }
    motion.carryOn();
    if (!motion.isKnown() && !prior_map) {
      waiting.add();
    }
    return finish(TrackingState::predicted);
  }

  const OdometryReport& finish(TrackingState state)
  {
    report.state = state;
    report.covariance = motion.covariance();
    report.world_T_sensor = started ? motion.poseAt(fractionOf(parameters.pose_instant)) : initial_pose;
    report.provisional = starts.areOpen();
    report.milliseconds.total = watch.total();
    return report;
  }
};

}  // namespace pcl_floam
