/// \file pose_factors.h
/// Factors of the user's as a registration takes them.
#pragma once

#include <pcl_floam/registration/core/pose_factor.h>

#include <vector>

namespace pcl_floam {

/// Factors that speak of a world in which the registration's target lies anywhere.
struct PoseFactors {
  std::vector<PoseFactor::ConstPtr> factors;
  SE3 world_T_target;

  /// In the target's axes.
  /// \param arm from the source's origin to the point about which the perturbation turns, in the target's axes
  [[nodiscard]] PoseEquations at(const SE3& target_T_source,
                                 const Eigen::Vector3d& arm = Eigen::Vector3d::Zero()) const;
};

}  // namespace pcl_floam
