#include <pcl_floam/registration/core/feature_registration.h>

#include "registration/ceres_solver.h"
#include "registration/correspondences.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"
#include "registration/pose_factors.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// So many features lead near the solution, and at most one in so many is taken for that.
constexpr std::size_t kEnoughFeatures = 500;
constexpr std::size_t kMaxStride = 4;
/// Steps of less than so many times the thresholds of convergence are near.
constexpr double kNear = 10.0;

/// More planes take longer and tell hardly more; an edge costs what a plane does, and says less.
constexpr std::size_t kMostPlanes = 1000;
constexpr std::size_t kPlanesPerEdge = 6;

/// Directions with less information than this, over the sum of the weights and with rotations scaled to metres, are
/// weak: the guess is kept along them. What only the noise of the planes' normals seems to tell is taken off. Well
/// constrained directions have 0.1 to 1, the way along a corridor with doors 0.001.
constexpr double kWeakShare = 2e-4;

/// At most so many of the features, evenly taken in their order.
std::vector<Feature> evenly(const std::vector<Feature>& features, std::size_t most)
{
  const std::size_t count = std::min(most, features.size());
  std::vector<Feature> taken(count);
  for (std::size_t i = 0; i < count; ++i) {
    taken[i] = features[i * features.size() / count];
  }
  return taken;
}

/// One registration in progress.
class FeaturePoseEstimation {
public:
  FeaturePoseEstimation(const FeatureSet& source, const FeatureTarget& target, const RegistrationRun& run,
                        const RegistrationParameters& parameters)
      : source_(source),
        run_(run),
        factors_{run.factors, SE3()},
        model_(localModel(run)),
        problem_{target, parameters, run.guess.translation, run.threads},
        trajectory_(startOf(model_, {run.guess.rotation, Eigen::Vector3d::Zero()})),
        search_radius_(std::max(run.max_correspondence_distance, run.guess_uncertainty)),
        stride_(std::clamp<std::size_t>((source.edges.size() + source.planes.size()) / kEnoughFeatures, 1, kMaxStride)),
        edge_weights_(smoothnessWeights(source.edges, FeatureKind::edge, parameters.weights)),
        plane_weights_(smoothnessWeights(source.planes, FeatureKind::plane, parameters.weights))
  {
    report_.target_T_source = run.guess;
  }

  RegistrationReport run()
  {
    report_.termination = Termination::iteration_limit;
    for (int i = 0; i < run_.max_iterations; ++i) {
      if (iterate()) {
        break;
      }
    }
    return finish();
  }

private:
  /// The sweep's model with its poses relative to the problem's origin.
  static SweepModel localModel(const RegistrationRun& run)
  {
    SweepModel model = run.sweep;
    model.held_pose.translation -= run.guess.translation;
    return model;
  }

  static SweepTrajectory startOf(const SweepModel& model, const SE3& local_T_sensor)
  {
    if (model.follows_pose) {
      const Vector6 motion = log(model.held_pose.inverse() * local_T_sensor);
      return SweepTrajectory(local_T_sensor, model.sweep_per_motion * motion, model.reference);
    }
    return SweepTrajectory(local_T_sensor, model.twist, model.reference);
  }

  [[nodiscard]] SE3 pose() const
  {
    return {trajectory_.pose().rotation, trajectory_.pose().translation + problem_.origin};
  }

  /// One iteration of the pose estimation: fresh correspondences, one step. \return true when it is over
  bool iterate()
  {
    if (run_.on_iteration) {
      run_.on_iteration(pose());
    }
    findCorrespondences(problem_, source_, edge_weights_, plane_weights_, trajectory_, search_radius_, stride_,
                        correspondences_);
    const KernelScales scales = adaptKernelScales(correspondences_);
    equations_ = reducedToPose(buildNormalEquations(problem_, correspondences_, scales), model_);
    const PoseEquations besides = this->besides();
    equations_.information += besides.information;
    equations_.gradient += besides.gradient;
    ++report_.iterations;
    if (equations_.count() < kFewestCorrespondences) {
      if (stride_ > 1) {
        stride_ = 1;
        return false;
      }
      report_.termination = Termination::too_few_correspondences;
      return true;
    }
    return take(problem_.parameters.solver == SolverKind::ceres
                    ? solveWithCeres(problem_, model_, correspondences_, scales, besides)
                    : analysis().step());
  }

