// EdgePlaneRegistration: settings and input.
#pragma once

#include <pcl_floam/map/core/finite_search.h>

#include <algorithm>
#include <typeinfo>

namespace pcl_floam {

template <typename PointSource, typename PointTarget, typename Scalar>
EdgePlaneRegistration<PointSource, PointTarget, Scalar>::EdgePlaneRegistration()
{
  this->reg_name_ = "EdgePlaneRegistration";
  this->max_iterations_ = RegistrationRun().max_iterations;
  this->setSearchMethodTarget(pcl::make_shared<FiniteSearch<PointTarget>>());
  this->convergence_criteria_ = pcl::make_shared<detail::FreshCriteria<Scalar>>(
      this->nr_iterations_, this->transformation_, *this->correspondences_);
  own_estimation_ = this->transformation_estimation_;
  own_correspondences_ = this->correspondence_estimation_;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setInputSource(const PointCloudSourceConstPtr& cloud)
{
  if (!cloud || cloud->empty()) {
    PCL_ERROR("[pcl::%s::setInputSource] Invalid or empty point cloud dataset given!\n", this->getClassName().c_str());
    return;
  }
  forgetResult();
  Base::setInputSource(cloud);
  checkIndices();
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setInputTarget(const PointCloudTargetConstPtr& cloud)
{
  if (!cloud || cloud->empty()) {
    PCL_ERROR("[pcl::%s::setInputTarget] Invalid or empty point cloud dataset given!\n", this->getClassName().c_str());
    return;
  }
  Base::setInputTarget(cloud);
  takeTarget(cloud);
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::takeTarget(const PointCloudTargetConstPtr& cloud)
{
  forgetResult();
  this->target_ = cloud;
  this->target_cloud_updated_ = true;
  const auto& tree = *this->tree_;
  if (typeid(tree) == typeid(FiniteSearch<PointTarget>) && !this->force_no_recompute_) {
    static_cast<FiniteSearch<PointTarget>&>(*this->tree_).setInputCloudLater(cloud);
    this->target_cloud_updated_ = false;  // mostly nobody asks, and then align() need not make the tree
  }
  map_cloud_.reset();
  prepared_target_.reset();  // also under the same pointer the cloud may have changed
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setInputTargetMap(const KeyframeVoxelMap::ConstPtr& map)
{
  forgetResult();
  target_map_ = map;
  if (this->target_ && this->target_ != map_cloud_) {
    return;  // the user's
  }
  this->target_.reset();
  if (map) {
    auto cloud = pcl::make_shared<PointCloudTarget>();
    for (const Eigen::Vector3d& position : map->points(FeatureKind::plane)) {
      PointTarget point;
      point.getVector3fMap() = position.template cast<float>();
      cloud->push_back(point);
    }
    takeTarget(cloud);
    map_cloud_ = cloud;
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::setIndices(std::size_t row_start,
                                                                         std::size_t column_start, std::size_t rows,
                                                                         std::size_t columns)
{
  if (this->input_) {
    given_indices_.reset();
    Base::setIndices(row_start, column_start, rows, columns);
    checkIndices();
  }
}

/// The base copies the points that the indices name before anything of ours runs: what does not exist is taken out
/// here, and align() then fails.
template <typename PointSource, typename PointTarget, typename Scalar>
void EdgePlaneRegistration<PointSource, PointTarget, Scalar>::checkIndices()
{
  if (given_indices_) {
    this->indices_ = given_indices_;
    given_indices_.reset();
  }
  if (!this->input_ || !this->indices_ || this->fake_indices_) {
    return;
  }
  const auto size = static_cast<std::ptrdiff_t>(this->input_->size());
  const auto outside = [size](auto index) {
    return static_cast<std::ptrdiff_t>(index) < 0 || static_cast<std::ptrdiff_t>(index) >= size;
  };
  if (std::any_of(this->indices_->begin(), this->indices_->end(), outside)) {
    given_indices_ = this->indices_;
    this->indices_ = pcl::make_shared<pcl::Indices>();
    std::remove_copy_if(given_indices_->begin(), given_indices_->end(), std::back_inserter(*this->indices_), outside);
  }
}

}  // namespace pcl_floam
