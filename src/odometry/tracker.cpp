#include "odometry/tracker.h"

#include "common/side_by_side.h"
#include "odometry/backward_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// Cells that the first sweep fills, per root of its points: so many points are registered, some 2,000 of a sensor with
/// 16 lasers, and 4,000 of one with 64.
constexpr double kCellsPerRoot = 12.0;
/// Points of one sweep enter the map no closer together than this part of its finest cells' side.
constexpr double kMapSpacing = 0.3;
/// Sweeps until it is decided how it began: if one motion is left by then, and at most.
constexpr std::size_t kFirstSweeps = 12;
constexpr std::size_t kMostFirstSweeps = 4 * kFirstSweeps;
/// A track whose evidence is so much less than the best one's is given up, for each point of a sweep, since the errors
/// that lead astray are shared by points: false ones lead by less while the map is young, and fall behind by more where
/// a scene is clear.
constexpr double kHopeless = 0.1;

/// The same in all of a direction of time, once it is settled how the sensor began to move: of the last five sweeps or
/// so, in which nothing else differs, maps included.
constexpr double kWrongDirection = 15.0;

/// Sweeps after which the poses since the first one stay, whichever direction of time turns out to be right.
constexpr std::size_t kMostCorrected = 2 * kFirstSweeps;

/// So many are followed for each direction of time.
constexpr std::ptrdiff_t kMostHypotheses = 4;

double hopeless(const Sweep& sweep)
{
  return kHopeless * static_cast<double>(sweep.sample.size());
}

std::vector<SE3> middlesOf(const std::vector<SweepPose>& poses)
{
  std::vector<SE3> middles(poses.size());
  std::transform(poses.begin(), poses.end(), middles.begin(), [](const SweepPose& pose) { return pose.middle; });
  return middles;
}

}  // namespace

/// Whether most of the first sweeps do not tell of a direction, and nobody else did.
bool Tracker::leavesNoTrace() const
{
  const bool is_told =
      std::any_of(kept_.begin(), kept_.end(), [](const Sweep& sweep) { return sweep.hint.has_value(); });
  return 2 * hypotheses_.front().without_trace > kept_.size() && !is_told;
}

bool Tracker::isUndecided() const
{
  return hasRivals() && kept_.size() >= kFirstSweeps;
}

/// Whether the sensor may as well have begun to move otherwise.
bool Tracker::hasRivals() const
{
  return is_open_ && std::count_if(hypotheses_.begin(), hypotheses_.end(), [this](const Hypothesis& other) {
                       return other.direction() == hypotheses_.front().direction();
                     }) > 1;
}

double Tracker::Hypothesis::evidence() const
{
  return is_lost ? -HUGE_VAL : track.evidence();
}

double Tracker::Hypothesis::moved() const
{
  return is_lost ? HUGE_VAL : track.pose().middle.translation.norm();
}

bool Tracker::isLikelier(const Hypothesis& a, const Hypothesis& b)
{
  return a.evidence() > b.evidence();
}

bool Tracker::hasMovedLess(const Hypothesis& a, const Hypothesis& b)
{
  return a.moved() < b.moved();
}

void Tracker::localizeIn(const std::vector<Eigen::Vector3d>& space, const std::vector<Eigen::Vector3d>& edges,
                         const SE3& guess, bool keeps_map)
{
  prior_map_ = {{space, edges, guess, keeps_map}};
}

void Tracker::place(const SE3& pose)
{
  for (PriorMap& prior : prior_map_) {
    prior.guess = pose;
  }
  if (isTracking()) {
    keepOneOfEachDirection(isLikelier);
    kept_.clear();
    may_correct_ = false;
  }
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.track.place(pose);
  }
}

