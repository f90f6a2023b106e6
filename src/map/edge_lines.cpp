#include "map/edge_lines.h"

#include "map/neighbor_moments.h"

#include <algorithm>
#include <array>

namespace pcl_floam {

namespace {

/// m; the edges of one voxel are one, their mean.
constexpr double kVoxel = 0.1;
/// m; as far as the edges of a line are looked for (LOAM's): no more than a block of the layer, for speed.
constexpr double kRadius = 1.0;
/// As many as a line goes through: one less than the paper's, since rings that are far apart leave few on a post.
constexpr int kEdges = 4;
/// Of variances: along a line to the next one across it (LOAM's). So few edges are seldom straighter.
constexpr double kStraight = 3.0;
/// m; a line is longer than noise, one standard deviation.
constexpr double kShortest = 0.05;

Surface lineThrough(const Neighbors& edges, const Eigen::Vector3d& place)
{
  Surface line;
  if (edges.count < kEdges) {
    return line;
  }
  const PointMoments moments = momentsOf(edges);
  const PrincipalAxes axes = moments.axes();
  const double across = std::max(0.0, axes.variance[1]);
  if (axes.variance[2] > std::max(kShortest * kShortest, kStraight * across)) {
    line.kind = SurfaceKind::line;
    line.center = place + moments.mean();
    line.direction = axes.direction.col(2);
    line.thickness = across;
    line.extent = axes.variance[2];
    line.count = kEdges;
  }
  return line;
}

}  // namespace

EdgeLines::EdgeLines() : layer_(std::make_unique<VoxelLayer>(kVoxel)) {}

EdgeLines::EdgeLines(const EdgeLines& other) : SurfaceSearch(other), layer_(std::make_unique<VoxelLayer>(*other.layer_))
{
}

void EdgeLines::find(const Eigen::Vector3d* places, std::size_t count, Surface* surfaces) const
{
  constexpr std::size_t kTogether = 16;
  std::array<Neighbors, kTogether> nearest;
  for (std::size_t begin = 0; begin < count; begin += kTogether) {
    const std::size_t together = std::min(kTogether, count - begin);
    layer_->nearestOfEach(places + begin, together, kEdges, kRadius, nearest.data());
    for (std::size_t i = 0; i < together; ++i) {
      surfaces[begin + i] = lineThrough(nearest[i], places[begin + i]);
    }
  }
}

}  // namespace pcl_floam
