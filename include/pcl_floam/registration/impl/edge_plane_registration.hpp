#pragma once

#include <pcl_floam/registration/cloud_features.h>
#include <pcl_floam/registration/finite_search.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace pcl_floam {

template <typename PointSource, typename PointTarget, typename Scalar>
EdgePlaneRegistration<PointSource, PointTarget, Scalar>::EdgePlaneRegistration()
{
  this->reg_name_ = "EdgePlaneRegistration";
  this->max_iterations_ = parameters_.max_iterations;
  this->setSearchMethodTarget(pcl::make_shared<FiniteSearch<PointTarget>>());
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setParameters(const RegistrationParameters& parameters)
{
  validate(parameters);
  parameters_ = parameters;
  this->max_iterations_ = parameters.max_iterations;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setFeatureParameters(const FeatureParameters& parameters)
{
  validate(parameters);
  feature_parameters_ = parameters;
  prepared_target_.reset();
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setSensor(const SensorModel& sensor)
{
  sensor_ = sensor;
  prepared_target_.reset();
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setInputTarget(const PointCloudTargetConstPtr& cloud)
{
  Base::setInputTarget(cloud);
  prepared_target_.reset();  // also under the same pointer the cloud may have changed
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setInputTargetMap(const KeyframeVoxelMap::ConstPtr& map)
{
  target_map_ = map;
  if (map && !this->target_) {
    auto cloud = pcl::make_shared<PointCloudTarget>();
    for (const Eigen::Vector3d& position : map->points(FeatureKind::plane)) {
      PointTarget point;
      point.getVector3fMap() = position.template cast<float>();
      cloud->push_back(point);
    }
    setInputTarget(cloud);
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setNumberOfThreads(unsigned int threads)
{
  threads_ = static_cast<int>(threads == 0 ? std::max(1U, std::thread::hardware_concurrency()) : threads);
}

template <typename PointSource, typename PointTarget, typename Scalar>
FeatureSet EdgePlaneRegistration<PointSource, PointTarget, Scalar>::sourceFeatures(bool from_scan_lines) const
{
  if (source_features_) {
    return *source_features_;
  }
  const CloudView cloud = viewOf(*this->input_);
  std::vector<std::uint8_t> selectable;
  if (!this->fake_indices_ && this->indices_) {
    selectable = maskOf(*this->indices_, cloud.size);
  }
  return from_scan_lines ? scanLineFeatures(cloud, sensor_, feature_parameters_, selectable)
                         : pointFeatures(cloud, selectable);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::prepareTarget()
{
  if (prepared_target_ || target_map_) {
    return;
  }
  prepared_target_ = std::make_shared<Target>();
  const CloudView cloud = viewOf(*this->target_);
  const FeatureSet features = scanLineFeatures(cloud, sensor_, feature_parameters_);
  if (static_cast<int>(features.planes.size() + features.edges.size()) >= parameters_.min_correspondences) {
    prepared_target_->features = std::make_unique<KeyframeVoxelMap>();
    prepared_target_->features->insert(features, SE3());
    return;
  }
  const std::vector<Eigen::Vector3d> points = measurablePoints(cloud);
  prepared_target_->points = makeKdTreeSearch(points);
  prepared_target_->spacing = pointSpacing(points, *prepared_target_->points);
}

template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationParameters EdgePlaneRegistration<PointSource, PointTarget, Scalar>::effectiveParameters(
    bool from_scan_lines) const
{
  RegistrationParameters parameters = parameters_;
  if (!from_scan_lines) {
    // No absolute metres where nothing is known of the scene: lengths follow the target's point spacing.
    const double spacing = std::max(prepared_target_->spacing, std::numeric_limits<double>::min());
    parameters.kernel_scale = 0.1 * spacing;
    parameters.translation_epsilon = 1e-3 * spacing;
    parameters.rotation_epsilon = 1e-5;
    parameters.plane_neighbors = std::max(10, parameters.plane_neighbors);
    parameters.max_neighbor_distance = std::sqrt(std::numeric_limits<float>::max()) / 2.0;
    parameters.min_correspondences = 6;
  }
  parameters.max_iterations = std::max(1, this->max_iterations_);
  parameters.max_neighbor_distance = std::min(parameters.max_neighbor_distance, this->corr_dist_threshold_);
  if (this->transformation_epsilon_ > 0.0) {
    parameters.translation_epsilon = std::sqrt(this->transformation_epsilon_);
  }
  if (this->transformation_rotation_epsilon_ > 0.0) {
    parameters.rotation_epsilon = std::acos(std::min(1.0, this->transformation_rotation_epsilon_));
  }
  return parameters;
}

template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationReport EdgePlaneRegistration<PointSource, PointTarget, Scalar>::registerSource(const SE3& guess)
{
  prepareTarget();
  const KeyframeVoxelMap* features = target_map_ ? target_map_.get() : prepared_target_->features.get();
  bool from_scan_lines = features != nullptr;
  FeatureSet source = sourceFeatures(from_scan_lines);
  if (from_scan_lines && !target_map_ && !source_features_ && source.planes.empty() && source.edges.empty()) {
    // A scan was set as target, but the source is none: both are taken as mere points.
    const std::vector<Eigen::Vector3d> points = measurablePoints(viewOf(*this->target_));
    prepared_target_->points = makeKdTreeSearch(points);
    prepared_target_->spacing = pointSpacing(points, *prepared_target_->points);
    from_scan_lines = false;
    source = sourceFeatures(false);
  }
  FeatureTarget target{prepared_target_ ? prepared_target_->points.get() : nullptr,
                       prepared_target_ ? prepared_target_->points.get() : nullptr};
  if (from_scan_lines) {
    target = {&features->search(FeatureKind::edge), &features->search(FeatureKind::plane)};
  }
  RegistrationRun run;
  run.guess = guess;
  run.threads = threads_;
  return registerFeatures(source, target, run, effectiveParameters(from_scan_lines));
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::computeTransformation(PointCloudSource& output,
                                                                                    const Matrix4& guess)
{
  report_ = registerSource(SE3(Eigen::Transform<Scalar, 3, Eigen::Affine>(guess)));
  this->converged_ = report_.hasConverged();
  this->nr_iterations_ = report_.iterations;
  this->previous_transformation_ = guess;
  this->final_transformation_ = this->converged_ ? Matrix4(report_.target_T_source.template matrix<Scalar>()) : guess;
  this->transformation_ = this->final_transformation_ * guess.inverse();
  output = *this->input_;  // with indices set, the base has made it smaller
  this->transformCloud(*this->input_, output, this->final_transformation_);
}

}  // namespace pcl_floam
