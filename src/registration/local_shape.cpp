#include "registration/local_shape.h"

#include "common/median.h"
#include "common/pi.h"
#include "common/point_moments.h"

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

/// Points lie in lines where so large a part of the neighbourhoods is so narrow, as the second eigenvalue against the
/// largest. Evenly sampled surfaces have few, at their edges.
constexpr double kNarrow = 0.1;
constexpr double kNarrowPart = 0.25;

/// About a point.
PointMoments momentsAround(const PointTree& tree, const Eigen::Vector3f& point, const NearestPoints& neighbors)
{
  PointMoments moments;
  for (int i = 0; i < neighbors.count(); ++i) {
    moments.add((tree.points()[static_cast<std::size_t>(neighbors.index(i))] - point).cast<double>());
  }
  return moments;
}

bool isLine(const PrincipalAxes& axes)
{
  return axes.variance[1] < kLineRatio * axes.variance[2];
}

bool isPlane(const PrincipalAxes& axes)
{
  return axes.variance[0] < kPlaneRatio * axes.variance[1];
}

LocalShape shapeOf(const PointTree& tree, const Eigen::Vector3f& point, const NearestPoints& neighbors)
{
  LocalShape shape;
  if (neighbors.count() < 4) {
    return shape;
  }
  const PointMoments moments = momentsAround(tree, point, neighbors);
  const PrincipalAxes axes = moments.axes();
  if (!(axes.variance[2] > 0.0)) {
    return shape;
  }
  const bool is_line = isLine(axes);
  if (!is_line && !isPlane(axes)) {
    return shape;
  }
  shape.kind = is_line ? ShapeKind::line : ShapeKind::plane;
  shape.axis = axes.direction.col(is_line ? 2 : 0).cast<float>();
  const Eigen::Vector3d axis = shape.axis.cast<double>();
  const Eigen::Vector3d along = axis * axis.dot(moments.mean());
  shape.to_surface = (is_line ? Eigen::Vector3d(moments.mean() - along) : along).cast<float>();
  return shape.axis.allFinite() ? shape : LocalShape();
}

/// Points spread evenly at distance s on a surface have k neighbours within s * sqrt(k / pi).
double spacingFrom(std::vector<float>& radii)
{
  return std::sqrt(kPi / kNeighbors) * static_cast<double>(medianOf(radii));
}

/// Distance of the farthest neighbour, m.
float radiusOf(const NearestPoints& neighbors)
{
  return std::sqrt(neighbors.squaredDistance(neighbors.count() - 1));
}

}  // namespace

Sampling findSampling(const PointTree& tree, const std::vector<Eigen::Vector3f>& places)
{
  Sampling sampling;
  if (tree.empty() || places.empty()) {
    return sampling;
  }
  std::vector<float> radii;
  std::size_t narrow = 0;
  std::size_t shapeless = 0;
  NearestPoints neighbors;
  for (const Eigen::Vector3f& place : places) {
    tree.nearest(place, kNeighbors, neighbors);
    const PrincipalAxes axes = momentsAround(tree, place, neighbors).axes();
    radii.push_back(radiusOf(neighbors));
    narrow += axes.variance[1] < kNarrow * axes.variance[2] ? 1 : 0;
    shapeless += isLine(axes) || isPlane(axes) ? 0 : 1;
  }
  sampling.spacing = spacingFrom(radii);
  sampling.in_lines = static_cast<double>(narrow) > kNarrowPart * static_cast<double>(places.size());
  sampling.shapeless = static_cast<double>(shapeless) / static_cast<double>(places.size());
  return sampling;
}

LocalShapes findLocalShapes(const PointTree& tree, int threads)
{
  LocalShapes shapes;
  if (tree.empty()) {
    return shapes;
  }
  shapes.shape.resize(tree.size());
  std::vector<float> radii(tree.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic, 256)
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const Eigen::Vector3f& point = tree.points()[i];
    NearestPoints neighbors;
    tree.nearest(point, kNeighbors, neighbors);
    shapes.shape[i] = shapeOf(tree, point, neighbors);
    radii[i] = radiusOf(neighbors);
    if (shapes.shape[i].kind == ShapeKind::line) {
      tree.nearest(point, kMoreNeighbors, neighbors);
      shapes.shape[i] = shapeOf(tree, point, neighbors);
    }
  }
  shapes.spacing = spacingFrom(radii);
  return shapes;
}

}  // namespace pcl_floam
