/// \file placed_points.h
/// Points of a sweep where an estimate has them, and what the map has there.
#pragma once

#include "common/sweep_trajectory.h"
#include "registration/surface_registration.h"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace pcl_floam {

/// A point where the present estimate has it.
struct PlacedPoint {
  const ScanPoint* measured;
  Eigen::Vector3d arm;    ///< from the sensor, in the target's axes
  Eigen::Vector3d place;  ///< in the target's frame
  double since_middle;    ///< in sweeps
};

/// What was found at a place.
struct FoundSurface {
  Eigen::Vector3d at = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());  ///< nothing yet
  Surface surface;
};

/// Some of them, and the surface at each.
struct PlacedPoints {
  static constexpr std::size_t kMost = 64;

  /// The next ones of a term, one in so many.
  /// \param found before, of all points of the term: those that have hardly moved keep it; nullptr: it is not kept
  PlacedPoints(const SweepTrajectory& sensor, const SurfaceTerm& term, std::size_t chunk, std::size_t stride,
               FoundSurface* found);

  /// So many make up a term.
  [[nodiscard]] static std::size_t chunksOf(const SurfaceTerm& term, std::size_t stride);

  std::size_t begin = 0;  ///< of all that are taken
  std::size_t count = 0;
  std::array<PlacedPoint, kMost> points;
  std::array<Surface, kMost> surfaces;
};

/// Places the points of a scan and of its edges.
/// \param found before, at the edges; nullptr: it is not kept
/// \param chunk takes the number of a chunk, the edges' after the scan's, and its points; it may write what is of that
///              number alone
template <typename Chunk>
void forEachChunk(const SweepTrajectory& sensor, const SurfaceTerm& scan, std::size_t stride, const SurfaceTerm& edges,
                  std::size_t edge_stride, FoundSurface* found, int threads, const Chunk& chunk)
{
  const std::size_t of_scan = PlacedPoints::chunksOf(scan, stride);
  const std::size_t chunks = of_scan + PlacedPoints::chunksOf(edges, edge_stride);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (std::size_t c = 0; c < chunks; ++c) {
    chunk(c, c < of_scan ? PlacedPoints(sensor, scan, c, stride, nullptr)
                         : PlacedPoints(sensor, edges, c - of_scan, edge_stride, found));
  }
}

/// Where the pose is not yet to be exact, one point in so many is enough, if there are many.
[[nodiscard]] std::size_t coarseStride(const SurfaceTerm& term);

/// m, root of the mean square, and one without points: so far a turn moves the points of a scan, per rad.
[[nodiscard]] double rmsRange(const std::vector<ScanPoint>& points);

/// m^2: how far a point may be from a plane that it is on: range noise, the plane's thickness, and what points that
/// are far from its middle make of its tilt.
/// \param turn arm x direction
[[nodiscard]] double varianceFrom(const Surface& plane, const PlacedPoint& point, const Eigen::Vector3d& turn,
                                  double squared_distance);

/// m^2, from a line or a point.
[[nodiscard]] double varianceFrom(const Surface& line_or_point);

/// A shape has at least this variance along itself, m^2.
inline constexpr double kNoExtent = 1e-9;

}  // namespace pcl_floam
