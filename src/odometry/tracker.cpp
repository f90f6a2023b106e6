#include "odometry/tracker.h"

#include "common/side_by_side.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

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
constexpr double kHopeless = 100.0;

/// So many are followed.
constexpr std::size_t kMostHypotheses = 4;

/// The direction along which the position is known least.
Eigen::Vector3d leastKnown(const Matrix6& information)
{
  const Eigen::Matrix<double, 6, 6> h = information;
  const Eigen::Matrix3d translation = h.topLeftCorner<3, 3>() - h.topRightCorner<3, 3>() *
                                                                    h.bottomRightCorner<3, 3>().inverse() *
                                                                    h.bottomLeftCorner<3, 3>();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(translation).eigenvectors().col(0);
}

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
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.track.place(pose);
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
  TrackMap map(side_, settings_);
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
  const std::vector<FirstMotion> likely = likelyMotions(sweep);
  std::vector<Track> tracks(likely.size(), Track(settings_, side_));
  std::vector<SurfaceRegistration> found(likely.size());
  eachSideBySide(settings_.threads, likely.size(),
                 [&](std::size_t i) { found[i] = tracks[i].begin(first_, sweep, likely[i].velocity, kOff, kRounds); });
  for (std::size_t i = 0; i < likely.size(); ++i) {
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

/// From rest, near and far, along the direction that this leaves open, and as it is told. Each is looked at with few
/// points, and the likeliest are told.
std::vector<Tracker::FirstMotion> Tracker::likelyMotions(const Sweep& sweep)
{
  constexpr double kNear = 0.5;     // m
  constexpr double kFar = 2.0;      // m
  constexpr double kFastest = 4.0;  // m a period: 40 m/s at ten sweeps a second
  constexpr int kFarRounds = 5;
  const Sweep first = thinned(first_);
  const Sweep second = thinned(sweep);
  std::vector<FirstMotion> motions;
  std::vector<FirstLook> looks = {{Vector6::Zero(), kFar, kFarRounds}, {Vector6::Zero(), kNear, 1}};
  const Matrix6 information = lookAt(looks, first, second, motions).information;
  if (motions.empty()) {
    return {};
  }
  const Eigen::Vector3d open = leastKnown(information);
  looks.clear();
  if (sweep.hint) {
    looks.push_back({log(sweep.hint->last_T_now) / sweep.periods, kNear, 1});
  }
  for (int step = 1; step * kNear <= kFastest * sweep.periods; ++step) {
    for (const double sign : {1.0, -1.0}) {
      Vector6 velocity = Vector6::Zero();
      velocity.head<3>() = sign * step * kNear / sweep.periods * open;
      looks.push_back({velocity, kNear, 1});
    }
  }
  lookAt(looks, first, second, motions);
  return likeliest(std::move(motions), kNear / sweep.periods);
}

/// Adds the motions that are found. \return the last one's registration
RegistrationReport Tracker::lookAt(const std::vector<FirstLook>& looks, const Sweep& first, const Sweep& second,
                                   std::vector<FirstMotion>& motions) const
{
  std::vector<RegistrationReport> found(looks.size());
  std::vector<double> evidence(looks.size());
  eachSideBySide(settings_.threads, looks.size(), [&](std::size_t i) {
    Track track(settings_, side_);
    found[i] = track.findMotion(first, second, looks[i].velocity, looks[i].far, looks[i].rounds).report;
    evidence[i] = track.evidence();
  });
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (found[i].hasConverged()) {
      motions.push_back({log(found[i].target_T_source) / second.periods, evidence[i]});
    }
  }
  return found.empty() ? RegistrationReport() : found.back();
}

/// The few whose evidence is best, no two of them nearer than \p same to each other.
std::vector<Tracker::FirstMotion> Tracker::likeliest(std::vector<FirstMotion> motions, double same)
{
  std::stable_sort(motions.begin(), motions.end(),
                   [](const FirstMotion& a, const FirstMotion& b) { return a.evidence > b.evidence; });
  constexpr std::size_t kMostLikely = 8;
  std::vector<FirstMotion> likely;
  for (const FirstMotion& motion : motions) {
    const bool is_known = std::any_of(likely.begin(), likely.end(), [&](const FirstMotion& other) {
      return (motion.velocity - other.velocity).head<3>().norm() < same;
    });
    if (!is_known && likely.size() < kMostLikely) {
      likely.push_back(motion);
    }
  }
  return likely;
}

/// As many points as tell which motions are likely.
Sweep Tracker::thinned(const Sweep& sweep)
{
  constexpr double kMapped = 0.6;      // sides of the map's finest cells, between points that enter it
  constexpr double kRegistered = 3.0;  // between those that are registered
  Sweep thin;
  sampling_.sample(sweep.dense, kMapped * side_, thin.dense);
  sampling_.sample(sweep.sample, kRegistered * side_, thin.sample);
  sampling_.sample(sweep.edges, side_, thin.edges);
  thin.periods = sweep.periods;
  thin.fraction = sweep.fraction;
  return thin;
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
  if (!hypotheses_[best_].weak.empty()) {
    best_ = leastMoved();
  }
  Hypothesis found = std::move(hypotheses_[best_]);
  const std::vector<SE3> poses = posesFoundBackwards(found);
  if (!poses.empty()) {
    found.track.begin(kept_, poses);
    found.poses.clear();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::size_t next = std::max<std::size_t>(i, 1);
      const Vector6 velocity = log(poses[next - 1].inverse() * poses[next]) / kept_[next].periods;
      found.poses.push_back({poses[i], kept_[i].fraction * velocity});
    }
  }
  found.track.forgetAlong(found.weak, static_cast<double>(kept_.size()));
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

/// Nothing if a sweep cannot be registered.
std::vector<SE3> Tracker::posesFoundBackwards(const Hypothesis& found) const
{
  constexpr std::size_t kTrusted = 4;  // last sweeps, whose poses the others are found from
  const std::size_t n = kept_.size();
  const auto backwards = [&](std::size_t k) {
    Sweep sweep = kept_[k];
    sweep.periods = k + 1 < n ? kept_[k + 1].periods : 1.0;
    sweep.fraction = -sweep.fraction;
    sweep.hint.reset();
    return sweep;
  };
  std::vector<Sweep> sweeps;
  std::vector<SE3> poses(n);
  std::vector<SE3> last;
  for (std::size_t k = n; k-- > n - kTrusted;) {
    poses[k] = found.poses[k].middle;
    last.push_back(poses[k]);
    sweeps.push_back(backwards(k));
  }
  Track back(settings_, side_);
  back.begin(sweeps, last);
  for (std::size_t k = n - kTrusted; k-- > 0;) {
    const Sweep sweep = backwards(k);
    if (!back.step(sweep).report.hasConverged()) {
      return {};
    }
    back.updateMap(sweep);
    poses[k] = back.pose().middle;
  }
  const SE3 first_T_world = poses[0].inverse();
  for (SE3& pose : poses) {
    pose = first_T_world * pose;
  }
  return poses;
}

}  // namespace pcl_floam
