#include "registration/local_shape.h"

#include "common/point_moments.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
constexpr std::size_t kSparsePoints = 1000;

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
  if (axes.variance[1] < kLineRatio * axes.variance[2]) {
    shape.kind = ShapeKind::line;
    shape.axis = axes.direction.col(2).cast<float>();
  } else if (axes.variance[0] < kPlaneRatio * axes.variance[1]) {
    shape.kind = ShapeKind::plane;
    shape.axis = axes.direction.col(0).cast<float>();
  }
  const Eigen::Vector3d to_centre = tree.size() < kSparsePoints ? Eigen::Vector3d::Zero() : moments.mean();
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

/// The neighbourhoods of points one after the other, each of which lies near the one before.
class Neighborhoods {
public:
  Neighborhoods(const PointTree& tree, int number) : tree_(tree), number_(number) {}

  const NearestPoints& of(const Eigen::Vector3f& point)
  {
    // The neighbours of the last point are within its radius of that: so many there are here within that and the way.
    constexpr float kRounding = 1.0001F;
    const float bound = kRounding * (radius_ + (point - last_).norm());
    tree_.nearest(point, number_, nearest_, std::isfinite(bound) ? bound * bound : std::numeric_limits<float>::max());
    last_ = point;
    radius_ = nearest_.count() < number_ ? std::numeric_limits<float>::infinity() : radius();
    return nearest_;
  }

  /// Distance of the farthest neighbour of the last point, m.
  [[nodiscard]] float radius() const { return std::sqrt(nearest_.squaredDistance(nearest_.count() - 1)); }

private:
  const PointTree& tree_;
  int number_;
  NearestPoints nearest_;
  Eigen::Vector3f last_ = Eigen::Vector3f::Zero();
  float radius_ = std::numeric_limits<float>::infinity();
};

}  // namespace

Sampling findSampling(const PointTree& tree, const std::vector<Eigen::Vector3f>& places)
{
  Sampling sampling;
  if (tree.empty() || places.empty()) {
    return sampling;
  }
  std::vector<float> radii;
  std::size_t narrow = 0;
  Neighborhoods neighborhoods(tree, kNeighbors);
  for (const Eigen::Vector3f& place : places) {
    const PrincipalAxes axes = momentsAround(tree, place, neighborhoods.of(place)).axes();
    radii.push_back(neighborhoods.radius());
    narrow += axes.variance[1] < kNarrow * axes.variance[2] ? 1 : 0;
  }
  sampling.spacing = spacingFrom(radii);
  sampling.in_lines = static_cast<double>(narrow) > kNarrowPart * static_cast<double>(places.size());
  return sampling;
}

LocalShapes findLocalShapes(const PointTree& tree, int threads)
{
  constexpr std::ptrdiff_t kChunk = 256;
  LocalShapes shapes;
  if (tree.empty()) {
    return shapes;
  }
  shapes.shape.resize(tree.size());
  std::vector<float> radii(tree.size());
  const auto size = static_cast<std::ptrdiff_t>(tree.size());
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1)
  for (std::ptrdiff_t first = 0; first < size; first += kChunk) {
    Neighborhoods few(tree, kNeighbors);
    Neighborhoods more(tree, kMoreNeighbors);
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(std::min(size, first + kChunk)); ++i) {
      const Eigen::Vector3f& point = tree.points()[i];
      shapes.shape[i] = shapeOf(tree, point, few.of(point));
      radii[i] = few.radius();
      if (shapes.shape[i].kind == ShapeKind::line) {
        shapes.shape[i] = shapeOf(tree, point, more.of(point));
      }
    }
  }
  shapes.spacing = spacingFrom(radii);
  return shapes;
}

}  // namespace pcl_floam
