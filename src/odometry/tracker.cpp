#include "odometry/tracker.h"

#include "common/side_by_side.h"
#include "odometry/backward_pass.h"
#include "odometry/first_motion.h"

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
/// Sweeps until it is decided how it began.
constexpr std::size_t kFirstSweeps = 12;
/// A track whose evidence is so much less than the best one's is given up: false ones lead by less while the map is
/// young, and fall behind by more where a scene is clear.
constexpr double kHopeless = 200.0;

/// So many are followed.
constexpr std::size_t kMostHypotheses = 4;

}  // namespace

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
    decide(std::move(hypotheses_[best_]));
    hypotheses_[0].track.place(pose);
  }
}

void Tracker::sample(const std::vector<ScanPoint>& points, Sweep& sweep)
{
  if (side_ == 0.0) {
    const double cells = kCellsPerRoot * std::sqrt(static_cast<double>(points.size()));
    side_ = sampling_.sideFor(points, static_cast<std::size_t>(cells));
  }
  sampling_.sample(points, kMapSpacing * side_, sweep.dense);
  sampling_.sample(sweep.dense, side_, sweep.sample);
}

Tracker::Outcome Tracker::step(const Sweep& sweep)
{
  if (!isTracking()) {
    return begin(sweep);
  }
  Outcome outcome;
  if (is_open_) {
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
    hypotheses_[best_].track.updateMap(sweep);
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
  Hypothesis hypothesis{Track(settings_, side_), {}, {}, false};
  Outcome outcome;
  outcome.registration = hypothesis.track.begin(sweep, std::move(map), prior.guess, prior.keeps_map);
  if (outcome.registration.report.hasConverged()) {
    hypotheses_.push_back(std::move(hypothesis));
    prior_map_.clear();
  }
  return outcome;
}

Tracker::Outcome Tracker::findFirstMotion(const Sweep& sweep)
{
  constexpr double kOff = 0.25;  // m: what the likely motions may still be off
  constexpr int kRounds = 2;
  Outcome outcome;
  const FirstMotions motions = likelyFirstMotions(first_, sweep, settings_, side_);
  std::vector<Track> tracks(motions.likely.size(), Track(settings_, side_, motions.open));
  std::vector<SurfaceRegistration> found(tracks.size());
  eachSideBySide(settings_.threads, tracks.size(), [&](std::size_t i) {
    found[i] = tracks[i].begin(first_, sweep, {motions.likely[i], kOff, kRounds});
  });
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    suppose(found[i], std::move(tracks[i]), outcome);
  }
  if (!isTracking()) {
    return outcome;
  }
  giveUpHopeless();
  kept_ = {first_, sweep};
  is_open_ = true;
  first_ = {};
  outcome.corrected = true;
  return outcome;
}

/// Follows the motion that was found from a supposed one, unless it is known already.
void Tracker::suppose(const SurfaceRegistration& found, Track track, Outcome& outcome)
{
  constexpr double kSame = 0.5;  // m
  Hypothesis hypothesis{std::move(track), {}, {}, false};
  if (hypotheses_.empty()) {
    outcome.registration = found;
  }
  if (!found.report.hasConverged()) {
    return;
  }
  const Vector6 motion = hypothesis.track.motion().velocity();
  hypothesis.poses = {{SE3(), first_.fraction * motion}, hypothesis.track.pose()};
  for (Hypothesis& other : hypotheses_) {
    const Eigen::Vector3d apart = other.track.pose().middle.translation - hypothesis.track.pose().middle.translation;
    if (apart.norm() < kSame) {
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
  const std::size_t best = best_;
  std::vector<SurfaceRegistration> found(hypotheses_.size());
  eachSideBySide(settings_.threads, hypotheses_.size(), [&](std::size_t i) {
    found[i] = hypotheses_[i].track.step(sweep, true);
    hypotheses_[i].track.updateMap(sweep);
  });
  bool any = false;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    Hypothesis& hypothesis = hypotheses_[i];
    hypothesis.weak = found[i].report.weak_directions;
    hypothesis.is_lost = !found[i].report.hasConverged();
    if (hypothesis.is_lost) {
      outcome.registration = any ? outcome.registration : found[i];
      continue;
    }
    hypothesis.poses.push_back(hypothesis.track.pose());
    if (!any || hypothesis.track.evidence() > hypotheses_[best_].track.evidence()) {
      outcome.registration = found[i];
      best_ = i;
    }
    any = true;
  }
  if (any) {
    outcome.corrected = best_ != best;
    giveUpHopeless();
    kept_.push_back(sweep);
    if (kept_.size() == kFirstSweeps) {
      settle();
      outcome.registration.report.target_T_source = track().pose().middle;
      outcome.corrected = true;
    }
  }
}

/// Those that match no more or have fallen behind, but for the best few.
void Tracker::giveUpHopeless()
{
  const auto evidence = [](const Hypothesis& h) { return h.is_lost ? -HUGE_VAL : h.track.evidence(); };
  const auto less = [&](const Hypothesis& a, const Hypothesis& b) { return evidence(a) < evidence(b); };
  const double hopeless = evidence(*std::max_element(hypotheses_.begin(), hypotheses_.end(), less)) - kHopeless;
  while (hypotheses_.size() > 1) {
    const auto last = std::min_element(hypotheses_.begin(), hypotheses_.end(), less);
    if (evidence(*last) >= hopeless && hypotheses_.size() <= kMostHypotheses) {
      break;
    }
    hypotheses_.erase(last);
  }
  best_ =
      static_cast<std::size_t>(std::max_element(hypotheses_.begin(), hypotheses_.end(), less) - hypotheses_.begin());
}

/// The best hypothesis stays, its first sweeps where its last ones say they were.
void Tracker::settle()
{
  const bool is_told =
      std::any_of(kept_.begin(), kept_.end(), [](const Sweep& sweep) { return sweep.hint.has_value(); });
  const bool is_open = !hypotheses_[best_].weak.empty() && !is_told;
  if (is_open) {
    best_ = leastMoved();
  }
  Hypothesis found = std::move(hypotheses_[best_]);
  std::vector<SE3> forwards;
  for (const SweepPose& pose : found.poses) {
    forwards.push_back(pose.middle);
  }
  const std::vector<SE3> poses = posesFoundBackwards(kept_, forwards, settings_, side_);
  if (!poses.empty()) {
    found.track.begin(kept_, poses);
    found.poses.clear();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::size_t next = std::max<std::size_t>(i, 1);
      const Vector6 velocity = log(poses[next - 1].inverse() * poses[next]) / kept_[next].periods;
      found.poses.push_back({poses[i], kept_[i].fraction * velocity});
    }
  }
  if (is_open) {
    found.track.forgetAlong(found.weak, static_cast<double>(kept_.size()));
  }
  decide(std::move(found));
}

/// From here on there is one.
void Tracker::decide(Hypothesis found)
{
  hypotheses_.clear();
  hypotheses_.push_back(std::move(found));
  best_ = 0;
  is_open_ = false;
  kept_.clear();
}

/// Where a motion leaves no trace, none is as good as any.
std::size_t Tracker::leastMoved() const
{
  const auto moved = [](const Hypothesis& h) {
    return h.is_lost ? HUGE_VAL : h.track.pose().middle.translation.norm();
  };
  const auto least = std::min_element(hypotheses_.begin(), hypotheses_.end(),
                                      [&](const Hypothesis& a, const Hypothesis& b) { return moved(a) < moved(b); });
  return static_cast<std::size_t>(least - hypotheses_.begin());
}

}  // namespace pcl_floam
