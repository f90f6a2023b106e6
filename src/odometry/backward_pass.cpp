#include "odometry/backward_pass.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Sweep \p k of the first \p count as the one after it sees it.
Sweep backwards(const std::vector<Sweep>& kept, std::size_t k, std::size_t count)
{
  Sweep sweep = kept[k];
  sweep.periods = k + 1 < count ? kept[k + 1].periods : 1.0;
  sweep.fraction = -sweep.fraction;
  sweep.hint.reset();
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

BackwardPass::BackwardPass(const std::vector<Sweep>& kept, const std::vector<SweepPose>& forwards,
                           const TrackSettings& settings)
    : back_(withoutHorizon(settings)), count_(forwards.size()), in_map_(count_)
{
  std::vector<Sweep> sweeps;
  std::vector<SweepPose> last;
  left_ = count_ - kTrusted;
  found_.resize(left_);
  for (std::size_t k = count_; k-- > left_;) {
    last.push_back(forwards[k]);
    sweeps.push_back(backwards(kept, k, count_));
  }
  back_.begin(sweeps, last, keyframesAmong(last, settings));
}

void BackwardPass::step(const std::vector<Sweep>& kept)
{
  const Sweep sweep = backwards(kept, --left_, count_);
  if (!back_.step(sweep).report.hasConverged()) {
    found_.clear();
    left_ = 0;
    return;
  }
  back_.updateMap(sweep);
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
  if (found_.empty()) {
    return {};
  }
  std::copy(found_.begin(), found_.end(), forwards.begin());
  return forwards;
}

}  // namespace pcl_floam
