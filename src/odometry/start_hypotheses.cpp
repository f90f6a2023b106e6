#include "odometry/start_hypotheses.h"

#include "odometry/first_motion.h"
#include "registration/feature_sampling.h"

#include <pcl_floam/filters/motion_compensation.h>
#include <pcl_floam/registration/feature_registration.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// After so many scans with features it must be clear; decided much earlier, a false motion may still lead.
constexpr std::size_t kScans = 8;
/// So much smaller must a start's residuals be than those of the one that was found.
constexpr double kClearly = 0.87;

/// With what was missing between, so many: after that the start is left as it is.
constexpr std::size_t kMostScansInAll = 20;

/// How badly the last few scans fitted, m.
///
/// How many features find a surface says nothing: the map of a false motion is full of them, that of a sensor which
/// stands has the same few rings again and again.
double updatedResidual(double residual, const RegistrationReport& registration)
{
  constexpr double kMemory = 0.6;
  constexpr double kUnmatched = 1.0;  // m
  const double last = registration.hasConverged() ? registration.residual_rms : kUnmatched;
  return std::sqrt(kMemory * residual * residual + (1.0 - kMemory) * last * last);
}

/// Whether the scans tell how far a start has come: along a way of which nothing can be seen, any motion would do.
bool isSeen(const StartHypothesis& start)
{
  constexpr double kFarthestOff = 0.06;  // m, one standard deviation
  const RegistrationReport& last = start.registration;
  if (!last.hasConverged() || !last.weak_directions.empty()) {
    return false;
  }
  const Eigen::Vector3d along = (last.target_T_source.rotation * start.motion.twist().head<3>()).normalized();
  return along.dot(last.covariance.topLeftCorner<3, 3>() * along) < kFarthestOff * kFarthestOff;
}

/// Registers spread features of a scan in the start's own map, and adds the scan to that.
void trackWith(const NextScan& scan, const OdometryParameters& parameters, StartHypothesis& start)
{
  constexpr double kUncertainty = 0.3;  // m; at first the model allows for metres, and traffic would draw any to itself
  const SE3 predicted = start.motion.predictedPose();
  RegistrationRun run;
  run.guess = predicted;
  run.guess_uncertainty = kUncertainty * std::max(1.0, start.motion.periodsSinceTracked());
  run.threads = parameters.threads;
  run.sweep = start.motion.sweepModel(predicted);
  run.sparse_target = true;
  const FeatureTarget target{&start.map.search(FeatureKind::edge), &start.map.search(FeatureKind::plane)};
  start.registration = registerFeatures(scan.sample, target, run, parameters.registration);
  start.keyframe = false;
  if (!start.registration.hasConverged()) {
    start.motion.carryOn();
    return;
  }
  start.motion.update(start.registration, predicted, scan.typical_range);
  start.keyframe = parameters.keyframe.isKeyframe(start.world_T_keyframe, start.motion.pose());
  if (start.keyframe) {
    FeatureSet undistorted;
    compensate(scan.measured, start.motion.sweep(), undistorted, parameters.threads);
    start.map.insert(undistorted, start.motion.pose(), parameters.threads);
    start.motion.enterMap();
    start.world_T_keyframe = start.motion.pose();
    ++start.keyframes;
  }
}

/// Goes on with a start, to the second scan or a later one.
void follow(const NextScan& scan, bool is_second, const OdometryParameters& parameters, StartHypothesis& start)
{
  if (!is_second) {
    start.motion.elapse(scan.periods);
  }
  if (scan.sawNothing()) {
    start.motion.carryOn();
  } else {
    start.motion.setSweep(scan.sweep_fraction, scan.has_times);
    trackWith(scan, parameters, start);
    start.residual = updatedResidual(start.residual, start.registration);
  }
  start.poses.push_back(start.motion.poseAt(fractionOf(parameters.pose_instant)));
}

}  // namespace

