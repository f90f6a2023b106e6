// EdgePlaneRegistration: one registration from input to result.
#pragma once

#include <pcl_floam/registration/core/cloud_features.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {

namespace detail {

/// What an affine map does before its rigid motion; the identity if that is all up to rounding.
[[nodiscard]] inline Eigen::Matrix4d stretchOf(const Eigen::Matrix4d& map, const SE3& motion)
{
  constexpr double kRounding = 1e-3;
  const Eigen::Matrix4d stretch = motion.inverse().matrix() * map;
  return (stretch - Eigen::Matrix4d::Identity()).norm() < kRounding ? Eigen::Matrix4d(Eigen::Matrix4d::Identity())
                                                                    : stretch;
}

}  // namespace detail

template <typename PointSource, typename PointTarget, typename Scalar>
std::vector<std::uint8_t> EdgePlaneRegistration<PointSource, PointTarget, Scalar>::selectableSource() const
{
  if (this->fake_indices_ || !this->indices_) {
    return {};
  }
  return maskOf(*this->indices_, this->input_->size());
}

/// Of a scan with scan lines, in its cloud's frame.
template <typename PointSource, typename PointTarget, typename Scalar>
FeatureSet EdgePlaneRegistration<PointSource, PointTarget, Scalar>::featuresOf(
    const CloudView& cloud, const std::vector<std::uint8_t>& selectable)
{
  FeatureSet features = scanLineFeatures(sensor_pose_.ofSensor(cloud), sensor_, feature_parameters_, selectable);
  if (!sensor_pose_.isIdentity()) {
    moveFeatures(features, sensor_pose_.get());
  }
  return features;
}

template <typename PointSource, typename PointTarget, typename Scalar>
const KeyframeVoxelMap* EdgePlaneRegistration<PointSource, PointTarget, Scalar>::targetFeatures()
{
  if (target_map_) {
    return target_map_.get();
  }
  if (!prepared_target_) {
    prepared_target_ = std::make_shared<Target>();
    const FeatureSet features = featuresOf(viewOf(*this->target_), {});
    if (static_cast<int>(features.planes.size() + features.edges.size()) >= kFewestCorrespondences) {
      prepared_target_->features = std::make_unique<KeyframeVoxelMap>();
      prepared_target_->features->insert(features, SE3());
    }
  }
  return prepared_target_->features.get();
}

template <typename PointSource, typename PointTarget, typename Scalar>
const PreparedCloud& EdgePlaneRegistration<PointSource, PointTarget, Scalar>::targetPoints()
{
  if (!prepared_target_) {
    prepared_target_ = std::make_shared<Target>();
  }
  if (!prepared_target_->points) {
    prepared_target_->points =
        std::make_unique<PreparedCloud>(viewOf(*this->target_), std::vector<std::uint8_t>(), threads_);
  }
  return *prepared_target_->points;
}

/// Where to start on the features, which must be near theirs already.
template <typename PointSource, typename PointTarget, typename Scalar>
SE3 EdgePlaneRegistration<PointSource, PointTarget, Scalar>::roughPose(const SE3& guess)
{
  constexpr int kFewIterations = 4;
  if (target_map_ || source_features_ || this->max_iterations_ < kFewIterations) {
    return guess;
  }
  if (!prepared_target_->thinned) {
    prepared_target_->thinned = std::make_unique<PreparedCloud>(
        PreparedCloud::thinned(viewOf(*this->target_), std::vector<std::uint8_t>(), threads_));
  }
  CloudRegistrationRun run;
  run.guess = guess;
  run.threads = threads_;
  run.max_distance = this->corr_dist_threshold_;
  run.locked = parameters_.locked;
  return alignRoughly(PreparedCloud::thinned(viewOf(*registered_), selectableSource(), threads_),
                      *prepared_target_->thinned, run);
}

template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationReport EdgePlaneRegistration<PointSource, PointTarget, Scalar>::registerByFeatures(const SE3& guess,
                                                                                               FeatureSet& source)
{
  const KeyframeVoxelMap& map = *targetFeatures();
  RegistrationRun run;
  run.guess = roughPose(guess);
  run.max_correspondence_distance = std::min(run.max_correspondence_distance, this->corr_dist_threshold_);
  run.max_iterations = iterationLimit();
  run.threads = threads_;
  run.factors = factors_;
  if (this->transformation_epsilon_ > 0.0) {
    run.translation_epsilon = std::min(run.translation_epsilon, std::sqrt(this->transformation_epsilon_));
  }
  if (this->transformation_rotation_epsilon_ > 0.0) {
    run.rotation_epsilon =
        std::min(run.rotation_epsilon, std::acos(std::min(1.0, this->transformation_rotation_epsilon_)));
  }
  SE3 last = run.guess;
  run.on_iteration = [this, &last](const SE3& target_T_source) {
    last = target_T_source;
    showIteration(target_T_source, nullptr);
  };
  const RegistrationReport report =
      registerFeatures(source, {&map.search(FeatureKind::edge), &map.search(FeatureKind::plane)}, run, parameters_);
  this->nr_iterations_ = report.iterations;
  this->transformation_ = (report.target_T_source * last.inverse()).template matrix<Scalar>();
  return report;
}

