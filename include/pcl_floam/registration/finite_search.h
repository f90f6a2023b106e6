/// \file finite_search.h
/// PCL's KD-tree, safe to ask for points that are not finite.
#pragma once

#include <pcl/common/point_tests.h>
#include <pcl/search/kdtree.h>

#include <limits>
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

  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices, std::vector<float>& distances) const override
  {
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
    return Base::radiusSearch(point, radius, indices, distances, max_nn);
  }
};

}  // namespace pcl_floam
