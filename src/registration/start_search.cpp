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

/// What the typical match of surfaces costs at a pose. Of the full clouds, for thinned ones look alike in many places.
double costAt(const SE3& pose, const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
              const CloudAlignment& alignment)
{
  CloudMatching level(source.full(), target.full(), run, false, kAlongSurfaces);
  const NormalEquations sums = level.evaluate(pose, [&](const SE3& p) { return alignment.toFrames(p); });
  return sums.count() >= run.min_correspondences ? sums.cost / sums.count() : std::numeric_limits<double>::infinity();
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
  const auto drawSurfaces = [&] {
    for (std::size_t i = sources.size(); i-- > 0;) {
      align(CloudMatching(sources[i], targets[i], run, false, kAlongSurfaces, kWidth * targets[i].voxel));
    }
  };
  SE3 best = guess;
  double least = costAt(guess, source, target, run, alignment);
  const auto propose = [&] {
    const double cost = costAt(alignment.pose(), source, target, run, alignment);
    if (cost < least) {
      best = alignment.pose();
      least = cost;
    }
  };
  drawSurfaces();
  propose();
  alignment.setPose(guess);
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
