#include "odometry/backward_pass.h"

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

}  // namespace

BackwardPass::BackwardPass(const std::vector<Sweep>& kept, const std::vector<SE3>& forwards,
                           const TrackSettings& settings)
    : back_(settings), poses_(forwards)
{
  constexpr std::size_t kTrusted = 4;  // last sweeps, whose poses the others are found from
  std::vector<Sweep> sweeps;
  std::vector<SE3> last;
  left_ = poses_.size() - kTrusted;
  for (std::size_t k = poses_.size(); k-- > left_;) {
    last.push_back(poses_[k]);
    sweeps.push_back(backwards(kept, k, poses_.size()));
  }
  back_.begin(sweeps, last, keyframesAmong(last, settings));
}

void BackwardPass::step(const std::vector<Sweep>& kept)
{
  const Sweep sweep = backwards(kept, --left_, poses_.size());
  if (!back_.step(sweep).report.hasConverged()) {
    is_lost_ = true;
    left_ = 0;
    return;
  }
  back_.updateMap(sweep);
  poses_[left_] = back_.pose().middle;
}

std::vector<SE3> BackwardPass::poses(const std::vector<SE3>& forwards) const
{
  if (is_lost_) {
    return {};
  }
  std::vector<SE3> poses = forwards;
  std::copy(poses_.begin(), poses_.end(), poses.begin());
  const SE3 first_T_world = poses[0].inverse();
  for (SE3& pose : poses) {
    pose = first_T_world * pose;
  }
  return poses;
}

}  // namespace pcl_floam
