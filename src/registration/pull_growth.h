/// \file pull_growth.h
/// Whether what seems to hold a pose does: the pose is moved, and what pulls it back is looked at.
#pragma once

namespace pcl_floam {

/// What residuals say of a pose along a motion.
struct Pull {
  double against = 0.0;    ///< the gradient of their sum of squares, halved, by the motion
  double stiffness = 0.0;  ///< by which that grows with the way, as their derivatives have it
};

/// How much of the growth that is promised is there, when a pose has gone some way to either side. What is drawn to the
/// nearest part of a sampling pattern, rings on a wall or the points of a surface, is drawn to the next part after half
/// of the pattern's spacing. If the way is longer than that, its pull comes back nowhere, however many points have it.
/// 1: all; with noise it may be below 0.
inline double shareOfGrowth(const Pull& behind, const Pull& ahead, double way)
{
  return (ahead.against - behind.against) / (way * (behind.stiffness + ahead.stiffness));
}

}  // namespace pcl_floam
