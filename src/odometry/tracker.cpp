#include "odometry/tracker.h"

#include "filters/straight_runs.h"
#include "motion/rest.h"
#include "odometry/place_evidence.h"

#include <algorithm>

namespace pcl_floam {

namespace {

/// Cells that the first sweep fills, per root of its points: so many points are registered, some 2,000 of a sensor with
/// 16 lasers, and 4,000 of one with 64.
constexpr double kCellsPerRoot = 12.0;
/// Points of one sweep enter the map no closer together than this part of its finest cells' side.
constexpr double kMapSpacing = 0.3;

/// Bad first sweeps must not hold up the rest for ever.
constexpr int kMostFailures = 5;

/// Sweeps after the start's end until which all poses since the first one wait for the direction of time to be found.
constexpr std::size_t kMostToFindDirection = 12;

/// Part of a scan: a pose is in doubt if less lies on surfaces of the map, whatever is usual in the scene.
constexpr double kMostOfTheScan = 0.5;

bool keepsLevel(const DegreesOfFreedom& locked)
{
  return std::equal(locked.begin(), locked.end(), kPlanarMotion.begin(),
                    [](bool is, bool asked) { return is || !asked; });
}

}  // namespace

void Tracker::keepBest()
{
  if (isTracking()) {
    hypotheses_.keepOneOfEachDirection(Preference::likeliest);
    start_.reset();
    may_correct_ = false;
  }
}

void Tracker::place(const SE3& pose)
{
  if (prior_map_) {
    prior_map_->guess = pose;
  }
  for (Hypothesis& hypothesis : hypotheses_.all()) {
    hypothesis.track.place(pose);
  }
}

SE3 Tracker::firstPose(double instant) const
{
  Rest rest;
  for (const SweepPose& pose : poses()) {
    rest.take(pose.at(instant), track().motion().poseCovariance());
  }
  const bool rests = rest.isAtRest() && rest.poses() == static_cast<int>(poses().size());
  return rests ? rest.pose() : poses().front().at(instant);
}

const char* Tracker::reasonToDoubt(ScanLineFailure failure, double explained) const
{
  const bool is_open = start_ && isTracking() && !start_->isDecided();  // how the sensor began to move
  if (is_open && start_->isUndecided(hypotheses_)) {  // for longer than the first sweeps usually need to tell
    return "several motions explain the first scans: the pose may be wrong";
  }
  if (explained < kMostOfTheScan && !is_open) {
    return "the map has no surface for most of the scan: the pose may be wrong";
  }
  if (failure == ScanLineFailure::single_layer && !keepsLevel(settings_.locked)) {
    return "the scan is a single layer: height, roll and pitch may be wrong";
  }
  return nullptr;
}

void Tracker::sample(const ScanReturns& returns, Sweep& sweep)
{
  if (settings_.side == 0.0) {
    settings_.side = sampling_.sideFor(returns, kCellsPerRoot);
  }
  // What scans a single layer draws that again and again.
  const bool is_single_layer = returns.lines.failure == ScanLineFailure::single_layer;
  sweep.is_pattern_new = !returns.lines.valid() && !is_single_layer;
  dense_.sample(returns, kMapSpacing * settings_.side, sweep.dense);
  if (settings_.components.select_points) {
    sweep.sample.clear();
    settings_.components.select_points(sweep.dense, sweep.sample);
  } else {
    sampling_.sample(sweep.dense, settings_.side, sweep.sample);
  }
  sweep.places.clear();
  if (!isTracking() || start_) {
    sweep.places = placesOf(sweep.sample, settings_.side);
  }
  findStraightRuns(returns, sweep.sample);
}

Tracker::Outcome Tracker::step(const Sweep& sweep)
{
  if (!isTracking()) {
    return prior_map_ ? beginInPriorMap(sweep) : beginWithFirstTwo(sweep);
  }
  if (start_ || hypotheses_.size() > 1) {
    return stepAll(sweep);
  }
  Outcome outcome;
  hypotheses_.front().poses.clear();
  outcome.registration = hypotheses_.front().track.step(sweep);
  return outcome;
}

void Tracker::updateMap(const Sweep& sweep)
{
  if (isTracking()) {
    hypotheses_.front().track.updateMap(sweep);
  }
}

Tracker::Outcome Tracker::beginInPriorMap(const Sweep& sweep)
{
  TrackMap map(settings_);
  map.insert(prior_map_->space, prior_map_->edges);
  Outcome outcome;
  for (const TrackSettings& settings : eachDirection(settings_, sweep.is_direction_known)) {
    Track track(settings);
    const SurfaceRegistration found = track.begin(sweep, map, prior_map_->guess, prior_map_->keeps_map);
    if (hypotheses_.empty()) {
      outcome.registration = found;
    }
    if (found.report.hasConverged()) {
      hypotheses_.add({std::move(track), found});
    }
  }
  if (isTracking()) {
    prior_map_.reset();
  }
  return outcome;
}

Tracker::Outcome Tracker::beginWithFirstTwo(const Sweep& sweep)
{
  Outcome outcome;
  if (!start_) {
    start_.emplace(sweep);
    return outcome;
  }
  outcome.registration = start_->findMotion(sweep, settings_, hypotheses_);
  outcome.corrected = may_correct_ = isTracking();
  failed_ = isTracking() ? 0 : failed_ + 1;
  if (failed_ == kMostFailures) {
    failed_ = 0;
    start_.reset();
  }
  return outcome;
}

Tracker::Outcome Tracker::stepAll(const Sweep& sweep)
{
  Outcome outcome;
  const std::size_t before = hypotheses_.front().number;
  const bool goes_on =
      start_ ? start_->step(sweep, hypotheses_) : hypotheses_.step(sweep, Rivals::directions, may_correct_);
  if (!goes_on) {
    outcome.registration = hypotheses_.front().last;
    return outcome;
  }
  if (!start_) {
    hypotheses_.giveUpDirections(kWrongDirection);
  }
  outcome.changed_track = hypotheses_.front().number != before;
  outcome.corrected = may_correct_ && outcome.changed_track;
  if (start_ && start_->isSettled()) {
    start_.reset();
    most_corrected_ = poses().size() + kMostToFindDirection;
    outcome.corrected = true;
  }
  may_correct_ = start_ || (isAmbiguous() && poses().size() < most_corrected_);
  outcome.registration = hypotheses_.front().last;
  outcome.registration.report.target_T_source = track().pose().middle;
  return outcome;
}

}  // namespace pcl_floam
