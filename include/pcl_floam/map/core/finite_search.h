/// \file finite_search.h
/// PCL's KD-tree, safe to ask for points that are not finite.
#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/search/kdtree.h>

#include <limits>
#include <memory>
#include <mutex>
#include <vector>

namespace pcl_floam {

/// A KD-tree in which points that are not finite have no neighbours.
///
/// PCL's own ends the process in builds with assertions, also from within `getFitnessScore()`, which asks for every
/// point of the source and reads the first distance whatever was found: that is infinite here if nothing was.
template <typename PointT>
class FiniteSearch : public pcl::search::KdTree<PointT> {
  using Base = pcl::search::KdTree<PointT>;

public:
  using Base::nearestKSearch;
  using Base::radiusSearch;

  /// Takes a cloud, but makes the tree of it only if it is asked.
  void setInputCloudLater(const typename Base::PointCloudConstPtr& cloud)
  {
    const auto last = this->tree_;
    this->tree_.reset(new pcl::KdTreeFLANN<PointT>(this->sorted_results_));
    this->tree_->setEpsilon(last->getEpsilon());
    this->tree_->setPointRepresentation(last->getPointRepresentation());
    this->input_ = cloud;
    this->indices_.reset();
    made_ = std::make_shared<std::once_flag>();
  }

  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices, std::vector<float>& distances) const override
  {
    makeTree();
    const int found = pcl::isXYZFinite(point) ? Base::nearestKSearch(point, k, indices, distances) : 0;
    if (found == 0) {
      indices.clear();
      distances.assign(1, std::numeric_limits<float>::infinity());
    }
    return found;
  }

  int radiusSearch(const PointT& point, double radius, pcl::Indices& indices, std::vector<float>& distances,
                   unsigned int max_nn = 0) const override
  {
    if (!pcl::isXYZFinite(point)) {
      indices.clear();
      distances.clear();
      return 0;
    }
    makeTree();
    return Base::radiusSearch(point, radius, indices, distances, max_nn);
  }

private:
  /// Asking is const, and may be done from several threads.
  void makeTree() const
  {
    if (made_) {
      std::call_once(*made_, [this] {
        if (!this->tree_->getInputCloud()) {  // else another cloud has been set since
          this->tree_->setInputCloud(this->input_);
        }
      });
    }
  }

  std::shared_ptr<std::once_flag> made_;
};

}  // namespace pcl_floam