template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationReport EdgePlaneRegistration<PointSource, PointTarget, Scalar>::registerByPoints(const SE3& guess,
                                                                                             int max_iterations,
                                                                                             bool coarse_first)
{
  const PreparedCloud& target = targetPoints();
  const PreparedCloud source(viewOf(*registered_), selectableSource(), threads_);
  CloudRegistrationRun run;
  run.guess = guess;
  run.threads = threads_;
  run.max_iterations = max_iterations;
  run.coarse_first = coarse_first;
  run.max_distance = this->corr_dist_threshold_;
  run.epsilon = std::sqrt(std::max(0.0, this->transformation_epsilon_));
  run.min_correspondences = static_cast<int>(this->min_number_correspondences_);
  run.reciprocal = this->use_reciprocal_correspondence_;
  run.kernel = parameters_.kernel;
  run.factors = factors_;
  run.locked = parameters_.locked;
  run.wants_matches = this->update_visualizer_ != nullptr || hasCriteriaOfItsOwn();
  if (!this->correspondence_rejectors_.empty()) {
    run.reject = [this](const SE3& pose, std::vector<PointMatch>& matches) { reject(pose, matches); };
  }
  if (hasSearchOfItsOwn()) {
    run.search = [this](const std::vector<int>& points, const SE3& pose) { return searchTarget(points, pose); };
  }
  run.iterated = [this](const CloudIteration& iteration) { return iterated(iteration); };
  return registerClouds(source, target, run);
}

/// A few iterations with all points of two scans, after those with their features: thousands of features find the pose,
/// all points tell it more exactly.
template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationReport EdgePlaneRegistration<PointSource, PointTarget, Scalar>::finishByPoints(
    const RegistrationReport& by_features)
{
  constexpr int kAFew = 6;
  const int left = std::min(kAFew, iterationLimit() - by_features.iterations);
  if (left < 1) {
    return by_features;
  }
  RegistrationReport report = registerByPoints(by_features.target_T_source, left, false);
  if (!report.hasConverged()) {
    return by_features;
  }
  report.iterations += by_features.iterations;
  report.termination = by_features.termination;
  return report;
}

template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationReport EdgePlaneRegistration<PointSource, PointTarget, Scalar>::registerSource(const SE3& guess)
{
  if (given_indices_ || !guess.isFinite()) {
    RegistrationReport report;
    report.termination = Termination::invalid_input;
    return report;
  }
  if (target_map_ || (!wantsPoints() && targetFeatures() != nullptr)) {
    FeatureSet source = source_features_ ? *source_features_ : featuresOf(viewOf(*registered_), selectableSource());
    if (target_map_ && source.planes.empty() && source.edges.empty()) {
      source = pointFeatures(viewOf(*registered_), selectableSource());
    }
    if (!source.planes.empty() || !source.edges.empty()) {
      const RegistrationReport report = registerByFeatures(guess, source);
      if (target_map_ || source_features_) {
        return report;
      }
      if (report.hasConverged()) {
        return finishByPoints(report);
      }
    }
  }
  return registerByPoints(guess, iterationLimit(), true);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::runBaseLoop(PointCloudSource& output,
                                                                          const Matrix4& guess)
{
  constexpr double kUnknown = 1e6;  // m^2 and rad^2: the user's estimation tells no more than a pose
  Base::computeTransformation(output, guess);
  report_ = RegistrationReport();
  report_.covariance = kUnknown * Matrix6::Identity();
  for (int i = 0; i < 6; ++i) {
    report_.weak_directions.push_back({Vector6::Unit(i), 0.0});
  }
  report_.iterations = this->nr_iterations_;
  report_.target_T_source = SE3(Eigen::Transform<Scalar, 3, Eigen::Affine>(this->final_transformation_));
  const bool at_limit = this->convergence_criteria_->getConvergenceState() == Criteria::CONVERGENCE_CRITERIA_ITERATIONS;
  report_.termination = !this->converged_ ? Termination::too_few_correspondences
                        : at_limit        ? Termination::iteration_limit
                                          : Termination::converged;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::takeSource(const Matrix4& stretch)
{
  registered_ = this->input_;
  if (stretch != Matrix4::Identity()) {
    auto stretched = pcl::make_shared<PointCloudSource>(*this->input_);
    this->transformCloud(*this->input_, *stretched, stretch);
    registered_ = stretched;
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::computeTransformation(PointCloudSource& output,
                                                                                    const Matrix4& guess)
{
  const bool replaced =
      this->transformation_estimation_ != own_estimation_ || this->correspondence_estimation_ != own_correspondences_;
  if (!given_indices_ && guess.allFinite() && replaced) {
    runBaseLoop(output, guess);
    return;
  }
  this->nr_iterations_ = 0;
  this->transformation_ = this->previous_transformation_ = Matrix4::Identity();
  setUpCriteria();
  SE3 start{Eigen::Transform<Scalar, 3, Eigen::Affine>(guess)};
  Matrix4 stretch = Matrix4::Identity();
  if (start.isFinite()) {
    start.rotation = nearestRotation(start.rotation);
    stretch = detail::stretchOf(guess.template cast<double>(), start).template cast<Scalar>();
  }
  takeSource(stretch);
  report_ = registerSource(start);
  if (!report_.hasConverged()) {
    report_.target_T_source = start.isFinite() ? start : SE3();
  }
  concludeCriteria();
  this->final_transformation_ = Matrix4::Identity();
  if (this->converged_) {
    this->final_transformation_ = report_.target_T_source.template matrix<Scalar>() * stretch;
  } else if (guess.allFinite()) {
    this->final_transformation_ = guess;
  }
  target_blob_.reset();
  registered_.reset();
  output = *this->input_;  // with indices set, the base has made it smaller
  this->transformCloud(*this->input_, output, this->final_transformation_);
}

}  // namespace pcl_floam
