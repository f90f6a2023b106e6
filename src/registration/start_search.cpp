#include "registration/start_search.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace pcl_floam {

namespace {

/// No thinned level has fewer points than this.
constexpr std::size_t kFewestPoints = 250;

/// Full clouds of more points are too much for the many iterations that thinned ones get.
constexpr std::size_t kMostPoints = 1500;

/// Many iterations, as each is cheap and points drawn to points move slowly; no finer than this, in spacings.
constexpr int kCoarseIterations = 100;
constexpr double kCoarseEpsilon = 2e-2;

/// How far off the pose may be on a level where surfaces are drawn to surfaces, in its voxels.
constexpr double kWidth = 0.5;

/// What is near the guess, in the finest level's voxels.
constexpr double kNear = 3.0;

/// The source in the voxels of the target's levels.
std::vector<CloudLevel> thinnedAlike(const CloudPyramid& source, const CloudPyramid& target, int threads)
{
  std::vector<CloudLevel> sources;
  for (const CloudLevel& level : target.thinnedLevels()) {
    CloudLevel next = thinnedLevel(sources.empty() ? source.full() : sources.back(), level.voxel, threads);
    if (std::min(next.tree.size(), level.tree.size()) < kFewestPoints) {
      break;
    }
    sources.push_back(std::move(next));
  }
  return sources;
}

/// How much more of the full clouds a pose has explained than contradicted; thinned ones look alike in many places.
double agreementAt(const SE3& pose, const CloudPyramid& source, const CloudPyramid& target,
                   const CloudRegistrationRun& run)
{
  return CloudMatching(source.full(), target.full(), run, false, kAlongSurfaces).agreementAt(pose);
}

}  // namespace

void findStart(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
               CloudAlignment& alignment)
{
  const SE3 guess = alignment.pose();
  const std::vector<CloudLevel>& targets = target.thinnedLevels();
  const std::vector<CloudLevel> sources = thinnedAlike(source, target, run.threads);
  const auto align = [&](CloudMatching level) {
    if (2.0 * level.spacing() <= run.max_distance) {  // else its points' neighbours are farther than matches may be
      alignment.align(level, kCoarseIterations, kCoarseEpsilon * level.spacing(), false);
    }
  };
  const auto drawTo = [&](std::size_t i) {
    align(CloudMatching(sources[i], targets[i], run, false, kAlongSurfaces, kWidth * targets[i].voxel));
  };
  const auto drawSurfaces = [&] {
    for (std::size_t i = sources.size(); i-- > 0;) {
      drawTo(i);
    }
  };
  SE3 best = guess;
  double most = agreementAt(guess, source, target, run);
  const auto propose = [&] {
    const double agreement = agreementAt(alignment.pose(), source, target, run);
    if (agreement > most) {
      best = alignment.pose();
      most = agreement;
    }
    alignment.setPose(guess);
  };
  if (!sources.empty()) {
    CloudRegistrationRun near = run;
    near.max_distance = std::min(run.max_distance, kNear * targets.front().voxel);
    CloudMatching level(sources.front(), targets.front(), near, false, kAlongSurfaces, kWidth * targets.front().voxel);
    if (2.0 * level.spacing() <= run.max_distance) {
      alignment.align(level, kCoarseIterations, kCoarseEpsilon * level.spacing(), false);
    }
    propose();
  }
  drawSurfaces();
  propose();
  for (std::size_t i = sources.size(); i-- > 0;) {
    align(CloudMatching(sources[i], targets[i], run, false, 1.0));
  }
  if (std::max(source.full().tree.size(), target.full().tree.size()) <= kMostPoints) {
    align(CloudMatching(source.full(), target.full(), run, false, 1.0));
  }
  drawSurfaces();
  propose();
  alignment.setPose(best);
}

}  // namespace pcl_floam
