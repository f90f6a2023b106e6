#include "odometry/hypotheses.h"

#include "common/side_by_side.h"
#include "odometry/place_evidence.h"

#include <Eigen/Cholesky>

#include <algorithm>

namespace pcl_floam {

namespace {

/// So many are followed for each direction of time.
constexpr std::ptrdiff_t kMostOfADirection = 4;

/// Whether the first motions of two are one: then a single one is followed. A registration finds either from the other
/// where the sweeps tell of it; else each stays where it is, and they are one if hardly more than noise apart.
bool haveBegunAlike(const Hypothesis& a, const Hypothesis& b)
{
  constexpr double kFound = 0.5;   // m
  constexpr double kStays = 0.05;  // m
  const double same = a.is_beginning_told && b.is_beginning_told ? kFound : kStays;
  return (a.poses[1].middle.translation - b.poses[1].middle.translation).norm() < same;
}

/// Of a track, where it was when that which evidence tells of began.
const SE3& rememberedPose(const Hypothesis& hypothesis)
{
  return hypothesis.poses[hypothesis.poses.size() - 1 - kRememberedSweeps].middle;
}

/// Whether two have moved alike while they were judged, as far as sweeps tell: as far apart as two estimates of one
/// motion are in the mean, or less. What follows tells the same of both.
bool haveMovedAlike(const Hypothesis& a, const Hypothesis& b)
{
  constexpr double kMean = 3.0;  // of the square of an error in space, in its standard deviations
  const bool is_told = a.last.report.weak_directions.empty() && b.last.report.weak_directions.empty();
  if (!is_told || std::min(a.poses.size(), b.poses.size()) <= kRememberedSweeps) {
    return false;
  }
  const auto movedBy = [](const Hypothesis& h) -> Eigen::Vector3d {
    return (rememberedPose(h).inverse() * h.poses.back().middle).translation / kRememberedSweeps;
  };
  const Eigen::Vector3d off = rememberedPose(a).rotation * (movedBy(a) - movedBy(b));
  const Eigen::Matrix3d expected = (a.track.motion().covariance() + b.track.motion().covariance()).block<3, 3>(6, 6);
  return off.dot(expected.ldlt().solve(off)) < kMean;
}

/// Sweeps by which two are compared.
constexpr std::size_t kComparedSweeps = 10;

/// Whether one was less likely than another at a sweep that both took, and explained fewer places better than that did,
/// by more than chance, in the sweeps up to it. What goes along with the sensor, as cars that keep pace do, may tell
/// more than the road does, but in fewer places.
bool wasWorse(const Hypothesis& one, const Hypothesis& other, std::size_t then)
{
  PlaceVotes votes;
  for (std::size_t k = then + 1 - std::min(then + 1, kComparedSweeps); k <= then; ++k) {
    votes.add(one.place_evidences[k], other.place_evidences[k]);
  }
  return one.evidences[then] < other.evidences[then] && votes.areSurelyAgainst();
}

/// Whether it is worse now than any of others of its direction of time.
bool isWorse(const Hypothesis& one, const std::vector<Hypothesis>& others)
{
  return std::any_of(others.begin(), others.end(), [&](const Hypothesis& other) {
    const std::size_t taken = other.place_evidences.size();
    return other.direction() == one.direction() && taken > 0 && taken == one.place_evidences.size() &&
           wasWorse(one, other, taken - 1);
  });
}

bool isLikelier(const Hypothesis& a, const Hypothesis& b)
{
  return a.evidence() > b.evidence();
}

bool hasMovedLess(const Hypothesis& a, const Hypothesis& b)
{
  return a.moved() < b.moved();
}

}  // namespace

void Hypothesis::step(const Sweep& sweep, Rivals rivals, bool keeps_poses)
{
  last = track.step(sweep, rivals);
  is_lost = !last.report.hasConverged();
  if (keeps_poses && !is_lost) {
    poses.push_back(track.pose());
    evidences.push_back(track.evidence());
    if (rivals == Rivals::motions) {
      keepEvidenceOf(sweep.places);
    }
  }
  if (rivals == Rivals::motions) {
    without_trace += last.report.weak_directions.empty() || poses.size() > kFirstSweeps ? 0 : 1;
    track.updateMap(sweep);
  }
}

/// Motions that are tried late are compared from the first sweep on; after the sweeps that are kept there are none.
void Hypothesis::keepEvidenceOf(const std::vector<std::uint32_t>& places)
{
  place_evidences.push_back(evidenceByPlace(last.point_evidence, places));
  for (std::size_t k = 0; place_evidences.size() > kMostKept && k + kComparedSweeps < place_evidences.size(); ++k) {
    std::vector<float>().swap(place_evidences[k]);
  }
}

void Hypotheses::add(Hypothesis added)
{
  added.number = numbered_++;
  all_.push_back(std::move(added));
}

bool Hypotheses::step(const Sweep& sweep, Rivals rivals, bool keeps_poses)
{
  const int threads = front().track.settings().threads;
  eachSideBySide(threads, all_.size(), [&](std::size_t i) { all_[i].step(sweep, rivals, keeps_poses); });
  const auto goes_on = std::find_if(all_.begin(), all_.end(), [](const Hypothesis& h) { return !h.is_lost; });
  if (rivals == Rivals::directions && goes_on != all_.end()) {
    took_in_ = goes_on->track.isKeyframe();
    eachSideBySide(threads, all_.size(),
                   [&](std::size_t i) { all_[i].track.updateMap(sweep, took_in_ && !all_[i].is_lost); });
  }
  return goes_on != all_.end();
}

std::vector<double> Hypotheses::giveUpDirections(double behind)
{
  const double best = std::min_element(all_.begin(), all_.end(), isLikelier)->evidence();  // the first of that order
  const auto keepsUp = [&](const Hypothesis& hypothesis) { return !(hypothesis.evidence() < best - behind); };
  const auto left = std::stable_partition(all_.begin(), all_.end(), keepsUp);
  std::vector<double> given_up;
  std::for_each(left, all_.end(), [&](const Hypothesis& hypothesis) { given_up.push_back(hypothesis.direction()); });
  all_.erase(left, all_.end());
  return given_up;
}

bool Hypotheses::differInDirectionAlone() const
{
  return std::all_of(all_.begin(), all_.end(),
                     [&](const Hypothesis& one) { return !one.is_lost && haveBegunAlike(one, front()); });
}

void Hypotheses::giveUpMotions()
{
  putFirst(Preference::likeliest);
  for (std::size_t i = all_.size(); i-- > 0;) {
    if (isWorse(all_[i], all_)) {
      all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  std::vector<Hypothesis> left;
  for (Hypothesis& next : all_) {
    const auto isOfSameDirection = [&](const Hypothesis& other) { return other.direction() == next.direction(); };
    const auto isTwin = [&](const Hypothesis& other) {
      return isOfSameDirection(other) && haveMovedAlike(other, next);
    };
    const auto best = std::find_if(left.begin(), left.end(), isOfSameDirection);
    const bool is_best = left.empty() || (best == left.end() && !next.is_lost);
    if (is_best || (!next.is_lost && std::none_of(left.begin(), left.end(), isTwin) &&
                    std::count_if(left.begin(), left.end(), isOfSameDirection) < kMostOfADirection)) {
      left.push_back(std::move(next));
    }
  }
  all_ = std::move(left);
}

bool Hypotheses::haveLeftBehind(const Hypothesis& late) const
{
  const std::size_t now = late.evidences.size() - 1;
  std::ptrdiff_t better = 0;
  for (const Hypothesis& other : all_) {
    if (other.direction() != late.direction()) {
      continue;
    }
    const bool is_as_good = late.evidences[now] < other.evidences[now] + kOfOneMotion;
    if (wasWorse(late, other, now) || (is_as_good && now == 1 && haveBegunAlike(late, other))) {
      return true;
    }
    better += other.evidences[now] > late.evidences[now] ? 1 : 0;
  }
  return better >= kMostOfADirection;
}

void Hypotheses::dropLeftBehind(const Hypothesis& late)
{
  const auto isLeftBehind = [&](const Hypothesis& other) {
    bool is_behind = haveBegunAlike(late, other);
    for (std::size_t k = 1; k < late.poses.size() && !is_behind; ++k) {
      is_behind = wasWorse(other, late, k);
    }
    return is_behind && other.direction() == late.direction();
  };
  all_.erase(std::remove_if(all_.begin(), all_.end(), isLeftBehind), all_.end());
}

void Hypotheses::dropLost()
{
  const auto isLost = [](const Hypothesis& hypothesis) { return hypothesis.is_lost; };
  if (!std::all_of(all_.begin(), all_.end(), isLost)) {
    all_.erase(std::remove_if(all_.begin(), all_.end(), isLost), all_.end());
  }
}

void Hypotheses::putFirst(Preference preference)
{
  std::stable_sort(all_.begin(), all_.end(), preference == Preference::likeliest ? isLikelier : hasMovedLess);
}

void Hypotheses::keepOneOfEachDirection(Preference preference)
{
  putFirst(preference);
  std::vector<Hypothesis> kept;
  for (Hypothesis& hypothesis : all_) {
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Hypothesis& other) { return other.direction() == hypothesis.direction(); })) {
      kept.push_back(std::move(hypothesis));
    }
  }
  std::stable_sort(kept.begin(), kept.end(), isLikelier);
  for (Hypothesis& hypothesis : kept) {
    hypothesis.track.beginEvidence();
    hypothesis.place_evidences = std::vector<std::vector<float>>();
  }
  all_ = std::move(kept);
}

Matrix6 Hypotheses::rivalCovariance() const
{
  Matrix6 squares = Matrix6::Zero();
  const SE3& first = front().track.pose().middle;
  for (std::size_t i = 1; i < all_.size(); ++i) {
    const SE3& other = all_[i].track.pose().middle;
    Vector6 off;
    off << other.translation - first.translation, logSO3(other.rotation * first.rotation.transpose());
    squares += off * off.transpose();
  }
  return squares / std::max(1.0, static_cast<double>(all_.size()) - 1.0);
}

bool Hypotheses::hasRivalsInDirection() const
{
  return std::count_if(all_.begin(), all_.end(),
                       [this](const Hypothesis& other) { return other.direction() == front().direction(); }) > 1;
}

}  // namespace pcl_floam
