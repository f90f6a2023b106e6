#include "odometry/start.h"

#include "common/side_by_side.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pcl_floam {

namespace {

/// First sweeps that are found once more, and what these are found from.
constexpr std::size_t kRevised = kFirstSweeps + BackwardPass::kTrusted;

}  // namespace

SurfaceRegistration Start::findMotion(const Sweep& second, const TrackSettings& settings, Hypotheses& hypotheses)
{
  kept_.push_back(second);
  was_hinted_ = kept_.front().hint.has_value() || second.hint.has_value();
  TrackSettings own = settings;
  own.spare_maps = spare_maps_;
  candidates_.emplace(kept_, own);
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
    follow(hypotheses);
  }
  return true;
}

/// After many sweeps rivals are still followed, but motions that have not been tried by then are not.
void Start::follow(Hypotheses& hypotheses)
{
  hypotheses.giveUpMotions();
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
    std::vector<SweepPose> first = hypothesis.poses;  // those found with a young map, and some that are trusted
    first.resize(std::min(first.size(), kRevised));
    revisions_.push_back({hypothesis.number, BackwardPass(kept_, first, hypothesis.track.settings())});
  }
  keyframes_ = keyframesAmong(hypotheses.front().poses, hypotheses.front().track.settings());
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
  const int passes = static_cast<int>(revisions_.size());
  const int each = (settings.start_effort + passes - 1) / passes;
  eachSideBySide(settings.threads, revisions_.size(), [&](std::size_t i) {
    const auto own =
        std::find_if(all.begin(), all.end(), [&](const Hypothesis& h) { return h.number == revisions_[i].number; });
    goOn(revisions_[i].pass, own->poses, each);
  });
  if (std::all_of(revisions_.begin(), revisions_.end(), [this](const Revision& r) { return isDone(r.pass); })) {
    settle(hypotheses);
  }
}

/// Where the first sweeps were not found, or were too many to be kept, the map stays as it is.
bool Start::isDone(const BackwardPass& pass) const
{
  return pass.isDone() && (!pass.hasFound() || !keeps_ || pass.inMap() == kept_.size());
}

void Start::goOn(BackwardPass& pass, const std::vector<SweepPose>& poses, int registrations) const
{
  constexpr double kTakeOne = 0.25;  // registrations, which take as long as a map does to take in a sweep
  for (double left = registrations; left > 0.0 && !isDone(pass);) {
    if (!pass.isDone()) {
      pass.step(kept_);
      left -= 1.0;
    } else {
      const std::size_t next = pass.inMap();
      pass.takeNext(kept_[next], poses[next], keyframes_[next]);
      left -= kTakeOne;
    }
  }
}

/// The first sweeps go where the last ones say they were, and the tracks go on with the maps that these have made: all
/// or none, since maps must differ in nothing but what is judged by them.
void Start::settle(Hypotheses& hypotheses)
{
  const bool take_maps = keeps_ && std::all_of(revisions_.begin(), revisions_.end(),
                                               [](const Revision& revision) { return revision.pass.hasFound(); });
  for (Hypothesis& hypothesis : hypotheses.all()) {
    BackwardPass& pass = std::find_if(revisions_.begin(), revisions_.end(), [&](const Revision& r) {
                           return r.number == hypothesis.number;
                         })->pass;
    if (pass.hasFound()) {
      hypothesis.poses = pass.poses(hypothesis.poses);
    }
    if (take_maps) {
      hypothesis.track.takeMapOf(std::move(pass.track()));
    }
    if (leaves_no_trace_) {
      hypothesis.track.forgetAlong(hypothesis.last.report.weak_directions,
                                   static_cast<double>(hypothesis.poses.size()));
    }
    hypothesis.track.beginEvidence();  // until the maps have taken in the same
  }
  is_settled_ = true;
}

}  // namespace pcl_floam
