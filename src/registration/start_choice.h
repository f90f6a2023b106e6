/// \file start_choice.h
/// Judges from a few points where a registration should start.
#pragma once

#include "registration/cloud_pyramid.h"

#include <pcl_floam/common/se3.h>

#include <Eigen/Core>

#include <vector>

namespace pcl_floam {

/// Compares poses by how near a sample of the source's points comes to the target.
class StartChoice {
public:
  StartChoice(const CloudLevel& source, const CloudLevel& target, double max_distance, int threads);

  /// Whether the typical point is about as near to the target as the target's points are to each other.
  [[nodiscard]] bool isClose(const SE3& pose) const;

  /// The pose that brings more points closer.
  [[nodiscard]] const SE3& better(const SE3& a, const SE3& b) const;

  /// 0 if all points lie on the target's, 1 if all are far off.
  [[nodiscard]] double cost(const SE3& pose) const;

private:
  [[nodiscard]] std::vector<float> distances(const SE3& pose) const;

  const PointTree& target_;
  std::vector<Eigen::Vector3f> sample_;
  double spacing_;
  double max_distance_;
  int threads_;
};

}  // namespace pcl_floam
