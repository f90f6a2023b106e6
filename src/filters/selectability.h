/// \file selectability.h
/// Which points of a scan line could be features, by where they lie in it.
#pragma once

#include "filters/line_points.h"

#include <pcl_floam/filters/core/feature_parameters.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// A depth step hides surface when it is larger than this part of the range.
constexpr float kDepthStep = 0.05F;

/// One number a point, 1 where it can't be a feature: out of range, beside a nearer surface (its neighbourhood changes
/// with the viewpoint), or on a surface seen almost edge on. As wide as the coordinates, for the loops' sake.
void markUnfit(const LinePoints& line, const FeatureParameters& parameters, const LineNeighborhood& neighborhood,
               std::vector<std::int32_t>& unfit);

/// Whether a surface ends at point \p n: the next point on one side lies on another, in front or behind.
/// \pre 1 <= n < line.size() - 1
[[nodiscard]] bool isBesideDepthStep(const LinePoints& line, int n);

}  // namespace pcl_floam