  [[nodiscard]] InformationAnalysis analysis() const
  {
    return InformationAnalysis(equations_, kWeakShare, freeMotions(problem_.parameters.locked));
  }

  /// What else is known of the pose, as so many residuals of weight 1.
  [[nodiscard]] PoseEquations besides() const
  {
    PoseEquations known = factors_.at(pose(), -trajectory_.pose().translation);
    const double variance = equations_.count() > 0 ? featureVariance(equations_) : 0.0;
    known.information *= variance;
    known.gradient *= variance;
    return known;
  }

  /// Applies a step on the left (Eq. 11). \return true when the iterations are over
  bool take(const Vector6& step)
  {
    if (!step.allFinite()) {
      report_.termination = Termination::degenerate;
      return true;
    }
    trajectory_ = trajectory_.perturbed(step);
    if (model_.follows_pose) {
      trajectory_ = startOf(model_, trajectory_.pose());
    }
    const bool searched_wide = search_radius_ > run_.max_correspondence_distance;
    if (searched_wide) {
      search_radius_ = std::max(run_.max_correspondence_distance, 0.5 * search_radius_);
      correspondences_ = Correspondences();  // they were found within the wider radius
    }
    const bool small =
        step.head<3>().norm() < run_.translation_epsilon && step.tail<3>().norm() < run_.rotation_epsilon;
    const bool near = step.head<3>().norm() < kNear * run_.translation_epsilon &&
                      step.tail<3>().norm() < kNear * run_.rotation_epsilon;
    if (stride_ > 1) {
      stride_ = near && !searched_wide ? 1 : stride_;
      return false;
    }
    if (small && !searched_wide) {
      report_.termination = Termination::converged;
    }
    return report_.termination == Termination::converged;
  }

  RegistrationReport finish()
  {
    report_.edge_correspondences = equations_.edges;
    report_.plane_correspondences = equations_.planes;
    report_.edge_inliers = equations_.edge_inliers;
    report_.plane_inliers = equations_.plane_inliers;
    if (!pose().isFinite()) {
      report_.termination = Termination::degenerate;
    }
    if (report_.hasConverged() && equations_.count() < kFewestCorrespondences) {
      report_.termination = Termination::too_few_correspondences;  // the last iteration found that a quarter is too few
    }
    if (!report_.hasConverged() || !(equations_.weight > 0.0)) {
      return report_;
    }
    const InformationAnalysis analysis = this->analysis();
    report_.target_T_source = pose();
    report_.cost = equations_.cost;
    report_.residual_rms = std::sqrt(equations_.residualVariance());
    report_.information = equations_.information;
    report_.sweep_twist = trajectory_.twist();
    report_.covariance = analysis.covariance(featureVariance(equations_));
    report_.weak_directions = analysis.weakDirections(kWeakShare);
    return report_;
  }

  const FeatureSet& source_;
  const RegistrationRun& run_;
  PoseFactors factors_;
  SweepModel model_;
  RegistrationProblem problem_;
  SweepTrajectory trajectory_;  ///< the present estimate, relative to the problem's origin
  double search_radius_;
  std::size_t stride_;  ///< far from the solution, every so many-th feature will do
  std::vector<double> edge_weights_;
  std::vector<double> plane_weights_;
  Correspondences correspondences_;
  NormalEquations equations_;
  RegistrationReport report_;
};

}  // namespace

RegistrationReport registerFeatures(const FeatureSet& source, const FeatureTarget& target, const RegistrationRun& run,
                                    const RegistrationParameters& parameters)
{
  RegistrationReport report;
  report.target_T_source = run.guess;
  if (!run.guess.isFinite()) {
    report.termination = Termination::invalid_input;
    report.target_T_source = SE3();
    return report;
  }
  if (static_cast<int>(source.edges.size() + source.planes.size()) < kFewestCorrespondences) {
    report.termination = Termination::too_few_features;
    return report;
  }
  if (target.edges->empty() && target.planes->empty()) {
    report.termination = Termination::empty_target;
    return report;
  }
  const FeatureSet sample{evenly(source.edges, kMostPlanes / kPlanesPerEdge), evenly(source.planes, kMostPlanes)};
  return FeaturePoseEstimation(sample, target, run, parameters).run();
}

}  // namespace pcl_floam