/// Their evidence begins anew, so that what is left to tell is the direction.
/// \param isBefore of two, which to keep
void Tracker::keepOneOfEachDirection(bool (*isBefore)(const Hypothesis&, const Hypothesis&))
{
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(), isBefore);
  std::vector<Hypothesis> kept;
  for (Hypothesis& hypothesis : hypotheses_) {
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Hypothesis& other) { return other.direction() == hypothesis.direction(); })) {
      kept.push_back(std::move(hypothesis));
    }
  }
  std::stable_sort(kept.begin(), kept.end(), isLikelier);
  for (Hypothesis& hypothesis : kept) {
    hypothesis.track.beginEvidence();
  }
  hypotheses_ = std::move(kept);
  is_open_ = false;
}

void Tracker::sample(const std::vector<ScanPoint>& points, Sweep& sweep)
{
  if (side_ == 0.0) {
    const double cells = kCellsPerRoot * std::sqrt(static_cast<double>(points.size()));
    side_ = sampling_.sideFor(points, static_cast<std::size_t>(cells));
  }
  dense_.sample(points, kMapSpacing * side_, sweep.dense);
  sampling_.sample(sweep.dense, side_, sweep.sample);
}

void Tracker::sample(const ScanReturns& returns, Sweep& sweep)
{
  if (side_ == 0.0) {
    std::vector<ScanPoint> points;
    collectPoints(returns, points);
    sample(points, sweep);
    return;
  }
  dense_.sample(returns, kMapSpacing * side_, sweep.dense);
  sampling_.sample(sweep.dense, side_, sweep.sample);
}

Tracker::Outcome Tracker::step(const Sweep& sweep)
{
  if (!isTracking()) {
    return begin(sweep);
  }
  Outcome outcome;
  if (is_open_ || hypotheses_.size() > 1) {
    followUp(sweep, outcome);
    return outcome;
  }
  hypotheses_[0].poses.clear();
  outcome.registration = hypotheses_[0].track.step(sweep);
  return outcome;
}

void Tracker::updateMap(const Sweep& sweep)
{
  if (isTracking()) {
    hypotheses_.front().track.updateMap(sweep);
  }
}

Tracker::Outcome Tracker::begin(const Sweep& sweep)
{
  constexpr int kMostFailures = 5;  // a bad first sweep must not hold up the rest for ever
  if (!prior_map_.empty()) {
    return beginInPriorMap(sweep);
  }
  if (first_.sample.empty()) {
    first_ = sweep;
    return {};
  }
  Outcome outcome = findFirstMotion(sweep);
  failed_ = isTracking() ? 0 : failed_ + 1;
  if (failed_ == kMostFailures) {
    failed_ = 0;
    first_ = {};
  }
  return outcome;
}

Tracker::Outcome Tracker::beginInPriorMap(const Sweep& sweep)
{
  const PriorMap& prior = prior_map_[0];
  TrackMap map(side_, settings_.horizon);
  // Many sweeps made such a map: no point of it is of one laser's pattern.
  std::uint32_t laser = 0;
  for (const Eigen::Vector3d& point : prior.space) {
    map.space.insert(point, laser++);
  }
  for (const Eigen::Vector3d& point : prior.edges) {
    map.edges.insert(point, laser++);
  }
  Outcome outcome;
  const std::vector<TrackSettings> all = directions(sweep.is_direction_known);
  std::vector<TrackMap> maps(all.size() - 1, map);
  maps.push_back(std::move(map));
  for (std::size_t i = 0; i < all.size(); ++i) {
    Hypothesis hypothesis{Track(all[i], side_), {}, {}, false, numbered_++};
    hypothesis.last = hypothesis.track.begin(sweep, std::move(maps[i]), prior.guess, prior.keeps_map);
    if (hypotheses_.empty()) {
      outcome.registration = hypothesis.last;
    }
    if (hypothesis.last.report.hasConverged()) {
      hypotheses_.push_back(std::move(hypothesis));
    }
  }
  if (isTracking()) {
    prior_map_.clear();
  }
  return outcome;
}

