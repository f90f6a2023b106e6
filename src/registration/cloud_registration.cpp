#include <pcl_floam/registration/core/cloud_registration.h>

#include "common/covariance.h"
#include "common/perturbation.h"
#include "registration/cloud_alignment.h"
#include "registration/locked_motions.h"
#include "registration/start_search.h"
#include "registration/weak_directions.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pcl_floam {

namespace {

/// Converged when a step moves no typical point by more than this, in spacings.
constexpr double kEpsilon = 5e-4;
constexpr double kAtRest = 1e-5;

/// On clouds that are thin already.
constexpr double kRoughEpsilon = 2e-2;
constexpr int kRoughIterations = 100;

/// Directions that hold less well than this many times a slide along a plane are reported as weak.
constexpr double kWeak = 5.0;

/// See \ref kFewPoints.
constexpr double kAlongOfFew = 0.05;

/// Whoever asks for fewer iterations than this wants to see them one by one.
constexpr int kFewestForCoarse = 4;

class Registration {
public:
  Registration(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run)
      : source_(source), target_(target), run_(run), alignment_(source, target, run)
  {
    report_.target_T_source = run.guess;
  }

  RegistrationReport run()
  {
    const SE3 guess = alignment_.pose();
    if (run_.coarse_first && run_.max_iterations >= kFewestForCoarse) {
      findStart(source_, target_, run_, alignment_);
    }
    CloudMatching level(source_.full(), target_.full(), run_, true, along());
    // The user's threshold if it is the finer one, as far as single precision goes.
    const double usual = kEpsilon * level.spacing();
    const double epsilon =
        run_.epsilon > 0.0 ? std::min(usual, std::max(run_.epsilon, kAtRest * level.spacing())) : usual;
    report_.termination = alignment_.align(level, run_.max_iterations, epsilon, true);
    report_.iterations = alignment_.iterations();
    WeakDirections weak(alignment_, level, kWeak * kAlongSurfaces);
    const bool whole = report_.hasConverged() && run_.max_iterations >= kFewestForCoarse;
    if (whole && weak.settle(guess, epsilon)) {
      report_.termination = Termination::converged;
    }
    return finish(whole ? weak.shares() : std::vector<double>());
  }

  SE3 runRoughly()
  {
    findStart(source_, target_, run_, alignment_);
    const double width = std::max(source_.full().spacing, target_.full().spacing);
    CloudMatching level(source_.full(), target_.full(), run_, false, kAlongSurfaces, width);
    alignment_.align(level, kRoughIterations, kRoughEpsilon * level.spacing(), false);
    return alignment_.toFrames(alignment_.pose());
  }

private:
  [[nodiscard]] double along() const
  {
    return std::min(source_.full().tree.size(), target_.full().tree.size()) < kFewPoints ? kAlongOfFew : kAlongSurfaces;
  }

  /// \param shares see WeakDirections
  RegistrationReport finish(const std::vector<double>& shares)
  {
    const NormalEquations& sums = alignment_.sums();
    report_.edge_correspondences = sums.edges;
    report_.plane_correspondences = sums.planes;
    report_.point_correspondences = sums.points;
    report_.edge_inliers = sums.edge_inliers;
    report_.plane_inliers = sums.plane_inliers;
    const SE3 result = alignment_.toFrames(alignment_.pose());
    if (!result.isFinite()) {
      report_.termination = Termination::degenerate;
    }
    if (!report_.hasConverged()) {
      return report_;
    }
    report_.target_T_source = result;
    report_.cost = sums.cost;
    report_.residual_rms = std::sqrt(sums.residualVariance());
    const InformationAnalysis analysis = alignment_.analysis();
    report_.weak_directions = analysis.weakDirections(kWeak * along() * analysis.largest(), shares);
    const Matrix6 to_centroid = leverOf(-alignment_.arm());
    report_.information = propagated(to_centroid.transpose(), sums.information);
    const Matrix6 to_origin = leverOf(alignment_.arm());
    const Matrix6 covariance = analysis.covariance(kMatchesPerIndependentOne * sums.residualVariance(), shares);
    report_.covariance = covarianceWithLocked(propagated(to_origin, covariance), run_.locked);
    return report_;
  }

  const CloudPyramid& source_;
  const CloudPyramid& target_;
  const CloudRegistrationRun& run_;
  CloudAlignment alignment_;
  RegistrationReport report_;
};

}  // namespace

PreparedCloud::PreparedCloud(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads)
    : pyramid_(std::make_unique<CloudPyramid>(cloud, selectable, threads))
{
}

PreparedCloud PreparedCloud::thinned(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads)
{
  return PreparedCloud(std::make_unique<CloudPyramid>(cloud, selectable, threads, true));
}

PreparedCloud::PreparedCloud(std::unique_ptr<CloudPyramid> pyramid) : pyramid_(std::move(pyramid)) {}

PreparedCloud::~PreparedCloud() = default;
PreparedCloud::PreparedCloud(PreparedCloud&& other) noexcept = default;
PreparedCloud& PreparedCloud::operator=(PreparedCloud&& other) noexcept = default;

bool PreparedCloud::empty() const
{
  return pyramid_->empty();
}

RegistrationReport registerClouds(const PreparedCloud& source, const PreparedCloud& target,
                                  const CloudRegistrationRun& run)
{
  RegistrationReport report;
  report.target_T_source = run.guess;
  if (!run.guess.isFinite()) {
    report.termination = Termination::invalid_input;
    report.target_T_source = SE3();
  } else if (target.empty()) {
    report.termination = Termination::empty_target;
  } else if (source.empty()) {
    report.termination = Termination::too_few_features;
  } else {
    return Registration(source.pyramid(), target.pyramid(), run).run();
  }
  return report;
}

SE3 alignRoughly(const PreparedCloud& source, const PreparedCloud& target, const CloudRegistrationRun& run)
{
  if (!run.guess.isFinite() || target.empty() || source.empty()) {
    return run.guess;
  }
  const SE3 result = Registration(source.pyramid(), target.pyramid(), run).runRoughly();
  return result.isFinite() ? result : run.guess;
}

}  // namespace pcl_floam
