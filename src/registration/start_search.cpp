#include "registration/start_search.h"

#include <algorithm>
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

/// Poses that thinned clouds lead to, of which the full ones agree best with the one that stays.
class StartSearch {
public:
  StartSearch(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
              CloudAlignment& alignment)
      : source_(source),
        target_(target),
        run_(run),
        alignment_(alignment),
        targets_(target.thinnedLevels()),
        sources_(thinnedAlike(source, target, run.threads)),
        guess_(alignment.pose()),
        best_(guess_),
        most_(agreement())
  {
  }

  /// Clouds that share half of what they show are drawn away from a good guess by all the rest. So matches are never
  /// farther apart than they are in the end.
  void lookNear()
  {
    if (!sources_.empty()) {
      CloudRegistrationRun near = run_;
      const double spacing = std::max(sources_.front().spacing, targets_.front().spacing);
      near.max_distance = std::min(run_.max_distance, kGateSpacings * spacing);
      drawSurfaces(0, near);
      propose();
    }
  }

  void drawSurfaces()
  {
    for (std::size_t i = sources_.size(); i-- > 0;) {
      drawSurfaces(i, run_);
    }
  }

  void drawPoints()
  {
    for (std::size_t i = sources_.size(); i-- > 0;) {
      align(CloudMatching(sources_[i], targets_[i], run_, false, 1.0));
    }
    if (std::max(source_.full().tree.size(), target_.full().tree.size()) <= kMostPoints) {
      align(CloudMatching(source_.full(), target_.full(), run_, false, 1.0));
    }
  }

  /// The next ones begin at the guess again.
  void propose()
  {
    const double agreement = this->agreement();
    if (agreement > most_) {
      best_ = alignment_.pose();
      most_ = agreement;
    }
    alignment_.setPose(guess_);
  }

  [[nodiscard]] const SE3& best() const { return best_; }

private:
  void drawSurfaces(std::size_t i, const CloudRegistrationRun& run)
  {
    align(CloudMatching(sources_[i], targets_[i], run, false, kAlongSurfaces, kWidth * targets_[i].voxel));
  }

  void align(CloudMatching level)
  {
    if (2.0 * level.spacing() <= run_.max_distance) {  // else its points' neighbours are farther than matches may be
      alignment_.align(level, kCoarseIterations, kCoarseEpsilon * level.spacing(), false);
    }
  }

  /// Of the full clouds, for thinned ones look alike in many places.
  [[nodiscard]] double agreement() const
  {
    return CloudMatching(source_.full(), target_.full(), run_, false, kAlongSurfaces).agreementAt(alignment_.pose());
  }

  const CloudPyramid& source_;
  const CloudPyramid& target_;
  const CloudRegistrationRun& run_;
  CloudAlignment& alignment_;
  const std::vector<CloudLevel>& targets_;
  std::vector<CloudLevel> sources_;
  SE3 guess_;
  SE3 best_;
  double most_;
};

}  // namespace

void findStart(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run,
               CloudAlignment& alignment)
{
  StartSearch search(source, target, run, alignment);
  search.lookNear();
  search.drawSurfaces();
  search.propose();
  search.drawPoints();
  search.drawSurfaces();
  search.propose();
  alignment.setPose(search.best());
}

}  // namespace pcl_floam
