#include "registration/line_plane_fit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Mean and eigen-decomposition of the covariance of a few points; eigenvalues rise.
struct Distribution {
  explicit Distribution(const Neighbors& neighbors)
  {
    const double count = neighbors.count;
    for (int i = 0; i < neighbors.count; ++i) {
      center += neighbors[i].offset.cast<double>();
    }
    center /= count;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (int i = 0; i < neighbors.count; ++i) {
      const Eigen::Vector3d difference = neighbors[i].offset.cast<double>() - center;
      covariance += difference * difference.transpose();
    }
    solver.computeDirect(covariance / count);
  }

  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
};

/// By what the plane's variance is larger at the query, the origin, than at the neighbours' centre.
double extrapolation(const Distribution& points)
{
  double factor = 1.0;
  for (int axis = 1; axis < 3; ++axis) {
    const double beside = points.solver.eigenvectors().col(axis).dot(points.center);
    factor += beside * beside / points.solver.eigenvalues()[axis];
  }
  return factor;
}

/// Points that scatter by sigma across a plane, and along an axis by s, leave its normal off by sigma / (s sqrt(k)).
///
/// The scatter about a plane fitted to the same k points is less than that about the true one by (k - 3) / k; points of
/// the map, being means of voxels, are off together. Against smooth corridors, half as much variance again fits.
Eigen::Vector3d tiltAlong(const Distribution& points, int axis, int count)
{
  constexpr double kVarianceFactor = 1.5;
  const Eigen::Vector3d& eigenvalues = points.solver.eigenvalues();
  return std::sqrt(kVarianceFactor * std::max(0.0, eigenvalues[0]) / (count * eigenvalues[axis])) *
         points.solver.eigenvectors().col(axis);
}

}  // namespace

std::optional<LineFit> fitLine(const Neighbors& neighbors, const RegistrationParameters& parameters)
{
  const Distribution points(neighbors);
  const Eigen::Vector3d& eigenvalues = points.solver.eigenvalues();
  if (!(eigenvalues[2] > parameters.line_ratio * eigenvalues[1]) || !(eigenvalues[2] > 0.0)) {
    return std::nullopt;
  }
  return LineFit{points.center, points.solver.eigenvectors().col(2)};
}

std::optional<PlaneFit> fitPlane(const Neighbors& neighbors, const RegistrationParameters& parameters)
{
  const Distribution points(neighbors);
  const Eigen::Vector3d& eigenvalues = points.solver.eigenvalues();
  if (!(eigenvalues[1] > parameters.plane_ratio * eigenvalues[0]) ||
      !(eigenvalues[1] > parameters.plane_spread * eigenvalues[2])) {
    return std::nullopt;
  }
  return PlaneFit{points.center,
                  points.solver.eigenvectors().col(0),
                  std::max(0.0, eigenvalues[0]) * extrapolation(points),
                  {tiltAlong(points, 1, neighbors.count), tiltAlong(points, 2, neighbors.count)}};
}

}  // namespace pcl_floam
