#include "map/surface_fit.h"

#include <Eigen/Eigenvalues>

namespace pcl_floam {

namespace {

/// Fewer points have a shape by chance.
constexpr int kLeastCount = 6;
/// A plane's thinnest variance is less than this part of the next, which is at least this part of the widest.
constexpr double kFlat = 0.05;
/// m^2: what is no thicker than twice the noise may be a plane, or a line, whose cell is too small to show it.
constexpr double kByNoise = 4.0 * kRangeNoise * kRangeNoise;
/// Points of one laser lie on its cone, of two on a plane if there is one; any two lasers' points make a line.
constexpr int kLasersOfPlane = 2;
constexpr int kLasersOfLine = 3;

Eigen::Matrix3d covarianceOf(const PointMoments& points)
{
  const Eigen::Vector3d mean = points.mean();
  return points.squares() / static_cast<double>(points.count()) - mean * mean.transpose();
}

/// What fills a cell evenly goes on beyond it, and tells nothing of the way along it: its variance is the squared side
/// over 12. Of two rings or three, that depends on how many of them the cell happens to hold; so what fills the cell
/// around evenly does not tell either.
Eigen::Matrix3d observabilityAmong(const Eigen::Matrix3d& axes, const Eigen::Vector3d& own, const CellSums& around,
                                   double side)
{
  const Eigen::Matrix3d wider = 0.25 * (axes.transpose() * covarianceOf(around.points) * axes);
  const Eigen::Vector3d variance = own.cwiseMax(wider.diagonal());
  constexpr double kEven = 12.0;
  constexpr double kChance = 1.25;  // as few points vary by chance
  const Eigen::Array3d filled = kEven / (side * side) * variance.array();
  const Eigen::Vector3d shown = (1.0 - kChance * filled).max(0.0);
  return axes * shown.asDiagonal() * axes.transpose();
}

std::array<float, 3> single(const Eigen::Vector3d& v)
{
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

void CellSums::add(const Eigen::Vector3d& point, std::uint32_t laser)
{
  points.add(point);
  lasers |= std::uint64_t{1} << (laser % 64U);  // those of sensors with more than 64 share bits
}

CellFit fitOf(const CellSums& sums, double side, const CellSums* around)
{
  CellFit fit;
  const int lasers = __builtin_popcountll(sums.lasers);
  if (sums.points.count() < kLeastCount || lasers < kLasersOfPlane) {
    return fit;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(covarianceOf(sums.points));
  const Eigen::Vector3d variance = eigen.eigenvalues().cwiseMax(0.0);  // rising
  CellShape& shape = fit.shape;
  shape.mean = single(sums.points.mean());
  if (variance[1] < kFlat * variance[2]) {
    fit.kind = lasers < kLasersOfLine ? SurfaceKind::unknown : SurfaceKind::line;
    shape.direction = single(eigen.eigenvectors().col(2));
    shape.thickness = static_cast<float>(variance[1]);
    shape.extent = static_cast<float>(variance[2]);
  } else if (variance[0] < kFlat * variance[1]) {
    fit.kind = SurfaceKind::plane;
    shape.direction = single(eigen.eigenvectors().col(0));
    shape.thickness = static_cast<float>(variance[0]);
    shape.extent = static_cast<float>(variance[1]);
    const std::array<float, 3> wide = single(eigen.eigenvectors().col(2));
    fit.along = {wide[0], wide[1], wide[2], static_cast<float>(variance[2])};
  } else if (variance[0] < kByNoise) {
    fit.kind = SurfaceKind::unknown;
  } else {
    fit.kind = SurfaceKind::point;
    if (around != nullptr) {
      Eigen::Map<Eigen::Matrix3f>(fit.along.data()) =
          observabilityAmong(eigen.eigenvectors(), variance, *around, side).cast<float>();
    }
  }
  return fit;
}

}  // namespace pcl_floam
