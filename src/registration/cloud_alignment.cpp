#include "registration/cloud_alignment.h"

namespace pcl_floam {

CloudAlignment::CloudAlignment(const CloudPyramid& source, const CloudPyramid& target, const CloudRegistrationRun& run)
    : run_(run),
      factors_{run.factors, SE3()},
      extent_(source.extent()),
      source_T_origin_(Eigen::Matrix3d::Identity(), source.origin()),
      target_T_origin_(Eigen::Matrix3d::Identity(), target.origin()),
      pose_(target_T_origin_.inverse() * run.guess * source_T_origin_)
{
}

Termination CloudAlignment::align(CloudMatching& alignment, int most, double epsilon, bool watched)
{
  for (iterations_ = 0; iterations_ < most;) {
    sums_ = evaluate(alignment);
    ++iterations_;
    if (sums_.count() < run_.min_correspondences) {
      return Termination::too_few_correspondences;
    }
    const Vector6 step = analysis().step();
    if (!step.allFinite()) {
      return Termination::degenerate;
    }
    const bool over = take(step, alignment, watched);
    if (over || step.head<3>().norm() + extent_ * step.tail<3>().norm() < epsilon) {
      return Termination::converged;
    }
  }
  return Termination::iteration_limit;
}

NormalEquations CloudAlignment::evaluate(CloudMatching& level) const
{
  const SE3 target_T_source = toFrames(pose_);
  NormalEquations sums = level.evaluate(pose_, target_T_source);
  const PoseEquations known = factors_.at(target_T_source, arm());
  sums.information += sums.residualVariance() * known.information;  // as so many matches of weight 1
  sums.gradient += sums.residualVariance() * known.gradient;
  return sums;
}

void CloudAlignment::move(const Vector6& perturbation)
{
  pose_.rotation = nearestRotation(expSO3(perturbation.tail<3>()) * pose_.rotation);
  pose_.translation += perturbation.head<3>();
  // A turn about the centroid, which is straight to first order, has added something to what is locked.
  const SE3 pose = toFrames(pose_);
  for (int i = 0; i < 3; ++i) {
    if (run_.locked[static_cast<std::size_t>(i)]) {
      pose_.translation[i] += run_.guess.translation[i] - pose.translation[i];
    }
  }
}

/// Applies a step. \return true if the user says that it is enough
bool CloudAlignment::take(const Vector6& step, const CloudMatching& alignment, bool watched)
{
  const SE3 before = toFrames(pose_);
  move(step);
  if (!run_.iterated || !watched) {
    return false;
  }
  CloudIteration iteration;
  iteration.target_T_source = toFrames(pose_);
  iteration.step = iteration.target_T_source * before.inverse();
  iteration.matches = &alignment.matches();
  return run_.iterated(iteration);
}

}  // namespace pcl_floam
