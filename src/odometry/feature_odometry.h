/// \file feature_odometry.h
/// The odometry by features: the paper's own pipeline, section by section.
#pragma once

#include "motion/motion_estimate.h"
#include "motion/sweep_pose.h"
#include "odometry/odometry_run.h"

#include <pcl_floam/registration/core/feature_registration.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace pcl_floam {

/// Within the pipeline, poses are those of mid-sweep: there an error of the assumed motion moves the sweep's two halves
/// apart but not its pose, which at the end (the paper's instant) the next motion would take up with the opposite sign.
struct FeatureOdometry : OdometryRun {
  static constexpr double kErrors = 3.0;    ///< standard deviations that the prediction may be off ...
  static constexpr double kFarthest = 3.0;  ///< ... and m
  /// Periods: what moves in less cannot be told from the poses' errors.
  static constexpr double kShortest = 0.5;

  FeatureOdometry(const OdometryParameters& p, const OdometryComponents& c) : OdometryRun(p, c)
  {
    map_building.chooseKeyframesBy(c.is_keyframe);
  }

  MotionEstimate motion;  ///< at the last scan that was registered
  SweepPose pose;         ///< of that scan
  bool started = false;
  bool is_placed = true;            ///< else the pose is a guess, in a map that was made before
  std::optional<FeatureSet> first;  ///< the first scan, until its motion is known with the second
  int scans_to_wait = 0;            ///< until the map takes in scans again
  int failed_starts = 0;

  void track(const CloudView& cloud, std::optional<double> stamp)
  {
    beginScan(cloud.size, stamp);
    extractFeatures(cloud);
    if (static_cast<int>(scan.features.edges.size() + scan.features.planes.size()) < kFewestCorrespondences) {
      return predictOnly(scan.lines.valid() ? "too few features" : toString(scan.lines.failure));
    }
    if (!started) {
      return start();
    }
    const MotionEstimate predicted = first ? findFirstMotion() : predictMotion();
    estimatePose(predicted, std::min(kFarthest, kErrors * positionError(predicted)));
    if (!report.registration.hasConverged()) {
      return first ? failToStart() : predictOnly(toString(report.registration.termination));
    }
    noteTold(report.registration.covariance, std::nullopt);  // a hint moves the guess alone
    updateMotion(predicted);
    updateMap(cloud);
    report.milliseconds.map += watch.lap();
    finish(toldState());
  }

  void localizeIn(KeyframeVoxelMap given, MapUse use)
  {
    map_building.begin(std::move(given), use, initial_pose);
    beginNear(initial_pose);
    started = true;
  }

  void setPose(const SE3& world_T_sensor)
  {
    rest = Rest();
    hint.placeNext();
    if (!started || first) {
      initial_pose = world_T_sensor;
      forgetFirstMotion();
      return;
    }
    beginNear(world_T_sensor);
  }

  /// In the map that there is.
  void beginNear(const SE3& world_T_sensor)
  {
    motion = MotionEstimate(world_T_sensor);
    told_motion.forget();
    pose = {world_T_sensor};
    periods = periods_error = 0.0;
    is_placed = false;
  }

  void forgetFirstMotion()
  {
    motion = MotionEstimate(initial_pose);
    pose = {initial_pose};
    if (first) {
      beginMap(Vector6::Zero());
    }
  }

  // Sensor Model and Feature Extraction
  void extractFeatures(const CloudView& cloud)
  {
    scan.findStructure(cloud, parameters, clock.period());
    report.milliseconds.scan_lines = watch.lap();
    scan.takeFeatures(cloud, parameters);
    report.milliseconds.features = watch.lap();
    describeScan();
  }

  /// The map begins with the first scan.
  void start()
  {
    started = true;
    failed_starts = 0;
    reachScan();
    first = scan.features;
    motion = MotionEstimate(initial_pose);
    pose = {initial_pose};
    map_building.clear();
    report.keyframe = map_building.add(*first, pose, parameters);
    report.milliseconds.map += watch.lap();
    finish(TrackingState::initialized);
  }

  /// A bad first scan must not hold up the rest for ever.
  void failToStart()
  {
    constexpr int kMostFailures = 5;
    if (++failed_starts < kMostFailures) {
      forgetFirstMotion();
      return predictOnly(toString(report.registration.termination));
    }
    start();
    report.reason = "started again, since the first scan was never matched";
  }

  // Motion Estimation (Eq. 2)
  [[nodiscard]] MotionEstimate predictMotion() const { return predictedFrom(motion, periods); }