StartHypothesis startWith(const Vector6& twist, const FirstScan& first, const OdometryParameters& parameters)
{
  const SweepMotion sweep(first.motion.compensatedFraction() * twist, kReference);
  StartHypothesis start{first.motion, KeyframeVoxelMap(parameters.map), SE3()};
  const SE3 pose = first.pose * exp(first.periods_since_pose * twist);
  start.motion.setFirst(pose * sweep.at(fractionOf(parameters.pose_instant)).inverse(), twist);
  start.world_T_keyframe = start.motion.pose();
  for (const double periods : first.others) {
    start.poses.push_back(first.pose * exp(periods * twist));
  }
  FeatureSet undistorted;
  compensate(first.features, sweep, undistorted);
  start.map.insert(undistorted, start.world_T_keyframe);
  return start;
}

StartHypotheses::StartHypotheses(FirstScan first, StartHypothesis found, const std::vector<Vector6>& others,
                                 const OdometryParameters& parameters)
    : first_(std::move(first))
{
  starts_.push_back(std::move(found));
  for (const Vector6& other : others) {
    starts_.push_back(startWith(other, first_, parameters));
  }
}

void StartHypotheses::miss(double periods, const OdometryParameters& parameters)
{
  if (!areOpen()) {
    return;
  }
  NextScan nothing;
  nothing.periods = periods;
  followWithEach(std::move(nothing), parameters);
  if (scans_.size() >= kMostScansInAll) {
    *this = StartHypotheses();
  }
}

void StartHypotheses::followWithEach(NextScan scan, const OdometryParameters& parameters)
{
  seen_ += scan.sawNothing() ? 0 : 1;
  scan.sample = spreadSample(scan.measured);
  scans_.push_back(std::move(scan));
  for (StartHypothesis& start : starts_) {
    follow(scans_.back(), scans_.size() == 1, parameters, start);
  }
}

std::optional<StartHypothesis> StartHypotheses::track(NextScan scan, const OdometryParameters& parameters)
{
  if (!areOpen()) {
    return std::nullopt;
  }
  followWithEach(std::move(scan), parameters);
  dropOthers();
  std::optional<StartHypothesis> chosen;
  if (seen_ >= kScans) {
    if (const StartHypothesis* best = betterThanFound()) {
      chosen = onceMore(*best, parameters);
    }
  }
  if (seen_ >= kScans || starts_.size() == 1) {
    *this = StartHypotheses();
  }
  return chosen;
}

/// Those that have come to the motion of the start that was found are that one, with a map that their way there has
/// filled: they would fit better than it does. And those that fit far worse need not be followed: mostly all but one
/// after the first scan, or these eight scans would be the slow ones of every drive along a road.
void StartHypotheses::dropOthers()
{
  constexpr double kHopelessAtFirst = 2.5;
  constexpr double kHopeless = 2.0;
  const StartHypothesis& found = starts_.front();
  const Vector6 twist = found.motion.twist();
  const double most = (seen_ < 2 ? kHopelessAtFirst : kHopeless) * found.residual;
  const auto is_out = [&](const StartHypothesis& start) {
    return !areApart(start.motion.twist(), twist) || start.residual > most;
  };
  starts_.erase(std::remove_if(starts_.begin() + 1, starts_.end(), is_out), starts_.end());
}

/// The one that fits best, if it does so clearly.
const StartHypothesis* StartHypotheses::betterThanFound() const
{
  const StartHypothesis* best = nullptr;
  double least = kClearly * starts_.front().residual;
  for (const StartHypothesis& start : starts_) {
    if (start.residual < least && isSeen(start)) {
      best = &start;
      least = start.residual;
    }
  }
  return best;
}

/// From the first scan again, with the motion that is known by now: what it began with may have been off by a tenth,
/// and its first scans by metres.
StartHypothesis StartHypotheses::onceMore(const StartHypothesis& start, const OdometryParameters& parameters) const
{
  constexpr double kWorse = 2.0;
  StartHypothesis again = startWith(start.motion.twist(), first_, parameters);
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    follow(scans_[i], i == 0, parameters, again);
  }
  const bool is_same = isSeen(again) && !areApart(again.motion.twist(), start.motion.twist());
  return is_same && again.residual < kWorse * start.residual ? again : start;
}

}  // namespace pcl_floam
