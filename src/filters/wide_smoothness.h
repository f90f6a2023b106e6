/// \file wide_smoothness.h
/// Smoothness over neighbourhoods that are wide against the range noise.
#pragma once

#include "filters/line_points.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Of whose edges is asked.
struct WideNeighborhood {
  int each_side = 5;            ///< neighbours of a point that its smoothness (Eq. 1) was computed from
  float spacing = 0.0F;         ///< of the line's points, rad
  float edge_threshold = 0.0F;  ///< sharpness of an edge, m
};

/// Near the sensor a few neighbours are closer to each other than their noise, and a door's frame a metre away is lost
/// in it. Over as many as it takes to go some way along the surface, noise is averaged out. A departure from the paper,
/// whose five neighbours on each side are so many at any distance.
class WideSmoothness {
public:
  void clear() { reach_.clear(); }

  /// Raises the sharpness of points that are edges over a wide neighbourhood, none of them behind a depth step.
  /// \param sigma the smoothness of the line's points (Eq. 1)
  void rate(const LinePoints& line, const WideNeighborhood& neighborhood, const std::vector<float>& sigma,
            const std::vector<std::int32_t>& unfit, std::vector<float>& sharpness);

  /// Whether a point is an edge over a wide neighbourhood.
  [[nodiscard]] bool isEdge(int n) const { return !reach_.empty() && reach_[static_cast<std::size_t>(n)] > 0; }

  /// Takes away the sharpness of the wide neighbourhoods that have an edge in common with that at \p n.
  void forgetAround(const LinePoints& line, int n, std::vector<float>& sharpness) const;

private:
  /// A point's neighbourhood, whose size tells how much of the noise is left.
  struct Window {
    int reach = -1;         ///< points on each side
    int middle = 0;         ///< of these in the middle
    double per_side = 0.0;  ///< what a point of a side counts in its mean
    double per_middle = 0.0;
    double noise_ratio = 1.0;  ///< variance by noise of the line's own smoothness, in that of this one
  };

  void sum(const LinePoints& line, const std::vector<float>& sigma);
  [[nodiscard]] int reachAt(const LinePoints& line, int n) const;
  [[nodiscard]] Window windowOf(int reach) const;
  [[nodiscard]] bool isHidden(const LinePoints& line, int n, int reach) const;
  [[nodiscard]] float sharpnessAt(int n, const Window& window) const;

  WideNeighborhood neighborhood_;
  std::vector<std::array<double, 4>> sums_;  ///< of coordinates and sigma, of all points before
  std::vector<int> reach_;                   ///< neighbours on each side over which a point is an edge; 0: it is none
};

}  // namespace pcl_floam
