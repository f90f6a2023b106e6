/// \file line_rating.h
/// How sharp and how flat the points of a scan line are.
#pragma once

#include "filters/line_points.h"
#include "filters/wide_smoothness.h"

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/feature_parameters.h>
#include <pcl_floam/filters/scan_lines.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_floam {

constexpr float kNeverFlat = std::numeric_limits<float>::max();

/// One scan line with what its points would be worth as features; one after another in the same memory.
struct LineRating {
  LinePoints points;
  std::vector<float> sigma;      ///< smoothness (Eq. 1), m
  std::vector<float> sharpness;  ///< of the points that may be edges, as a smoothness in m; 0 elsewhere
  std::vector<float> flatness;   ///< sigma of the points that may be planes, kNeverFlat elsewhere
  WideSmoothness wide;           ///< what near points are worth as edges beyond that
  int each_side = 0;             ///< neighbours of a point in this line
  float edge_threshold = 0.0F;   ///< of this line's edges: above its noise

  /// \param selectable one flag per point of the cloud; empty: all
  /// \return false if the line is too short
  bool rate(const CloudView& cloud, const ScanLines& lines, std::size_t m, const FeatureParameters& parameters,
            const std::vector<std::uint8_t>& selectable);

private:
  [[nodiscard]] float noiseThreshold(const FeatureParameters& parameters);

  std::vector<std::int32_t> unfit_;
  std::vector<float> sample_;  ///< of sigma, or spacings
};

}  // namespace pcl_floam
