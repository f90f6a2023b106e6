#include "odometry/candidate_motions.h"

#include <algorithm>
#include <utility>

namespace pcl_floam {

std::vector<TrackSettings> eachDirection(const TrackSettings& settings, bool is_known)
{
  std::vector<TrackSettings> directions = {settings};
  if (!is_known) {
    for (const double other : {1.0, -1.0}) {
      directions.push_back(settings);
      directions.back().direction = other;
    }
  }
  return directions;
}

CandidateMotions::CandidateMotions(const std::vector<Sweep>& kept, const TrackSettings& settings)
    : search_(kept[0], kept[1], settings),
      directions_(eachDirection(settings, kept[0].is_direction_known && kept[1].is_direction_known))
{
  enqueue();
}

SurfaceRegistration CandidateMotions::followFirst(const std::vector<Sweep>& kept, Hypotheses& hypotheses)
{
  std::optional<SurfaceRegistration> first;
  while (!areTried()) {
    if (waiting_.empty()) {
      search_.goOn(1);
      enqueue();
      continue;
    }
    SurfaceRegistration found = begin(kept);
    if (late_) {
      hypotheses.add(std::move(*std::exchange(late_, std::nullopt)));
      return found;
    }
    first = first ? first : found;
  }
  if (!first) {
    first.emplace();
    first->report.termination = Termination::too_few_correspondences;  // no motion is likely
  }
  return *first;
}

void CandidateMotions::goOn(WorkShare& share, const std::vector<Sweep>& kept, Hypotheses& hypotheses)
{
  while (!areTried()) {
    if (late_) {
      if (!share.take(WorkShare::kCatchUp)) {
        return;
      }
      late_->step(kept[late_->poses.size()], Rivals::motions, true);
    } else if (!waiting_.empty()) {
      if (!share.take(WorkShare::kBegin)) {
        return;
      }
      begin(kept);
    } else if (!look(share)) {
      return;
    }
    compare(kept, hypotheses);
  }
}

/// \return whether there was anything left of the share
bool CandidateMotions::look(WorkShare& share)
{
  std::size_t looks = 0;
  while (looks < search_.left() && share.take(WorkShare::kLook)) {
    ++looks;
  }
  search_.goOn(looks);
  if (search_.isDone()) {
    enqueue();
  }
  return looks > 0;
}

/// Those that have turned out to be likely wait to be tried.
void CandidateMotions::enqueue()
{
  const std::vector<Vector6> likely = search_.likelyMotions();
  const auto isUnlikely = [&](const Candidate& c) { return !isAmong(likely, c.motion, search_.same()); };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), isUnlikely), waiting_.end());
  for (const Vector6& motion : likely) {
    if (isAmong(enqueued_, motion, search_.same())) {
      continue;
    }
    enqueued_.push_back(motion);
    for (std::size_t direction = 0; direction < directions_.size(); ++direction) {
      if (!isGivenUp(directions_[direction].direction)) {
        waiting_.push_back({motion, direction});
      }
    }
  }
}

void CandidateMotions::giveUpDirections(const std::vector<double>& directions)
{
  given_up_.insert(given_up_.end(), directions.begin(), directions.end());
  const auto isCandidateGivenUp = [&](const Candidate& c) { return isGivenUp(directions_[c.direction].direction); };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), isCandidateGivenUp), waiting_.end());
  if (late_ && isGivenUp(late_->direction())) {
    late_.reset();
  }
}

bool CandidateMotions::isGivenUp(double direction) const
{
  return std::find(given_up_.begin(), given_up_.end(), direction) != given_up_.end();
}

SurfaceRegistration CandidateMotions::begin(const std::vector<Sweep>& kept)
{
  constexpr double kOff = 0.25;  // m: what the likely motions may still be off, whichever way time runs
  constexpr int kRounds = 2;
  const Candidate candidate = waiting_.front();
  waiting_.pop_front();
  Track track(directions_[candidate.direction]);
  SurfaceRegistration found = track.begin(kept[0], kept[1], {candidate.motion, kOff, kRounds, candidate.rests});
  if (found.report.hasConverged()) {
    const Vector6 twist = track.fractionOf(kept[0]) * track.motion().velocity();
    late_.emplace(std::move(track), found);
    late_->poses = {{SE3(), twist}, late_->track.pose()};
    late_->evidences.assign(2, late_->track.evidence());
    late_->place_evidences.resize(2);
    if (!late_->is_beginning_told) {
      supposeRest(candidate);
    }
  }
  return found;
}

/// What two sweeps do not tell of, a registration leaves where it happened to begin, or where noise led to. Most that
/// carries a lidar begins at rest.
void CandidateMotions::supposeRest(Candidate candidate)
{
  if (std::find(with_rest_.begin(), with_rest_.end(), candidate.direction) == with_rest_.end()) {
    with_rest_.push_back(candidate.direction);
    candidate.rests = true;
    waiting_.push_front(candidate);
  }
}

/// Whether the third sweep tells of another motion than the first two: at some ten sweeps a second nothing that carries
/// a lidar accelerates so. Where rings lie on rings of another place, two sweeps fit that do not belong together.
bool CandidateMotions::hasJumped(const std::vector<Sweep>& kept) const
{
  constexpr std::size_t kShown = 3;
  if (late_->poses.size() != kShown) {
    return false;
  }
  const auto way = [&](std::size_t k) {
    return Eigen::Vector3d(late_->poses[k].middle.translation - late_->poses[k - 1].middle.translation);
  };
  const double longer = kept[2].periods / kept[1].periods;
  const double apart = search_.same() * kept[1].periods;  // m
  return (way(2) - longer * way(1)).norm() > apart * std::max(1.0, longer);
}

/// The late one with those that are followed.
void CandidateMotions::compare(const std::vector<Sweep>& kept, Hypotheses& hypotheses)
{
  if (!late_) {
    return;
  }
  if (late_->is_lost || hasJumped(kept) || hypotheses.haveLeftBehind(*late_)) {
    late_.reset();
  } else if (late_->poses.size() == kept.size()) {
    hypotheses.dropLeftBehind(*late_);
    hypotheses.add(std::move(*std::exchange(late_, std::nullopt)));
    hypotheses.giveUpMotions();
  }
}

}  // namespace pcl_floam