  /// The first two scans share one unknown motion: the map begins anew with the first, undistorted with what is known
  /// of it by now, and the second is registered with that, looking less and less far.
  MotionEstimate findFirstMotion()
  {
    constexpr int kRounds = 4;
    constexpr double kFar = 2.0;  // m
    MotionEstimate predicted = predictMotion();
    double far = kFar;
    for (int round = 0; round < kRounds; ++round, far *= 0.5) {
      estimatePose(predicted, far);
      if (!report.registration.hasConverged()) {
        break;
      }
      const Vector6 velocity =
          log(pose.middle.inverse() * report.registration.target_T_source) / std::max(periods, kShortest);
      beginMap(scan.sweep_fraction * velocity);
      motion = MotionEstimate(pose.middle, velocity);
      predicted = predictMotion();
    }
    return predicted;
  }

  /// The first scan, with the motion during it, at the pose that is given for an instant of it.
  void beginMap(const Vector6& twist)
  {
    const SweepPose moved{SE3(), twist};
    pose = {initial_pose * moved.at(fractionOf(parameters.pose_instant)).inverse(), twist};
    map_building.clear();
    map_building.add(*first, pose, parameters);
  }

  // Distortion Compensation, first stage, and Pose Estimation (Eq. 3 to 14)
  /// \param far m, that the prediction may be off
  void estimatePose(const MotionEstimate& predicted, double far)
  {
    RegistrationRun run;
    run.guess = predicted.pose();
    run.guess_uncertainty = far;
    run.threads = parameters.threads;
    run.sweep = sweepModel(predicted.velocity());
    run.factors = components.factors;
    const KeyframeVoxelMap& map = map_building.map();
    report.registration = registerFeatures(
        scan.features, {&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)}, run, parameters.registration);
    report.milliseconds.registration += watch.lap();
  }

  [[nodiscard]] static double positionError(const MotionEstimate& motion)
  {
    return std::sqrt(motion.poseCovariance().topLeftCorner<3, 3>().trace());
  }

  [[nodiscard]] SweepModel sweepModel(const Vector6& velocity) const
  {
    constexpr double kMidSweep = 0.5;
    SweepModel model;
    model.reference = kMidSweep;
    model.twist = scan.sweep_fraction * velocity;
    if (parameters.compensation != CompensationMode::two_stage && is_placed && periods >= kShortest) {
      model.follows_pose = true;
      model.held_pose = pose.middle;
      model.sweep_per_motion = scan.sweep_fraction / periods;
    }
    return model;
  }

  // Distortion Compensation, second stage (Eq. 12)
  void updateMotion(const MotionEstimate& predicted)
  {
    const SE3 last = is_placed ? pose.middle : report.registration.target_T_source;
    first.reset();
    motion = predicted;
    sweep_fraction = scan.sweep_fraction;
    if (is_placed) {
      motion.correct(report.registration.target_T_source, report.registration.covariance);
    } else {
      motion = MotionEstimate(report.registration.target_T_source);
      is_placed = true;
      scans_to_wait = kSweepsUntilKnown;
    }
    pose = {report.registration.target_T_source, report.registration.sweep_twist};
    if (parameters.compensation == CompensationMode::two_stage && periods >= kShortest) {
      pose.twist = scan.sweep_fraction / periods * log(last.inverse() * pose.middle);
    }
    reachScan();
  }

  /// Where the pose was given, once the velocity is known.
  void updateMap(const CloudView& cloud)
  {
    if (scans_to_wait > 0) {
      --scans_to_wait;
    } else {
      report.keyframe = map_building.add(cloud, scan, pose, parameters);
    }
  }

  /// A scan that told nothing, or none at all.
  void predictOnly(const char* reason)
  {
    report.reason = reason;
    report.scan_only_deviation = ToldMotion::kNothing;
    finish(started ? TrackingState::predicted : TrackingState::not_started);
  }

  void finish(TrackingState state)
  {
    const double instant = fractionOf(parameters.pose_instant);
    report.state = state;
    report.world_T_sensor = started ? pose.at(instant) : initial_pose;
    if (state == TrackingState::tracked || state == TrackingState::doubtful) {
      MotionEstimate found = motion;
      found.place(pose.middle, report.registration.covariance);
      report.covariance = covarianceAtInstant(found, sweep_fraction);
    }
    if (state == TrackingState::predicted) {
      const MotionEstimate predicted = predictedFrom(motion, periodsKnown());
      report.world_T_sensor = SweepPose{predicted.pose(), sweep_fraction * predicted.velocity()}.at(instant);
      report.covariance = covarianceAtInstant(predicted, sweep_fraction);
    } else if (state == TrackingState::doubtful) {
      report.covariance.topLeftCorner<3, 3>() += told_motion.open();
    }
    noteRest();
    report.milliseconds.total = watch.total();
  }
};

}  // namespace pcl_floam
