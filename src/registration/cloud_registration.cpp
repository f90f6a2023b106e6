#include <pcl_floam/registration/cloud_registration.h>

#include "registration/alignment_analysis.h"
#include "registration/cloud_pyramid.h"
#include "registration/level_alignment.h"
#include "registration/start_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

namespace {

/// No thinned level has fewer points than this.
constexpr std::size_t kFewestPoints = 250;

/// Full clouds of more points are too much for the many iterations that thinned ones get.
constexpr std::size_t kMostPoints = 1500;

/// Converged when a step moves no typical point by more than this, in spacings.
constexpr double kEpsilon = 5e-4;
constexpr double kCoarseEpsilon = 2e-2;
constexpr double kAtRest = 1e-5;

/// How much directions along surfaces count: at last enough to hold a cloud where surfaces do not, too little to pull
/// at one that may slide; on thinned clouds, where the slide is what matters, as much as those across them at first.
constexpr double kAlong = 1e-3;
constexpr double kAlongFalls = 0.1;  ///< from level to level

/// Directions that hold less well than this many times a slide along a plane are reported as weak.
constexpr double kWeak = 5.0;

/// Few points are key points rather than samples of surfaces: each tells a place, not only a surface.
constexpr std::size_t kFewPoints = 1000;
constexpr double kAlongOfFew = 0.05;

/// On each thinned level: many, as each is cheap and points drawn to points move slowly.
constexpr int kCoarseIterations = 100;

/// Whoever asks for fewer iterations than this wants to see them one by one.
constexpr int kFewestForCoarse = 4;

class Registration {
public:
  Registration(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run)
      : source_(source),
        target_(target),
        run_(run),
        source_T_origin_(Eigen::Matrix3d::Identity(), source.origin()),
        target_T_origin_(Eigen::Matrix3d::Identity(), target.origin()),
        pose_(target_T_origin_.inverse() * run.guess * source_T_origin_)
  {
    report_.target_T_source = run.guess;
  }

  RegistrationReport run()
  {
    if (run_.coarse_first && run_.max_iterations >= kFewestForCoarse) {
      const StartChoice choice(source_.full(), target_.full(), run_.max_distance, run_.threads);
      if (!choice.isClose(pose_)) {
        const SE3 guess = pose_;
        alignThinned();
        pose_ = choice.better(pose_, guess);
      }
    }
    report_.termination = Termination::iteration_limit;
    LevelAlignment alignment(source_.full(), target_.full(), run_, true, along());
    align(alignment, run_.max_iterations, finestEpsilon(alignment.spacing()), true);
    return finish();
  }

  SE3 runRoughly()
  {
    const StartChoice choice(source_.full(), target_.full(), run_.max_distance, run_.threads);
    const SE3 guess = pose_;
    if (choice.isClose(guess)) {
      return run_.guess;
    }
    alignThinned();
    LevelAlignment alignment(source_.full(), target_.full(), run_, false, kAlongFalls);
    align(alignment, kCoarseIterations, kCoarseEpsilon * alignment.spacing(), false);
    return toFrames(choice.better(pose_, guess));
  }

private:
  [[nodiscard]] SE3 toFrames(const SE3& pose) const { return target_T_origin_ * pose * source_T_origin_.inverse(); }

  [[nodiscard]] double along() const
  {
    return std::min(source_.full().tree.size(), target_.full().tree.size()) < kFewPoints ? kAlongOfFew : kAlong;
  }

  /// The user's threshold if it is the finer one, as far as single precision goes.
  [[nodiscard]] double finestEpsilon(double spacing) const
  {
    const double finest = run_.epsilon > 0.0 ? std::max(run_.epsilon, kAtRest * spacing) : kEpsilon * spacing;
    return std::min(kEpsilon * spacing, finest);
  }

  /// Registers ever less thinned clouds; whatever fails there leaves the pose as it was.
  void alignThinned()
  {
    const std::vector<CloudLevel>& targets = target_.thinnedLevels();
    std::vector<CloudLevel> sources;  // in the target's voxels
    for (const CloudLevel& target : targets) {
      CloudLevel next = thinnedLevel(sources.empty() ? source_.full() : sources.back(), target.voxel, run_.threads);
      sources.push_back(std::move(next));
    }
    double along = 1.0;
    for (std::size_t level = targets.size(); level-- > 0;) {
      if (std::min(sources[level].tree.size(), targets[level].tree.size()) >= kFewestPoints) {
        alignThinned(sources[level], targets[level], along);
      }
    }
    if (std::max(source_.full().tree.size(), target_.full().tree.size()) <= kMostPoints) {
      alignThinned(source_.full(), target_.full(), along);
    }
  }

