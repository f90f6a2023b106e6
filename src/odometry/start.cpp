#include "odometry/start.h"

#include "common/side_by_side.h"

#include <algorithm>
#include <cstddef>

namespace pcl_floam {

namespace {

/// First sweeps that are found once more, and what these are found from.
constexpr std::size_t kRevised = kFirstSweeps + BackwardPass::kTrusted;

std::vector<SE3> middlesOf(const std::vector<SweepPose>& poses)
{
  std::vector<SE3> middles(poses.size());
  std::transform(poses.begin(), poses.end(), middles.begin(), [](const SweepPose& pose) { return pose.middle; });
  return middles;
}

}  // namespace

SurfaceRegistration Start::findMotion(const Sweep& second, const TrackSettings& settings, Hypotheses& hypotheses)
{
  kept_.push_back(second);
  was_hinted_ = kept_.front().hint.has_value() || second.hint.has_value();
  candidates_.emplace(kept_, settings);
  SurfaceRegistration found = candidates_->followFirst(kept_, hypotheses);
  if (hypotheses.empty()) {
    kept_.pop_back();
    candidates_.reset();
  } else {
    constexpr int kOfTheFirst = 8;  // registrations with which that was found
    candidates_->goOn(settings.start_effort - kOfTheFirst, kept_, hypotheses);
    found = hypotheses.front().last;
  }
  return found;
}

bool Start::step(const Sweep& sweep, Hypotheses& hypotheses)
{
  if (!hypotheses.step(sweep, isDecided() ? Rivals::directions : Rivals::motions, true)) {
    return false;
  }
  if (keeps_) {
    kept_.push_back(sweep);
  }
  was_hinted_ = was_hinted_ || sweep.hint.has_value();
  if (isDecided()) {
    revise(hypotheses);
  } else {
    follow(sweep, hypotheses);
  }
  return true;
}

/// After many sweeps rivals are still followed, but motions that have not been tried by then are not.
void Start::follow(const Sweep& sweep, Hypotheses& hypotheses)
{
  hypotheses.giveUp(hopeless(sweep), Rivals::motions);
  if (kept_.size() == kMostKept) {
    candidates_.reset();
  } else if (candidates_) {
    candidates_->goOn(hypotheses.front().track.settings().start_effort, kept_, hypotheses);
  }
  if (leavesNoTrace(hypotheses)) {
    hypotheses.putFirst(Preference::least_motion);
  }
  if (canBeDecided(hypotheses)) {
    beginRevision(hypotheses);
  } else if (kept_.size() == kMostKept) {
    keeps_ = false;
    kept_.resize(kRevised);
  }
}

bool Start::isUndecided(const Hypotheses& hypotheses) const
{
  const bool has_rivals = hypotheses.hasRivalsInDirection() || (candidates_ && candidates_->areWaiting());
  return has_rivals && hypotheses.front().poses.size() >= kFirstSweeps && !isDecided();
}

bool Start::canBeDecided(const Hypotheses& hypotheses) const
{
  const bool more_would_tell = hypotheses.hasRivalsInDirection() && !leavesNoTrace(hypotheses);
  return !isSearching() && !more_would_tell && hypotheses.front().poses.size() >= kFirstSweeps;
}

/// Whether most of the first sweeps do not tell of a direction, and nobody else did.
bool Start::leavesNoTrace(const Hypotheses& hypotheses) const
{
  const Hypothesis& best = hypotheses.front();
  return 2 * best.without_trace > std::min(best.poses.size(), kFirstSweeps) && !was_hinted_;
}

/// The best hypothesis of each direction of time stays. Where a motion leaves no trace, the least is as good as any.
void Start::beginRevision(Hypotheses& hypotheses)
{
  leaves_no_trace_ = leavesNoTrace(hypotheses);
  hypotheses.keepOneOfEachDirection(leaves_no_trace_ ? Preference::least_motion : Preference::likeliest);
  for (const Hypothesis& hypothesis : hypotheses.all()) {
    std::vector<SE3> first = middlesOf(hypothesis.poses);  // those found with a young map, and some that are trusted
    first.resize(std::min(first.size(), kRevised));
    revisions_.push_back({hypothesis.number, BackwardPass(kept_, first, hypothesis.track.settings())});
  }
}

void Start::revise(Hypotheses& hypotheses)
{
  hypotheses.dropLost();
  keyframes_.push_back(hypotheses.tookIn());
  const std::vector<Hypothesis>& all = hypotheses.all();
  const auto isLost = [&](const Revision& revision) {
    return std::none_of(all.begin(), all.end(), [&](const Hypothesis& h) { return h.number == revision.number; });
  };
  revisions_.erase(std::remove_if(revisions_.begin(), revisions_.end(), isLost), revisions_.end());
  const TrackSettings& settings = hypotheses.front().track.settings();
  if (std::all_of(revisions_.begin(), revisions_.end(), [](const Revision& r) { return r.pass.isDone(); })) {
    return settle(hypotheses);
  }
  const int passes = static_cast<int>(revisions_.size());
  const int each = (settings.start_effort + passes - 1) / passes;
  eachSideBySide(settings.threads, revisions_.size(), [&](std::size_t i) {
    for (int n = 0; n < each && !revisions_[i].pass.isDone(); ++n) {
      revisions_[i].pass.step(kept_);
    }
  });
}

/// The first sweeps go where the last ones say they were: one track after the other, the best one last, since each map
/// takes about as long as a few sweeps.
void Start::settle(Hypotheses& hypotheses)
{
  std::vector<Hypothesis>& all = hypotheses.all();
  const auto revisionOf = [this](const Hypothesis& hypothesis) {
    return std::find_if(revisions_.begin(), revisions_.end(),
                        [&](const Revision& r) { return r.number == hypothesis.number; });
  };
  if (keyframes_.size() < kept_.size()) {
    const std::vector<SweepPose> revised = revisionOf(all[0])->pass.poses(all[0].poses);
    std::vector<SE3> first = middlesOf(revised.empty() ? all[0].poses : revised);
    first.resize(kept_.size() - keyframes_.size());
    const std::vector<bool> among_first = keyframesAmong(first, all[0].track.settings());
    keyframes_.insert(keyframes_.begin(), among_first.begin(), among_first.end());
  }
  const auto isLeft = [&](const Hypothesis& hypothesis) { return !revisionOf(hypothesis)->is_done; };
  const auto next = std::find_if(all.rbegin(), all.rend(), isLeft);
  if (next != all.rend()) {
    const auto revision = revisionOf(*next);
    makeAgain(*next, revision->pass);
    if (leaves_no_trace_) {
      next->track.forgetAlong(next->last.report.weak_directions, static_cast<double>(next->poses.size()));
    }
    revision->is_done = true;
  }
  is_settled_ = std::none_of(all.begin(), all.end(), isLeft);
  for (Hypothesis& hypothesis : all) {
    hypothesis.track.beginEvidence();  // until the maps have taken in the same
  }
}

/// Its map, with poses that are known better. If they are not, it stays as it is, unless there were several hypotheses:
/// their maps must not differ in what they took in. It does, too, if that was too much to be kept.
void Start::makeAgain(Hypothesis& hypothesis, const BackwardPass& pass) const
{
  const std::vector<SweepPose> revised = pass.poses(hypothesis.poses);
  if (!revised.empty()) {
    hypothesis.poses = revised;
  } else if (revisions_.size() == 1) {
    return;
  }
  if (keeps_) {
    hypothesis.track.makeMap(kept_, hypothesis.poses, keyframes_);
  }
}

}  // namespace pcl_floam
