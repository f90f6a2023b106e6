#include "odometry/start_hypotheses.h"

#include "odometry/first_motion.h"

#include <pcl_floam/filters/motion_compensation.h>
#include <pcl_floam/registration/feature_registration.h>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// After so many scans it must be clear; it may be plain from as few as these on.
constexpr int kMostScans = 8;
constexpr int kFewestScans = 4;
/// A start must explain the scans by so many times as much as the one that was found.
constexpr double kClearly = 1.25;
constexpr double kPlainly = 2.0;
/// And, to be plain, by so many times as much as any other.
constexpr double kAlone = 1.2;

/// Motions that differ by more are two, m per period.
constexpr double kApart = 0.5;

bool areApart(const Vector6& a, const Vector6& b)
{
  return (a - b).head<3>().norm() > kApart;
}

/// How many features are explained: those with such residuals count half.
double explainedBy(const RegistrationReport& registration)
{
  constexpr double kHalf = 0.02;  // m; 0.01 and 0.03 differ in 2 of 60 starts
  if (!registration.hasConverged()) {
    return 0.0;
  }
  const double residual = registration.residual_rms / kHalf;
  return (registration.edge_correspondences + registration.plane_correspondences) / (1.0 + residual * residual);
}

/// Whether a start can be trusted: its motion has stayed what it was, and the scans tell how far it has come. Along a
/// way of which nothing can be seen, any motion would do.
bool isTrustworthy(const StartHypothesis& start)
{
  constexpr double kFarthestOff = 0.06;  // m, one standard deviation
  const Vector6& twist = start.motion.twist();
  const RegistrationReport& last = start.registration;
  if (!last.hasConverged() || !last.weak_directions.empty() || areApart(twist, start.twist)) {
    return false;
  }
  const Eigen::Vector3d along = (last.target_T_source.rotation * twist.head<3>()).normalized();
  return along.dot(last.covariance.topLeftCorner<3, 3>() * along) < kFarthestOff * kFarthestOff;
}

/// Registers spread features of a scan in the start's own map, and adds the scan to that.
void trackWith(const FeatureSet& measured, const FeatureSet& sample, double typical_range,
               const OdometryParameters& parameters, StartHypothesis& start)
{
  constexpr double kUncertainty = 0.3;  // m; at first the model allows for metres, and traffic would draw any to itself
  const SE3 predicted = start.motion.predictedPose();
  RegistrationRun run;
  run.guess = predicted;
  run.guess_uncertainty = kUncertainty;
  run.threads = parameters.threads;
  run.sweep = start.motion.sweepModel(predicted);
  run.sparse_target = true;
  const FeatureTarget target{&start.map.search(FeatureKind::edge), &start.map.search(FeatureKind::plane)};
  start.registration = registerFeatures(sample, target, run, parameters.registration);
  start.keyframe = false;
  if (!start.registration.hasConverged()) {
    start.motion.carryOn();
    return;
  }
  start.motion.update(start.registration, predicted, typical_range);
  start.keyframe = parameters.keyframe.isKeyframe(start.world_T_keyframe, start.motion.pose());
  if (start.keyframe) {
    FeatureSet undistorted;
    compensate(measured, start.motion.sweep(), undistorted);
    start.map.insert(undistorted, start.motion.pose(), parameters.threads);
    start.motion.enterMap();
    start.world_T_keyframe = start.motion.pose();
    ++start.keyframes;
  }
}

}  // namespace

StartHypothesis startWith(const Vector6& twist, const FirstScan& first, const OdometryParameters& parameters)
{
  const SweepMotion sweep(first.motion.compensatedFraction() * twist, kReference);
  StartHypothesis start{twist, first.motion, KeyframeVoxelMap(parameters.map), SE3()};
  start.motion.setFirst(first.pose * sweep.at(fractionOf(parameters.pose_instant)).inverse(), twist);
  start.world_T_keyframe = start.motion.pose();
  FeatureSet undistorted;
  compensate(first.features, sweep, undistorted);
  start.map.insert(undistorted, start.world_T_keyframe);
  return start;
}

void StartHypotheses::elapse(double periods)
{
  for (StartHypothesis& start : starts_) {
    start.motion.elapse(periods);
  }
}

void StartHypotheses::setSweep(double fraction, bool has_times)
{
  for (StartHypothesis& start : starts_) {
    start.motion.setSweep(fraction, has_times);
  }
}

void StartHypotheses::carryOn()
{
  for (StartHypothesis& start : starts_) {
    start.motion.carryOn();
  }
}

const StartHypothesis* StartHypotheses::track(const FeatureSet& measured, const MotionModel& motion,
                                              double typical_range, const OdometryParameters& parameters)
{
  if (!areOpen()) {
    return nullptr;
  }
  const FeatureSet sample = startSample(measured);
  for (StartHypothesis& start : starts_) {
    trackWith(measured, sample, typical_range, parameters, start);
    if (scans_ > 0) {  // at the first one every map holds a single scan, and what stays near it fits best
      start.explained += explainedBy(start.registration);
    }
  }
  ++scans_;
  dropThoseNearFound();
  const StartHypothesis* choice = decide(motion);
  if (choice == nullptr && scans_ < kMostScans) {
    return nullptr;
  }
  chosen_.clear();
  if (choice != nullptr) {
    chosen_.push_back(*choice);
  }
  starts_.clear();
  return chosen_.empty() ? nullptr : &chosen_.front();
}

/// Those that have come to the motion of the start that was found are that one, with a map that their way there has
/// filled: they would explain more than it does.
void StartHypotheses::dropThoseNearFound()
{
  const Vector6 found = starts_.front().motion.twist();
  const auto is_near = [&found](const StartHypothesis& start) { return !areApart(start.motion.twist(), found); };
  starts_.erase(std::remove_if(starts_.begin() + 1, starts_.end(), is_near), starts_.end());
}

const StartHypothesis* StartHypotheses::decide(const MotionModel& motion) const
{
  if (scans_ < kFewestScans) {
    return nullptr;
  }
  if (scans_ < kMostScans) {
    const StartHypothesis* plain = betterThanFound(kPlainly);
    return plain != nullptr && isAlone(*plain) ? plain : nullptr;
  }
  const StartHypothesis* clear = betterThanFound(kClearly);
  const StartHypothesis& found = starts_.front();
  // The start may have been right and the odometry, which also registers crowded features, have lost it.
  const bool was_left = isTrustworthy(found) && areApart(found.motion.twist(), motion.twist());
  return clear == nullptr && was_left ? &found : clear;
}

/// The one that explains the most, if that is so many times as much.
const StartHypothesis* StartHypotheses::betterThanFound(double times) const
{
  const StartHypothesis* best = nullptr;
  double most = times * starts_.front().explained;
  for (const StartHypothesis& start : starts_) {
    if (start.explained > most && isTrustworthy(start)) {
      best = &start;
      most = start.explained;
    }
  }
  return best;
}

/// Whether none with another motion comes close.
bool StartHypotheses::isAlone(const StartHypothesis& start) const
{
  return std::none_of(starts_.begin(), starts_.end(), [&start](const StartHypothesis& other) {
    return areApart(other.motion.twist(), start.motion.twist()) && kAlone * other.explained > start.explained;
  });
}

}  // namespace pcl_floam
