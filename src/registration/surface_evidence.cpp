#include "registration/surface_evidence.h"

#include "common/pi.h"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace pcl_floam {

namespace {

/// A density, of all points that may be anywhere within a metre: so what fills its cell, and is near wherever the
/// sensor is supposed to be, tells nothing, and what is in one place, more than what is in one plane.
/// \param dimensions in which the surface tells where its points are: 1 for a plane, 2 for a line
double evidenceOf(double squared, double variance, double dimensions)
{
  constexpr double kOutliers = 0.01;  // share of the points of which the map knows nothing
  const double density = std::exp(-0.5 * (squared / variance + dimensions * std::log(2.0 * kPi * variance)));
  return std::log(kOutliers + (1.0 - kOutliers) * density) / kResidualsPerIndependentOne;
}

double evidenceOf(const PlacedPoint& point, const Surface& surface)
{
  const Eigen::Vector3d off = point.place - surface.center;
  const double along = surface.direction.dot(off);
  switch (surface.kind) {
    case SurfaceKind::plane: {
      const Eigen::Vector3d turn = point.arm.cross(surface.direction);
      return evidenceOf(along * along, varianceFrom(surface, point, turn, along * along), 1.0);
    }
    case SurfaceKind::line: return evidenceOf(off.squaredNorm() - along * along, varianceFrom(surface), 2.0);
    case SurfaceKind::point:
      return evidenceOf(off.dot(surface.observability * off), varianceFrom(surface), surface.observability.trace());
    case SurfaceKind::unknown: break;
  }
  return 0.0;
}

}  // namespace

double SurfaceEvidence::of(const SurfaceTerm& scan, const SurfaceTerm& edges, std::vector<FoundSurface>& found,
                           std::vector<float>* of_points) const
{
  const std::size_t of_scan = PlacedPoints::chunksOf(scan, 1);
  std::vector<double> parts(of_scan + PlacedPoints::chunksOf(edges, 1), 0.0);
  if (of_points != nullptr) {
    of_points->assign(scan.points->size(), 0.0F);
  }
  forEachChunk(sensor, scan, 1, edges, 1, found.data(), threads, [&](std::size_t c, const PlacedPoints& placed) {
    for (std::size_t i = 0; i < placed.count; ++i) {
      const double evidence = evidenceOf(placed.points[i], placed.surfaces[i]);
      parts[c] += evidence;
      if (of_points != nullptr && c < of_scan) {
        (*of_points)[placed.begin + i] = static_cast<float>(evidence);
      }
    }
  });
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

}  // namespace pcl_floam
