#include "odometry/start.h"

#include "common/side_by_side.h"
#include "odometry/backward_pass.h"
#include "odometry/first_motion.h"

#include <algorithm>
#include <cstddef>

namespace pcl_floam {

namespace {

/// Sweeps until it is decided how it began: if one motion is left by then, and at most.
constexpr std::size_t kFirstSweeps = 12;
constexpr std::size_t kMostFirstSweeps = 4 * kFirstSweeps;

/// A track whose evidence is so much less than the best one's is given up, for each point of a sweep, since the errors
/// that lead astray are shared by points: false ones lead by less while the map is young, and fall behind by more where
/// a scene is clear.
double hopeless(const Sweep& sweep)
{
  constexpr double kOfAPoint = 0.1;
  return kOfAPoint * static_cast<double>(sweep.sample.size());
}

std::vector<SE3> middlesOf(const std::vector<SweepPose>& poses)
{
  std::vector<SE3> middles(poses.size());
  std::transform(poses.begin(), poses.end(), middles.begin(), [](const SweepPose& pose) { return pose.middle; });
  return middles;
}

}  // namespace

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

SurfaceRegistration Start::findMotion(const Sweep& second, const TrackSettings& settings, Hypotheses& hypotheses)
{
  SurfaceRegistration found;
  found.report.termination = Termination::too_few_correspondences;  // if no motion is likely
  const FirstMotions motions = likelyFirstMotions(kept_.front(), second, settings);
  for (const TrackSettings& of_direction :
       eachDirection(settings, kept_.front().is_direction_known && second.is_direction_known)) {
    suppose(motions.likely, std::vector<Track>(motions.likely.size(), Track(of_direction, motions.open)), second, found,
            hypotheses);
  }
  if (!hypotheses.empty()) {
    kept_.push_back(second);
    hypotheses.giveUp(hopeless(second), Rivals::motions);
    found = hypotheses.front().last;
  }
  return found;
}

/// A track for each.
void Start::suppose(const std::vector<Vector6>& motions, std::vector<Track> tracks, const Sweep& second,
                    SurfaceRegistration& first_found, Hypotheses& hypotheses) const
{
  constexpr double kOff = 0.25;  // m: what the likely motions may still be off, whichever way time runs
  constexpr int kRounds = 2;
  const Sweep& first = kept_.front();
  std::vector<SurfaceRegistration> found(tracks.size());
  eachSideBySide(tracks.empty() ? 1 : tracks[0].settings().threads, tracks.size(), [&](std::size_t i) {
    found[i] = tracks[i].begin(first, second, {motions[i], kOff, kRounds});
  });
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (hypotheses.empty()) {
      first_found = found[i];
    }
    if (found[i].report.hasConverged()) {
      const Vector6 twist = tracks[i].fractionOf(first) * tracks[i].motion().velocity();
      const SweepPose pose = tracks[i].pose();
      hypotheses.add(std::move(tracks[i]), found[i], {{SE3(), twist}, pose});
    }
  }
}

bool Start::step(const Sweep& sweep, Hypotheses& hypotheses)
{
  if (!hypotheses.step(sweep, Rivals::motions, true)) {
    return false;
  }
  hypotheses.giveUp(hopeless(sweep), Rivals::motions);
  kept_.push_back(sweep);
  if (leavesNoTrace(hypotheses)) {
    hypotheses.putFirst(Preference::least_motion);
  }
  return true;
}

bool Start::isUndecided(const Hypotheses& hypotheses) const
{
  return hypotheses.hasRivalsInDirection() && kept_.size() >= kFirstSweeps;
}

bool Start::isOver(const Hypotheses& hypotheses) const
{
  const bool more_would_tell = hypotheses.hasRivalsInDirection() && !leavesNoTrace(hypotheses);
  return kept_.size() >= (more_would_tell ? kMostFirstSweeps : kFirstSweeps);
}

/// Whether most of the first sweeps do not tell of a direction, and nobody else did.
bool Start::leavesNoTrace(const Hypotheses& hypotheses) const
{
  const bool is_told =
      std::any_of(kept_.begin(), kept_.end(), [](const Sweep& sweep) { return sweep.hint.has_value(); });
  return 2 * hypotheses.front().without_trace > kept_.size() && !is_told;
}

void Start::settle(Hypotheses& hypotheses) const
{
  const bool leaves_no_trace = leavesNoTrace(hypotheses);
  hypotheses.keepOneOfEachDirection(leaves_no_trace ? Preference::least_motion : Preference::likeliest);
  std::vector<Hypothesis>& all = hypotheses.all();
  const TrackSettings& settings = all.front().track.settings();
  std::vector<std::vector<SE3>> poses(all.size());
  eachSideBySide(settings.threads, all.size(), [&](std::size_t i) {
    const std::vector<SE3> forwards = middlesOf(all[i].poses);
    poses[i] = posesFoundBackwards(kept_, forwards, all[i].track.settings());
    if (poses[i].empty() && all.size() > 1) {
      poses[i] = forwards;  // their maps must not differ in what they took in
    }
  });
  const std::vector<bool> keyframes = keyframesAmong(poses[0].empty() ? middlesOf(all[0].poses) : poses[0], settings);
  eachSideBySide(settings.threads, all.size(), [&](std::size_t i) {
    beginAgain(all[i], poses[i], keyframes);
    if (leaves_no_trace) {
      all[i].track.forgetAlong(all[i].last.report.weak_directions, static_cast<double>(kept_.size()));
    }
  });
}

/// With poses that are known better; none: as it is.
void Start::beginAgain(Hypothesis& found, const std::vector<SE3>& poses, const std::vector<bool>& keyframes) const
{
  if (poses.empty()) {
    return;
  }
  found.track.begin(kept_, poses, keyframes);
  found.poses.clear();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t next = std::max<std::size_t>(i, 1);
    const Vector6 velocity = log(poses[next - 1].inverse() * poses[next]) / kept_[next].periods;
    found.poses.push_back({poses[i], found.track.fractionOf(kept_[i]) * velocity});
  }
}

}  // namespace pcl_floam