/// In which time may run in such sweeps; one if that is known.
std::vector<TrackSettings> Tracker::directions(bool are_known) const
{
  std::vector<TrackSettings> directions = {settings_};
  if (!are_known) {
    for (const double other : {1.0, -1.0}) {
      directions.push_back(settings_);
      directions.back().direction = other;
    }
  }
  return directions;
}

Tracker::Outcome Tracker::findFirstMotion(const Sweep& sweep)
{
  Outcome outcome;
  const FirstMotions motions = likelyFirstMotions(first_, sweep, settings_, side_);
  for (const TrackSettings& settings : directions(first_.is_direction_known && sweep.is_direction_known)) {
    suppose(motions, sweep, settings, outcome);
  }
  if (!isTracking()) {
    return outcome;
  }
  kept_ = {first_, sweep};
  is_open_ = may_correct_ = true;
  giveUp(hopeless(sweep));
  first_ = {};
  outcome.registration = hypotheses_.front().last;
  outcome.corrected = true;
  return outcome;
}

/// A track for each.
void Tracker::suppose(const FirstMotions& motions, const Sweep& sweep, const TrackSettings& settings, Outcome& outcome)
{
  constexpr double kOff = 0.25;  // m: what the likely motions may still be off, whichever way time runs
  constexpr int kRounds = 2;
  std::vector<Track> tracks(motions.likely.size(), Track(settings, side_, motions.open));
  std::vector<SurfaceRegistration> found(tracks.size());
  eachSideBySide(settings_.threads, tracks.size(), [&](std::size_t i) {
    found[i] = tracks[i].begin(first_, sweep, {motions.likely[i], kOff, kRounds});
  });
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    suppose(found[i], std::move(tracks[i]), outcome);
  }
}

/// Follows the motion that was found from a supposed one, unless it is known already.
void Tracker::suppose(const SurfaceRegistration& found, Track track, Outcome& outcome)
{
  constexpr double kSame = 0.5;  // m
  Hypothesis hypothesis{std::move(track), {}, found, false, numbered_++};
  if (hypotheses_.empty()) {
    outcome.registration = found;
  }
  if (!found.report.hasConverged()) {
    return;
  }
  const Vector6 motion = hypothesis.track.motion().velocity();
  hypothesis.poses = {{SE3(), hypothesis.track.fractionOf(first_) * motion}, hypothesis.track.pose()};
  for (Hypothesis& other : hypotheses_) {
    const Eigen::Vector3d apart = other.track.pose().middle.translation - hypothesis.track.pose().middle.translation;
    if (apart.norm() < kSame && other.direction() == hypothesis.direction()) {
      if (hypothesis.track.evidence() > other.track.evidence()) {
        other = std::move(hypothesis);
      }
      return;
    }
  }
  hypotheses_.push_back(std::move(hypothesis));
}

void Tracker::followUp(const Sweep& sweep, Outcome& outcome)
{
  if (!stepAll(sweep)) {
    outcome.registration = hypotheses_.front().last;
    return;
  }
  const std::size_t before = hypotheses_.front().number;
  giveUp(is_open_ ? hopeless(sweep) : kWrongDirection);
  outcome.changed_track = hypotheses_.front().number != before;
  outcome.corrected = may_correct_ && outcome.changed_track;
  if (is_open_) {
    kept_.push_back(sweep);
    if (kept_.size() >= (hasRivals() && !leavesNoTrace() ? kMostFirstSweeps : kFirstSweeps)) {
      settle();
      outcome.corrected = true;
    }
  }
  may_correct_ = is_open_ || (isAmbiguous() && poses().size() < kMostCorrected);
  outcome.registration = hypotheses_.front().last;
  outcome.registration.report.target_T_source = track().pose().middle;
}

