#include "registration/local_shape.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Enough for a steady normal, few enough to stay local.
constexpr int kNeighbors = 14;

/// For what looks like a line at first: a scanner's points lie closer along its scan lines than across them, and these
/// are no lines of the scene.
constexpr int kMoreNeighbors = 40;

/// A line's second eigenvalue is at most this times the largest: half a disc, a plane's border, has 0.28.
constexpr double kLineRatio = 0.03;

/// A plane's smallest eigenvalue is at most this times the second.
constexpr double kPlaneRatio = 0.1;

/// In clouds of fewer points neighbourhoods reach so far that their points need not lie on one surface.
constexpr std::size_t kFewPoints = 1000;

LocalShape shapeOf(const PointTree& tree, const NearestPoints& neighbors)
{
  LocalShape shape;
  if (neighbors.count < 4) {
    return shape;
  }
  const Eigen::Vector3f& anchor = tree.points()[static_cast<std::size_t>(neighbors.index[0])];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(neighbors.count); ++i) {
    const Eigen::Vector3d offset =
        (tree.points()[static_cast<std::size_t>(neighbors.index[i])] - anchor).cast<double>();
    sum += offset;
    squares += offset * offset.transpose();
  }
  const double count = neighbors.count;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(squares / count - sum * sum.transpose() / (count * count));
  const Eigen::Vector3d& eigenvalues = solver.eigenvalues();
  if (!(eigenvalues[2] > 0.0)) {
    return shape;
  }
  if (eigenvalues[1] < kLineRatio * eigenvalues[2]) {
    shape.kind = ShapeKind::line;
    shape.axis = solver.eigenvectors().col(2).cast<float>();
  } else if (eigenvalues[0] < kPlaneRatio * eigenvalues[1]) {
    shape.kind = ShapeKind::plane;
    shape.axis = solver.eigenvectors().col(0).cast<float>();
  }
  const Eigen::Vector3d to_centre = tree.size() < kFewPoints ? Eigen::Vector3d::Zero() : Eigen::Vector3d(sum / count);
  const Eigen::Vector3d axis = shape.axis.cast<double>();
  if (shape.kind == ShapeKind::plane) {
    shape.to_surface = (axis * axis.dot(to_centre)).cast<float>();
  } else if (shape.kind == ShapeKind::line) {
    shape.to_surface = (to_centre - axis * axis.dot(to_centre)).cast<float>();
  }
  if (!shape.axis.allFinite()) {
    shape = LocalShape();
  }
  return shape;
}

/// Points spread evenly at distance s on a surface have k neighbours within s * sqrt(k / pi).
double spacingFrom(std::vector<float>& radii)
{
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return std::sqrt(3.14159265358979323846 / kNeighbors) * static_cast<double>(*middle);
}

}  // namespace

LocalShapes findLocalShapes(const PointTree& tree, int threads)
{
  LocalShapes shapes;
  if (tree.empty()) {
    return shapes;
  }
  shapes.shape.resize(tree.size());
  std::vector<float> radii(tree.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic, 256)
  for (std::ptrdiff_t n = 0; n < static_cast<std::ptrdiff_t>(tree.size()); ++n) {
    const auto i = static_cast<std::size_t>(n);
    NearestPoints neighbors;
    tree.nearest(tree.points()[i], kNeighbors, neighbors);
    shapes.shape[i] = shapeOf(tree, neighbors);
    radii[i] = std::sqrt(neighbors.squared_distance[static_cast<std::size_t>(neighbors.count - 1)]);
    if (shapes.shape[i].kind == ShapeKind::line) {
      tree.nearest(tree.points()[i], kMoreNeighbors, neighbors);
      shapes.shape[i] = shapeOf(tree, neighbors);
    }
  }
  shapes.spacing = spacingFrom(radii);
  return shapes;
}

}  // namespace pcl_floam
