// EdgePlaneRegistration: what ICP's settings ask for in each iteration, and its convergence criteria.
#pragma once

#include <pcl_floam/map/core/finite_search.h>

#include <pcl/conversions.h>
#include <pcl/point_representation.h>
#include <pcl/search/kdtree.h>

#include <cmath>
#include <limits>
#include <typeinfo>

namespace pcl_floam {

/// Whether a setting speaks of single points, so that features do not do.
template <typename PointSource, typename PointTarget, typename Scalar>
bool EdgePlaneRegistration<PointSource, PointTarget, Scalar>::wantsPoints() const
{
  const bool fitness_counts = this->euclidean_fitness_epsilon_ > -std::numeric_limits<double>::max();
  return !source_features_ && (!this->correspondence_rejectors_.empty() || this->use_reciprocal_correspondence_ ||
                               fitness_counts || hasSearchOfItsOwn());
}

template <typename PointSource, typename PointTarget, typename Scalar>
bool EdgePlaneRegistration<PointSource, PointTarget, Scalar>::hasSearchOfItsOwn() const
{
  if (!this->tree_ || this->force_no_recompute_) {
    return this->tree_ != nullptr;
  }
  const auto& tree = *this->tree_;
  if (typeid(tree) != typeid(FiniteSearch<PointTarget>) && typeid(tree) != typeid(pcl::search::KdTree<PointTarget>)) {
    return true;
  }
  const auto representation = this->tree_->getPointRepresentation();
  if (!representation) {
    return false;
  }
  const auto& measure = *representation;
  return typeid(measure) != typeid(pcl::DefaultPointRepresentation<PointTarget>);
}

/// Whether the user has set a criterion of ICP's; what ends a registration otherwise is relative to the spacing.
template <typename PointSource, typename PointTarget, typename Scalar>
bool EdgePlaneRegistration<PointSource, PointTarget, Scalar>::hasCriteriaOfItsOwn() const
{
  constexpr double kPclsAbsolute = 1e-12;
  const auto& criteria = *this->convergence_criteria_;
  return this->transformation_epsilon_ > 0.0 || this->transformation_rotation_epsilon_ > 0.0 ||
         this->euclidean_fitness_epsilon_ > -std::numeric_limits<double>::max() ||
         std::abs(criteria.getAbsoluteMSE() - kPclsAbsolute) > 1e-3 * kPclsAbsolute;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setUpCriteria()
{
  auto& criteria = *this->convergence_criteria_;
  if (auto* fresh = dynamic_cast<detail::FreshCriteria<Scalar>*>(&criteria)) {  // else the user's
    fresh->start();
  }
  criteria.setMaximumIterations(std::numeric_limits<int>::max());  // counted elsewhere
  criteria.setRelativeMSE(this->euclidean_fitness_epsilon_);
  criteria.setTranslationThreshold(this->transformation_epsilon_);
  criteria.setRotationThreshold(this->transformation_rotation_epsilon_ > 0.0 ? this->transformation_rotation_epsilon_
                                                                             : 1.0 - this->transformation_epsilon_);
  criteria.setConvergenceState(Criteria::CONVERGENCE_CRITERIA_NOT_CONVERGED);
  this->correspondences_->clear();
  this->determineRequiredBlobData();
  if (this->need_target_blob_) {
    target_blob_ = pcl::make_shared<pcl::PCLPointCloud2>();
    pcl::toPCLPointCloud2(*this->target_, *target_blob_);
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::concludeCriteria()
{
  auto& criteria = *this->convergence_criteria_;
  criteria.setMaximumIterations(this->max_iterations_);
  this->converged_ = report_.hasConverged();
  if (!this->converged_) {
    PCL_ERROR("[pcl::%s::computeTransformation] No pose found: %s.\n", this->getClassName().c_str(),
              toString(report_.termination));
  }
  switch (report_.termination) {
    case Termination::converged:
      if (criteria.getConvergenceState() == Criteria::CONVERGENCE_CRITERIA_NOT_CONVERGED) {
        criteria.setConvergenceState(Criteria::CONVERGENCE_CRITERIA_TRANSFORM);
      }
      break;
    case Termination::iteration_limit:
      this->converged_ = !criteria.getFailureAfterMaximumIterations();
      criteria.setConvergenceState(this->converged_ ? Criteria::CONVERGENCE_CRITERIA_ITERATIONS
                                                    : Criteria::CONVERGENCE_CRITERIA_FAILURE_AFTER_MAX_ITERATIONS);
      break;
    case Termination::too_few_features:
    case Termination::empty_target:
    case Termination::too_few_correspondences:
      criteria.setConvergenceState(Criteria::CONVERGENCE_CRITERIA_NO_CORRESPONDENCES);
      break;
    default: criteria.setConvergenceState(Criteria::CONVERGENCE_CRITERIA_NOT_CONVERGED);
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
typename EdgePlaneRegistration<PointSource, PointTarget, Scalar>::PointCloudSource
EdgePlaneRegistration<PointSource, PointTarget, Scalar>::movedSource(const SE3& target_T_source)
{
  PointCloudSource moved = *registered_;
  this->transformCloud(*registered_, moved, target_T_source.template matrix<Scalar>());
  return moved;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::reject(const SE3& target_T_source,
                                                                     std::vector<PointMatch>& matches)
{
  pcl::PCLPointCloud2::Ptr source_blob;
  if (this->need_source_blob_) {
    source_blob = pcl::make_shared<pcl::PCLPointCloud2>();
    pcl::toPCLPointCloud2(movedSource(target_T_source), *source_blob);
  }
  auto remaining = pcl::make_shared<pcl::Correspondences>();
  for (const PointMatch& match : matches) {
    remaining->emplace_back(match.source, match.target, match.squared_distance);
  }
  for (const auto& rejector : this->correspondence_rejectors_) {
    if (rejector->requiresTargetPoints()) {
      rejector->setTargetPoints(target_blob_);
    }
    if (rejector->requiresTargetNormals() && this->target_has_normals_) {
      rejector->setTargetNormals(target_blob_);
    }
    if (rejector->requiresSourcePoints()) {
      rejector->setSourcePoints(source_blob);
    }
    if (rejector->requiresSourceNormals() && this->source_has_normals_) {
      rejector->setSourceNormals(source_blob);
    }
    rejector->setInputCorrespondences(remaining);
    pcl::Correspondences kept;
    rejector->getCorrespondences(kept);
    remaining = pcl::make_shared<pcl::Correspondences>(kept);
  }
  matches.clear();
  for (const pcl::Correspondence& match : *remaining) {
    matches.push_back({static_cast<int>(match.index_query), static_cast<int>(match.index_match), match.distance});
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::showIteration(const SE3& target_T_source,
                                                                            const std::vector<PointMatch>* matches)
{
  if (!this->update_visualizer_) {
    return;
  }
  pcl::Indices source;
  pcl::Indices target;
  for (std::size_t i = 0; matches != nullptr && i < matches->size(); ++i) {
    source.push_back((*matches)[i].source);
    target.push_back((*matches)[i].target);
  }
  this->update_visualizer_(movedSource(target_T_source), source, *this->target_, target);
}

template <typename PointSource, typename PointTarget, typename Scalar>
bool EdgePlaneRegistration<PointSource, PointTarget, Scalar>::iterated(const CloudIteration& iteration)
{
  ++this->nr_iterations_;
  this->previous_transformation_ = this->transformation_;
  this->transformation_ = iteration.step.template matrix<Scalar>();
  showIteration(iteration.target_T_source, iteration.matches);
  if (!hasCriteriaOfItsOwn()) {
    return false;
  }
  this->correspondences_->clear();
  for (const PointMatch& match : *iteration.matches) {
    this->correspondences_->emplace_back(match.source, match.target, match.squared_distance);
  }
  return this->convergence_criteria_->hasConverged();
}

/// Null if the search has no tree of its base's, as PCL 1.15.1's KdTreeNanoflann: the base does not look before it
/// asks.
template <typename PointT>
[[nodiscard]] typename pcl::PointRepresentation<PointT>::ConstPtr representationOf(
    const pcl::search::KdTree<PointT>& search)
{
  struct Opened : pcl::search::KdTree<PointT> {
    static bool hasTree(const pcl::search::KdTree<PointT>& tree) { return tree.*(&Opened::tree_) != nullptr; }
  };
  return Opened::hasTree(search) ? search.getPointRepresentation() : nullptr;
}

/// Asks the user's search for whole points: it may look at more of them than their place.
template <typename PointSource, typename PointTarget, typename Scalar>
std::vector<int> EdgePlaneRegistration<PointSource, PointTarget, Scalar>::searchTarget(const std::vector<int>& source,
                                                                                       const SE3& target_T_source)
{
  const PointCloudSource moved = movedSource(target_T_source);
  const auto representation = representationOf(*this->tree_);
  std::vector<int> nearest(source.size(), -1);
  pcl::Indices found(1);
  std::vector<float> squared_distance(1);
  for (std::size_t i = 0; i < source.size(); ++i) {
    PointTarget query;
    pcl::copyPoint(moved[static_cast<std::size_t>(source[i])], query);
    const bool valid = pcl::isXYZFinite(query) && (!representation || representation->isValid(query));
    if (valid && this->tree_->nearestKSearch(query, 1, found, squared_distance) > 0) {
      nearest[i] = static_cast<int>(found[0]);
    }
  }
  return nearest;
}

}  // namespace pcl_floam
