/// \file pose_factors.h
/// Factors of the user's as a registration takes them.
#pragma once

#include <pcl_floam/registration/pose_factor.h>

#include <vector>

namespace pcl_floam {

/// Factors that speak of a world in which the registration's target lies anywhere.
struct PoseFactors {
  std::vector<PoseFactor::ConstPtr> factors;
  SE3 world_T_target;

  /// In the target's axes.
  /// \param arm from the source's origin to the point about which the perturbation turns, in the target's axes
  [[nodiscard]] PoseEquations at(const SE3& target_T_source, const Eigen::Vector3d& arm = Eigen::Vector3d::Zero()) const
  {
    PoseEquations sum;
    if (factors.empty()) {
      return sum;
    }
    const SE3 world_T_source = world_T_target * target_T_source;
    for (const PoseFactor::ConstPtr& factor : factors) {
      factor->addTo(world_T_source, sum);
    }
    Matrix6 to_world = Matrix6::Zero();
    to_world.topLeftCorner<3, 3>() = to_world.bottomRightCorner<3, 3>() = world_T_target.rotation;
    to_world.topRightCorner<3, 3>() = world_T_target.rotation * skew(arm);
    return {to_world.transpose() * sum.information * to_world, to_world.transpose() * sum.gradient};
  }
};

}  // namespace pcl_floam