/// \return whether any track goes on
bool Tracker::stepAll(const Sweep& sweep)
{
  eachSideBySide(settings_.threads, hypotheses_.size(), [&](std::size_t i) {
    Hypothesis& hypothesis = hypotheses_[i];
    hypothesis.last = hypothesis.track.step(sweep, is_open_ ? Rivals::motions : Rivals::directions);
    hypothesis.is_lost = !hypothesis.last.report.hasConverged();
    hypothesis.without_trace += is_open_ && !hypothesis.last.report.weak_directions.empty() ? 1 : 0;
    if (may_correct_ && !hypothesis.is_lost) {
      hypothesis.poses.push_back(hypothesis.track.pose());
    }
    if (is_open_) {
      hypothesis.track.updateMap(sweep);
    }
  });
  const auto goes_on =
      std::find_if(hypotheses_.begin(), hypotheses_.end(), [](const Hypothesis& h) { return !h.is_lost; });
  if (!is_open_ && goes_on != hypotheses_.end()) {
    // A map that has just taken in a sweep explains the next one better, whatever is right: so all take in the same.
    const bool is_keyframe = goes_on->track.isKeyframe();
    eachSideBySide(settings_.threads, hypotheses_.size(), [&](std::size_t i) {
      hypotheses_[i].track.updateMap(sweep, is_keyframe && !hypotheses_[i].is_lost);
    });
  }
  return goes_on != hypotheses_.end();
}

/// Those that match no more or have fallen behind, but for the best few. No direction of time falls behind before it is
/// settled how the sensor began to move.
void Tracker::giveUp(double behind)
{
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(), isLikelier);
  for (std::size_t i = hypotheses_.size(); i-- > 1;) {
    const auto here = hypotheses_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto isOfSameDirection = [&](const Hypothesis& other) { return other.direction() == here->direction(); };
    const auto best = is_open_ ? std::find_if(hypotheses_.begin(), here, isOfSameDirection) : hypotheses_.begin();
    if (here->is_lost || here->evidence() < best->evidence() - behind ||
        std::count_if(hypotheses_.begin(), here, isOfSameDirection) >= kMostHypotheses) {
      hypotheses_.erase(here);
    }
  }
}

/// The best hypotheses stay, their first sweeps where their last ones say they were. Where a motion leaves no trace,
/// the least is as good as any.
void Tracker::settle()
{
  const bool leaves_no_trace = leavesNoTrace();
  keepOneOfEachDirection(leaves_no_trace ? hasMovedLess : isLikelier);
  std::vector<std::vector<SE3>> poses(hypotheses_.size());
  eachSideBySide(settings_.threads, hypotheses_.size(), [&](std::size_t i) {
    const std::vector<SE3> forwards = middlesOf(hypotheses_[i].poses);
    poses[i] = posesFoundBackwards(kept_, forwards, hypotheses_[i].track.settings(), side_);
    if (poses[i].empty() && hypotheses_.size() > 1) {
      poses[i] = forwards;  // their maps must not differ in what they took in
    }
  });
  const std::vector<bool> keyframes =
      keyframesAmong(poses[0].empty() ? middlesOf(hypotheses_[0].poses) : poses[0], side_);
  eachSideBySide(settings_.threads, hypotheses_.size(),
                 [&](std::size_t i) { settle(hypotheses_[i], poses[i], keyframes, leaves_no_trace); });
  kept_.clear();
}

void Tracker::settle(Hypothesis& found, const std::vector<SE3>& poses, const std::vector<bool>& keyframes,
                     bool leaves_no_trace) const
{
  if (!poses.empty()) {
    found.track.begin(kept_, poses, keyframes);
    found.poses.clear();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::size_t next = std::max<std::size_t>(i, 1);
      const Vector6 velocity = log(poses[next - 1].inverse() * poses[next]) / kept_[next].periods;
      found.poses.push_back({poses[i], found.track.fractionOf(kept_[i]) * velocity});
    }
  }
  if (leaves_no_trace) {
    found.track.forgetAlong(found.last.report.weak_directions, static_cast<double>(kept_.size()));
  }
}

}  // namespace pcl_floam
