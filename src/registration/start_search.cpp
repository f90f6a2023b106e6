#include "registration/start_search.h"

#include "registration/start_choice.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_floam {

namespace {

/// No thinned level has fewer points than this.
constexpr std::size_t kFewestPoints = 250;

/// Full clouds of more points are too much for the many iterations that thinned ones get.
constexpr std::size_t kMostPoints = 1500;

/// Many iterations, as each is cheap and points drawn to points move slowly; no finer than this, in spacings.
constexpr int kCoarseIterations = 100;
constexpr double kCoarseEpsilon = 2e-2;

/// Of points drawn to points, directions along surfaces count as much as those across them at first, and then this
/// much of what they did, from level to level.
constexpr double kAlongFalls = 0.1;

/// How far off the pose may be on a level where surfaces are drawn to surfaces, in its voxels.
constexpr double kWidth = 0.5;

}  // namespace

StartSearch::StartSearch(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
                         CloudAlignment& alignment)
    : source_(source), target_(target), run_(run), alignment_(alignment)
{
  for (const CloudLevel& level : target.thinnedLevels()) {
    CloudLevel next = thinnedLevel(sources_.empty() ? source.full() : sources_.back(), level.voxel, run.threads);
    if (std::min(next.tree.size(), level.tree.size()) < kFewestPoints) {
      break;
    }
    sources_.push_back(std::move(next));
  }
}

void StartSearch::find()
{
  const SE3 guess = alignment_.pose();
  drawSurfaces(guess);
  const StartChoice choice(source_.full(), target_.full(), run_.max_distance, run_.threads);
  if (choice.isClose(guess)) {
    return;
  }
  const SE3 by_surfaces = alignment_.pose();
  alignment_.setPose(guess);
  drawPoints();
  alignment_.setPose(choice.better(alignment_.pose(), guess));
  if (!sources_.empty()) {
    drawSurfaces(alignment_.pose());
    // Surfaces cannot tell where flat clouds lie, and points only how much of them overlaps: the product counts both.
    const auto misfit = [&](const SE3& pose) { return cost(0, pose) * choice.cost(pose); };
    alignment_.setPose(misfit(alignment_.pose()) <= misfit(by_surfaces) ? alignment_.pose() : by_surfaces);
  }
}

void StartSearch::drawPoints()
{
  double along = 1.0;
  for (std::size_t level = sources_.size(); level-- > 0;) {
    drawPoints(sources_[level], target_.thinnedLevels()[level], along);
  }
  if (std::max(source_.full().tree.size(), target_.full().tree.size()) <= kMostPoints) {
    drawPoints(source_.full(), target_.full(), along);
  }
}

/// \param along becomes what it is on the next level
void StartSearch::drawPoints(const CloudLevel& source, const CloudLevel& target, double& along)
{
  if (2.0 * target.spacing > run_.max_distance) {
    return;
  }
  if (along == 1.0) {
    align(LevelAlignment(source, target, run_, false, along, false));
  }
  align(LevelAlignment(source, target, run_, false, along));
  along = std::max(kAlongSurfaces, kAlongFalls * along);
}

/// Coarser levels propose, finer ones choose whether to go on from there or from the start.
void StartSearch::drawSurfaces(const SE3& start)
{
  alignment_.setPose(start);
  for (std::size_t level = sources_.size(); level-- > 0;) {
    if (2.0 * target_.thinnedLevels()[level].spacing <= run_.max_distance) {
      alignment_.setPose(cost(level, alignment_.pose()) <= cost(level, start) ? alignment_.pose() : start);
      align(surfaces(level));
    }
  }
}

void StartSearch::align(LevelAlignment level)
{
  alignment_.align(level, kCoarseIterations, kCoarseEpsilon * level.spacing(), false);
}

LevelAlignment StartSearch::surfaces(std::size_t level) const
{
  const CloudLevel& target = target_.thinnedLevels()[level];
  return {sources_[level], target, run_, false, kAlongSurfaces, true, kWidth * target.voxel};
}

/// What the typical match of surfaces on a level costs at a pose.
double StartSearch::cost(std::size_t level, const SE3& pose) const
{
  const NormalEquations sums = surfaces(level).evaluate(pose, [this](const SE3& p) { return alignment_.toFrames(p); });
  return sums.count() > 0 ? sums.cost / sums.count() : std::numeric_limits<double>::infinity();
}

}  // namespace pcl_floam
