/// \file edge_position.h
/// Where an edge is: between and behind the points by which a scan line saw it.
#pragma once

#include "filters/line_points.h"

namespace pcl_floam {

/// An edge of a scan line.
struct LineEdge {
  Eigen::Vector3f position;  ///< in the sensor's frame, m
  int first;                 ///< of the points that it takes up, in the line
  int last;                  ///< the last of them

  /// The point whose time is the edge's.
  [[nodiscard]] int middle() const { return (first + last) / 2; }
};

/// Finds the edge that the sharpest point of a scan line stands for.
///
/// The paper takes that point itself. But it is only the last one that happened to hit the surface, always on the near
/// side of what it stands for: a map of such points holds the sensor back, as it comes nearer ahead and goes away
/// behind.
/// - Where the surface ends, the edge is half a step of its points farther.
/// - Something thin, with something farther or nothing on both sides, is taken by its axis, behind what is seen of it.
/// - Where two surfaces meet, the edge is where lines through the points on both sides meet.
///
/// \param noise m: steps of the points up to this are no sign of another surface. The extractor gives the smoothness
///              above which it sees edges.
/// \pre 1 <= n < line.size() - 1
[[nodiscard]] LineEdge locateEdge(const LinePoints& line, int n, float noise);

}  // namespace pcl_floam
