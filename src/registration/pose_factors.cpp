#include "registration/pose_factors.h"

#include "common/covariance.h"
#include "common/perturbation.h"

namespace pcl_floam {

void PoseEquations::add(double residual, const Vector6& derivative, double variance)
{
  information += derivative * (derivative / variance).transpose();
  gradient += derivative * (residual / variance);
}

PoseEquations PoseFactors::at(const SE3& target_T_source, const Eigen::Vector3d& arm) const
{
  PoseEquations sum;
  if (factors.empty()) {
    return sum;
  }
  const SE3 world_T_source = world_T_target * target_T_source;
  for (const PoseFactor::ConstPtr& factor : factors) {
    factor->addTo(world_T_source, sum);
  }
  const Matrix6 from_world = product(turnOf(world_T_target.rotation), leverOf(arm)).transpose();
  return {propagated(from_world, sum.information), from_world * sum.gradient};
}

}  // namespace pcl_floam
