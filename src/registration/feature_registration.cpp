#include <pcl_floam/registration/feature_registration.h>

#include "registration/ceres_solver.h"
#include "registration/correspondences.h"
#include "registration/information_analysis.h"
#include "registration/normal_equations.h"
#include "registration/weights.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// One registration in progress.
class PoseEstimation {
public:
  PoseEstimation(FeatureSet& source, const FeatureTarget& target, const RegistrationRun& run,
                 const RegistrationParameters& parameters)
      : source_(source),
        run_(run),
        problem_{target, parameters, run.guess.translation, run.threads, run.response_slope, run.reference},
        local_T_sensor_(run.guess.rotation, Eigen::Vector3d::Zero()),
        search_radius_(std::max(parameters.max_neighbor_distance, run.guess_uncertainty)),
        edge_weights_(
            smoothnessWeights(source.edges, FeatureKind::edge, parameters.weights, parameters.weight_normalization)),
        plane_weights_(
            smoothnessWeights(source.planes, FeatureKind::plane, parameters.weights, parameters.weight_normalization))
  {
    report_.target_T_source = run.guess;
  }

  RegistrationReport run()
  {
    report_.termination = Termination::iteration_limit;
    for (int i = 0; i < problem_.parameters.max_iterations; ++i) {
      if (iterate()) {
        break;
      }
    }
    return finish();
  }

private:
  [[nodiscard]] SE3 pose() const { return {local_T_sensor_.rotation, local_T_sensor_.translation + problem_.origin}; }

  /// One iteration of the pose estimation: fresh correspondences, one step. \return true when it is over
  bool iterate()
  {
    if (run_.recompensate) {
      run_.recompensate(pose(), source_);
    }
    findCorrespondences(problem_, source_, edge_weights_, plane_weights_, local_T_sensor_, search_radius_,
                        correspondences_);
    const KernelScales scales = adaptKernelScales(problem_, local_T_sensor_, correspondences_);
    equations_ = buildNormalEquations(problem_, local_T_sensor_, correspondences_, scales);
    ++report_.iterations;
    if (equations_.edges + equations_.planes < problem_.parameters.min_correspondences) {
      report_.termination = Termination::too_few_correspondences;
      return true;
    }
    return take(solve(scales));
  }

  [[nodiscard]] Vector6 solve(const KernelScales& scales) const
  {
    if (problem_.parameters.solver == SolverKind::ceres) {
      return solveWithCeres(problem_, local_T_sensor_, correspondences_, scales);
    }
    return InformationAnalysis(equations_, problem_.parameters.weak_threshold).step();
  }

  /// Applies a step on the left (Eq. 11). \return true when the iterations are over
  bool take(const Vector6& step)
  {
    if (!step.allFinite()) {
      report_.termination = Termination::degenerate;
      return true;
    }
    local_T_sensor_ = exp(step) * local_T_sensor_;
    local_T_sensor_.rotation = nearestRotation(local_T_sensor_.rotation);
    const bool searched_wide = search_radius_ > problem_.parameters.max_neighbor_distance;
    if (searched_wide) {
      search_radius_ = std::max(problem_.parameters.max_neighbor_distance, 0.5 * search_radius_);
      correspondences_ = Correspondences();  // they were found within the wider radius
    }
    const bool small = step.head<3>().norm() < problem_.parameters.translation_epsilon &&
                       step.tail<3>().norm() < problem_.parameters.rotation_epsilon;
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
    if (!report_.hasConverged() || !(equations_.weight > 0.0)) {
      return report_;
    }
    const InformationAnalysis analysis(equations_, problem_.parameters.weak_threshold);
    report_.target_T_source = pose();
    report_.cost = equations_.cost;
    report_.residual_rms = std::sqrt(equations_.weighted_squares / equations_.weight);
    report_.information = equations_.information;
    report_.covariance = analysis.covariance();
    report_.weak_directions = analysis.weakDirections();
    return report_;
  }

  FeatureSet& source_;
  const RegistrationRun& run_;
  RegistrationProblem problem_;
  SE3 local_T_sensor_;  ///< the present estimate, relative to the problem's origin
  double search_radius_;
  std::vector<double> edge_weights_;
  std::vector<double> plane_weights_;
  Correspondences correspondences_;
  NormalEquations equations_;
  RegistrationReport report_;
};

}  // namespace

RegistrationReport registerFeatures(FeatureSet& source, const FeatureTarget& target, const RegistrationRun& run,
                                    const RegistrationParameters& parameters)
{
  RegistrationReport report;
  report.target_T_source = run.guess;
  if (!run.guess.isFinite()) {
    report.termination = Termination::invalid_input;
    report.target_T_source = SE3();
    return report;
  }
  if (static_cast<int>(source.edges.size() + source.planes.size()) < parameters.min_correspondences) {
    report.termination = Termination::too_few_features;
    return report;
  }
  if (target.edges->empty() && target.planes->empty()) {
    report.termination = Termination::empty_target;
    return report;
  }
  return PoseEstimation(source, target, run, parameters).run();
}

}  // namespace pcl_floam
