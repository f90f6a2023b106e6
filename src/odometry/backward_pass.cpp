#include "odometry/backward_pass.h"

namespace pcl_floam {

namespace {

/// Sweep \p k as the one after it sees it.
Sweep backwards(const std::vector<Sweep>& kept, std::size_t k)
{
  Sweep sweep = kept[k];
  sweep.periods = k + 1 < kept.size() ? kept[k + 1].periods : 1.0;
  sweep.fraction = -sweep.fraction;
  sweep.hint.reset();
  sweep.factors = {};
  return sweep;
}

}  // namespace

std::vector<SE3> posesFoundBackwards(const std::vector<Sweep>& kept, const std::vector<SE3>& forwards,
                                     const TrackSettings& settings)
{
  constexpr std::size_t kTrusted = 4;  // last sweeps, whose poses the others are found from
  const std::size_t n = kept.size();
  std::vector<Sweep> sweeps;
  std::vector<SE3> poses(n);
  std::vector<SE3> last;
  for (std::size_t k = n; k-- > n - kTrusted;) {
    poses[k] = forwards[k];
    last.push_back(poses[k]);
    sweeps.push_back(backwards(kept, k));
  }
  Track back(settings);
  back.begin(sweeps, last, keyframesAmong(last, settings));
  for (std::size_t k = n - kTrusted; k-- > 0;) {
    const Sweep sweep = backwards(kept, k);
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
