#include "odometry/backward_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// Sweep \p k of the first \p count as the one after it sees it.
Sweep backwards(const std::vector<Sweep>& kept, std::size_t k, std::size_t count)
{
  Sweep sweep = kept[k];
  sweep.periods = k + 1 < count ? kept[k + 1].periods : 1.0;
  sweep.fraction = -sweep.fraction;
  sweep.hint.reset();
  if (k + 1 < count && kept[k + 1].hint) {
    sweep.hint = kept[k + 1].hint->inverse();
  }
  sweep.factors = {};
  return sweep;
}

/// On the way back nothing is forgotten that lies ahead.
TrackSettings withoutHorizon(TrackSettings settings)
{
  settings.horizon = HUGE_VAL;
  return settings;
}

}  // namespace

BackwardPass::BackwardPass(std::vector<SweepPose> forwards, const TrackSettings& settings)
    : back_(withoutHorizon(settings)),
      forwards_(std::move(forwards)),
      found_(forwards_.size() - kTrusted),
      count_(forwards_.size()),
      left_(found_.size()),
      in_map_(count_)
{
}

bool BackwardPass::step(const std::vector<Sweep>& kept, WorkShare& share)
{
  if (!share.take(has_begun_ ? WorkShare::kBack : WorkShare::kTurnBack)) {
    return false;
  }
  if (has_begun_) {
    findNext(kept);
  } else {
    begin(kept);
  }
  return true;
}

void BackwardPass::begin(const std::vector<Sweep>& kept)
{
  std::vector<Sweep> sweeps;
  std::vector<SweepPose> last;
  for (std::size_t k = count_; k-- > left_;) {
    last.push_back(forwards_[k]);
    sweeps.push_back(backwards(kept, k, count_));
  }
  back_.begin(sweeps, last, keyframesAmong(last, back_.settings()));
  has_begun_ = true;
}

void BackwardPass::findNext(const std::vector<Sweep>& kept)
{
  const Sweep sweep = backwards(kept, --left_, count_);
  if (!back_.step(sweep).report.hasConverged()) {
    found_.clear();
    left_ = 0;
    return;
  }
  back_.updateMap(sweep, back_.isFar());  // its poses are near ones that are trusted
  found_[left_] = back_.pose();
}

void BackwardPass::takeNext(const Sweep& sweep, const SweepPose& pose, bool is_keyframe)
{
  ++in_map_;
  if (is_keyframe) {
    back_.insert(sweep, pose);
  }
}

std::vector<SweepPose> BackwardPass::poses(std::vector<SweepPose> forwards) const
{
  std::copy(found_.begin(), found_.end(), forwards.begin());
  return forwards;
}

}  // namespace pcl_floam
