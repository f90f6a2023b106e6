#include "registration/factors.h"

#include "map/neighbor_moments.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

std::optional<Factor> fitLine(const Neighbors& neighbors)
{
  const PointMoments points = momentsOf(neighbors);
  const PrincipalAxes axes = points.axes();
  if (!(axes.variance[2] > kLineRatio * axes.variance[1]) || !(axes.variance[2] > 0.0)) {
    return std::nullopt;
  }
  return Factor{FeatureKind::edge, points.mean(), axes.direction.col(2)};
}

std::optional<Factor> fitPlane(const Neighbors& neighbors)
{
  const PointMoments points = momentsOf(neighbors);
  const PrincipalAxes axes = points.axes();
  const double across = std::max(0.0, axes.variance[0]);
  if (!(axes.variance[1] > kPlaneRatio * across) || !(axes.variance[1] > kPlaneSpread * axes.variance[2])) {
    return std::nullopt;
  }
  Factor plane{FeatureKind::plane, points.mean(), axes.direction.col(0), across};
  // Points that scatter by sigma across a plane, and along it with the covariance C, leave its normal off by
  // sigma^2 C^-1 / k. The scatter about a plane fitted to the same k points is less than that about the true one by
  // (k - 3) / k.
  for (std::size_t i = 0; i < 2; ++i) {
    const auto axis = static_cast<Eigen::Index>(i) + 1;
    const Eigen::Vector3d direction = axes.direction.col(axis);
    const double aside = direction.dot(plane.center);
    plane.variance += across * aside * aside / axes.variance[axis];
    plane.tilt[i] = std::sqrt(across / ((points.count() - 3) * axes.variance[axis])) * direction;
  }
  return plane;
}

}  // namespace pcl_floam