  /// \param along becomes what it is on the next level
  void alignThinned(const CloudLevel& source, const CloudLevel& target, double& along)
  {
    if (2.0 * target.spacing > run_.max_distance) {
      return;
    }
    if (along == 1.0) {
      alignThinned(LevelAlignment(source, target, run_, false, along, false));
    }
    alignThinned(LevelAlignment(source, target, run_, false, along));
    along = std::max(kAlong, kAlongFalls * along);
  }

  void alignThinned(LevelAlignment alignment)
  {
    align(alignment, kCoarseIterations, kCoarseEpsilon * alignment.spacing(), false);
    report_.iterations = 0;
  }

  /// Iterates on one level until it has converged or \p most iterations were done in all.
  void align(LevelAlignment& alignment, int most, double epsilon, bool finest)
  {
    while (report_.iterations < most) {
      sums_ = alignment.evaluate(pose_, [this](const SE3& pose) { return toFrames(pose); });
      ++report_.iterations;
      if (sums_.count() < run_.min_correspondences) {
        report_.termination = finest ? Termination::too_few_correspondences : Termination::not_run;
        return;
      }
      const Vector6 step = analysis().step();
      if (!step.allFinite()) {
        report_.termination = Termination::degenerate;
        return;
      }
      const bool over = take(step, alignment, finest);
      if (over || step.head<3>().norm() + source_.extent() * step.tail<3>().norm() < epsilon) {
        report_.termination = Termination::converged;
        return;
      }
    }
  }

  /// Applies a step that turns about the source's centroid. \return true if the user says that it is enough
  bool take(const Vector6& step, const LevelAlignment& alignment, bool finest)
  {
    const SE3 before = toFrames(pose_);
    pose_.rotation = nearestRotation(expSO3(step.tail<3>()) * pose_.rotation);
    pose_.translation += step.head<3>();
    lockTranslation();
    if (!run_.iterated || !finest) {
      return false;
    }
    CloudIteration iteration;
    iteration.target_T_source = toFrames(pose_);
    iteration.step = iteration.target_T_source * before.inverse();
    iteration.matches = &alignment.matches();
    return run_.iterated(iteration);
  }

  [[nodiscard]] Eigen::Vector3d arm() const { return pose_.rotation * source_.origin(); }

  [[nodiscard]] AlignmentAnalysis analysis() const
  {
    return {sums_, source_.extent(), freeMotions(run_.locked, arm())};
  }

  /// Takes out what a turn about the centroid, which is straight to first order, has added.
  void lockTranslation()
  {
    const SE3 pose = toFrames(pose_);
    for (int i = 0; i < 3; ++i) {
      if (run_.locked[static_cast<std::size_t>(i)]) {
        pose_.translation[i] += run_.guess.translation[i] - pose.translation[i];
      }
    }
  }

  RegistrationReport finish()
  {
    report_.edge_correspondences = sums_.lines;
    report_.plane_correspondences = sums_.planes;
    report_.point_correspondences = sums_.points;
    report_.edge_inliers = sums_.line_inliers;
    report_.plane_inliers = sums_.plane_inliers;
    const SE3 result = toFrames(pose_);
    if (!result.isFinite()) {
      report_.termination = Termination::degenerate;
    }
    if (!report_.hasConverged()) {
      return report_;
    }
    report_.target_T_source = result;
    analysis().describe(arm(), kWeak * along(), report_);
    for (int i = 0; i < 6; ++i) {
      if (run_.locked[static_cast<std::size_t>(i)]) {  // but for rounding
        report_.covariance.row(i).setZero();
        report_.covariance.col(i).setZero();
      }
    }
    return report_;
  }

  const CloudPyramid& source_;
  const CloudPyramid& target_;
  const CloudRegistrationRun& run_;
  SE3 source_T_origin_;
  SE3 target_T_origin_;
  SE3 pose_;  ///< the present estimate, from the source's origin to the target's
  AlignmentSums sums_;
  RegistrationReport report_;
};

}  // namespace

PreparedCloud::PreparedCloud(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads)
    : pyramid_(std::make_unique<CloudPyramid>(cloud, selectable, threads))
{
}

PreparedCloud PreparedCloud::thinned(const CloudView& cloud, const std::vector<std::uint8_t>& selectable, int threads)
{
  return PreparedCloud(CloudPyramid::thinned(cloud, selectable, threads));
}

PreparedCloud::PreparedCloud(std::unique_ptr<CloudPyramid> pyramid) : pyramid_(std::move(pyramid)) {}

PreparedCloud::~PreparedCloud() = default;
PreparedCloud::PreparedCloud(PreparedCloud&& other) noexcept = default;
PreparedCloud& PreparedCloud::operator=(PreparedCloud&& other) noexcept = default;

bool PreparedCloud::empty() const
{
  return pyramid_->empty();
}

double PreparedCloud::spacing() const
{
  return pyramid_->full().spacing;
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
