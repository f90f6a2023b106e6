#include "map/surface_fit.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace pcl_floam {

namespace {

/// Fewer points have a shape by chance; edges are few, and chosen.
constexpr std::uint32_t kLeastCount = 6;
constexpr std::uint32_t kLeastEdges = 4;
/// A plane's thinnest variance is less than this part of the next, which is at least this part of the widest.
constexpr double kFlat = 0.05;
/// Points of one laser lie on its cone, of two on a plane if there is one; any two lasers' points make a line.
constexpr int kLasersOfPlane = 2;
constexpr int kLasersOfLine = 3;
/// The variance of what fills a cell evenly is its squared side over 12.
constexpr double kEven = 12.0;

}  // namespace

void CellSums::add(double x, double y, double z)
{
  sum[0] += x;
  sum[1] += y;
  sum[2] += z;
  outer[0] += x * x;
  outer[1] += x * y;
  outer[2] += x * z;
  outer[3] += y * y;
  outer[4] += y * z;
  outer[5] += z * z;
  ++count;
}

namespace {

Eigen::Matrix3d covarianceOf(const CellSums& s, const Eigen::Vector3d& mean)
{
  Eigen::Matrix3d outer;
  outer << s.outer[0], s.outer[1], s.outer[2], s.outer[1], s.outer[3], s.outer[4], s.outer[2], s.outer[4], s.outer[5];
  return outer / s.count - mean * mean.transpose();
}

std::array<float, 3> single(const Eigen::Vector3d& v)
{
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

CellFit fitOf(const CellSums& sums, SurfaceShapes shapes, double side)
{
  CellFit fit;
  if (sums.count == 0) {
    return fit;
  }
  const Eigen::Vector3d mean = Eigen::Vector3d(sums.sum[0], sums.sum[1], sums.sum[2]) / sums.count;
  const Eigen::Matrix3d covariance = covarianceOf(sums, mean);
  const Eigen::Matrix3f filled = (kEven / (side * side) * covariance).cast<float>();
  fit.filled = {filled(0, 0), filled(0, 1), filled(0, 2), filled(1, 1), filled(1, 2), filled(2, 2)};
  const int lasers = sums.support.lasers();
  const bool edges = shapes == SurfaceShapes::lines;
  if (sums.count < (edges ? kLeastEdges : kLeastCount) || lasers < kLasersOfPlane) {
    return fit;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covariance);
  const Eigen::Vector3d variance = eigen.eigenvalues().cwiseMax(0.0);  // rising
  fit.mean = single(mean);
  if (variance[1] < kFlat * variance[2]) {
    fit.kind = lasers < kLasersOfLine ? SurfaceKind::unknown : SurfaceKind::line;
    fit.direction = single(eigen.eigenvectors().col(2));
    fit.thickness = static_cast<float>(variance[1]);
    fit.extent = static_cast<float>(variance[2]);
  } else if (edges) {
    fit.kind = SurfaceKind::unknown;
  } else if (variance[0] < kFlat * variance[1]) {
    fit.kind = SurfaceKind::plane;
    fit.direction = single(eigen.eigenvectors().col(0));
    fit.thickness = static_cast<float>(variance[0]);
    fit.extent = static_cast<float>(variance[1]);
  } else {
    fit.kind = SurfaceKind::point;
    Eigen::Map<Eigen::Matrix3f>(fit.axes.data()) = eigen.eigenvectors().cast<float>();
  }
  return fit;
}

}  // namespace pcl_floam
