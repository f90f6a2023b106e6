#include "odometry/start.h"

#include <algorithm>
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
    if (settings.start_effort > kOfTheFirst) {
      WorkShare share(settings.start_effort - kOfTheFirst, 1);
      candidates_->goOn(share, kept_, hypotheses);
    }
    found = hypotheses.front().last;
  }
  return found;
}

bool Start::step(const Sweep& sweep, Hypotheses& hypotheses)
{
  if (!hypotheses.step(sweep, isDecided() ? Rivals::directions : Rivals::motions, true)) {
    return false;
  }
  WorkShare share(hypotheses.front().track.settings().start_effort, hypotheses.size());
  if (keeps_) {
    kept_.push_back(sweep);
  }
  was_hinted_ = was_hinted_ || sweep.hint.has_value();
  if (isDecided()) {
    revise(share, hypotheses);
  } else {
    follow(share, hypotheses);
  }
  return true;
}

/// After many sweeps rivals are still followed, but motions that have not been tried by then are not.
void Start::follow(WorkShare& share, Hypotheses& hypotheses)
{
  hypotheses.giveUpMotions();
  // What evidence remembers is then of these sweeps, not of how a track began.
  const bool can_be_compared = hypotheses.front().poses.size() > kRememberedSweeps && !leavesNoTrace(hypotheses);
  if (can_be_compared && hypotheses.differInDirectionAlone()) {
    const std::vector<double> given_up = hypotheses.giveUpDirections(2.0 * kWrongDirection);
    if (candidates_) {
      candidates_->giveUpDirections(given_up);
    }
  }
  if (kept_.size() == kMostKept) {
    candidates_.reset();
  } else if (candidates_) {
    candidates_->goOn(share, kept_, hypotheses);
  }
  if (leavesNoTrace(hypotheses)) {
    hypotheses.putFirst(Preference::least_motion);
  }
  const bool more_would_tell = hypotheses.hasRivalsInDirection() && !leavesNoTrace(hypotheses);
  if (!isSearching() && !more_would_tell && hypotheses.front().poses.size() >= kFirstSweeps) {
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
    revisions_.push_back({hypothesis.number, BackwardPass(std::move(first), hypothesis.track.settings())});
  }
  keyframes_ = keyframesAmong(hypotheses.front().poses, hypotheses.front().track.settings());
}

void Start::revise(WorkShare& share, Hypotheses& hypotheses)
{
  hypotheses.dropLost();
  keyframes_.push_back(hypotheses.tookIn());
  const std::vector<Hypothesis>& all = hypotheses.all();
  const auto isLost = [&](const Revision& revision) {
    return std::none_of(all.begin(), all.end(), [&](const Hypothesis& h) { return h.number == revision.number; });
  };
  revisions_.erase(std::remove_if(revisions_.begin(), revisions_.end(), isLost), revisions_.end());
  while (goOn(share, all)) {
  }
  if (std::all_of(revisions_.begin(), revisions_.end(), [this](const Revision& r) { return isDone(r.pass); })) {
    settle(hypotheses);
  }
}

/// All maps or none, since they must differ in nothing but what is judged by them: where some pass has not found the
/// first sweeps, or they were too many to be kept, the maps stay as they are.
bool Start::takesMaps() const
{
  return keeps_ && std::none_of(revisions_.begin(), revisions_.end(), [](const Revision& revision) {
           return revision.pass.isDone() && !revision.pass.hasFound();
         });
}

bool Start::isDone(const BackwardPass& pass) const
{
  return pass.isDone() && (!takesMaps() || pass.inMap() == kept_.size());
}

/// The first pass that is not done goes on, and when all are, the one whose map has taken in least.
/// \return whether the share allows it, and one is left
bool Start::goOn(WorkShare& share, const std::vector<Hypothesis>& all)
{
  const auto next = std::min_element(revisions_.begin(), revisions_.end(), [](const Revision& a, const Revision& b) {
    return a.pass.isDone() != b.pass.isDone() ? b.pass.isDone() : a.pass.inMap() < b.pass.inMap();
  });
  BackwardPass& pass = next->pass;
  if (isDone(pass)) {
    return false;
  }
  if (!pass.isDone()) {
    return pass.step(kept_, share);
  }
  const std::size_t k = pass.inMap();
  if (keyframes_[k] && !share.take(WorkShare::kInsert)) {
    return false;
  }
  const auto own = std::find_if(all.begin(), all.end(), [&](const Hypothesis& h) { return h.number == next->number; });
  pass.takeNext(kept_[k], own->poses[k], keyframes_[k]);
  return true;
}

/// The first sweeps go where the last ones say they were, and the tracks go on with the maps that these have made.
void Start::settle(Hypotheses& hypotheses)
{
  const bool take_maps = takesMaps();
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
