/// \file smoothness.h
/// Local smoothness of a scan line (Eq. 1).
#pragma once

#include "filters/line_points.h"

#include <pcl_floam/filters/core/feature_parameters.h>

#include <vector>

namespace pcl_floam {

/// sigma of every point of a line from \p half_window neighbours on each side (Eq. 1), in m.
/// Points with fewer neighbours than that on a side get NaN: they are neither edges nor planes.
void computeSmoothness(const LinePoints& line, int half_window, SmoothnessKind kind, std::vector<float>& sigma);

/// The same of what lies across the line (\ref meanDifferenceAcross): where points are unevenly apart, the whole is
/// long on a straight line, too.
void computeSmoothnessAcross(const LinePoints& line, int half_window, std::vector<float>& sigma);

/// Mean distance from point \p n to its neighbours, in m: Eq. 1 as printed, for one point.
/// \pre half_window <= n < line.size() - half_window
[[nodiscard]] float meanNeighborDistance(const LinePoints& line, int n, int half_window);

/// The part of the mean difference to the neighbours that lies across the line, in m: 0 on a straight line however its
/// points are spaced, the whole of it at a corner.
/// \pre half_window <= n < line.size() - half_window
[[nodiscard]] float meanDifferenceAcross(const LinePoints& line, int n, int half_window);

}  // namespace pcl_floam
