/// \file wide_smoothness.h
/// Smoothness over neighbourhoods that are wide against the range noise.
#pragma once

#include "filters/line_points.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Near the sensor a few neighbours are closer to each other than their noise, and a door's frame a metre away is lost
/// in it. Over as many as it takes to go some way along the surface, noise is averaged out. A departure from the paper,
/// whose five neighbours on each side are so many at any distance.
class WideSmoothness {
public:
  void clear() { reach_.clear(); }

  /// Raises the sharpness of points that are edges over a wide neighbourhood.
  /// \param each_side neighbours of a point that its smoothness \p sigma (Eq. 1) was computed from
  /// \param spacing   of the line's points, rad
  void rate(const LinePoints& line, int each_side, float spacing, const std::vector<float>& sigma,
            const std::vector<std::int32_t>& unfit, std::vector<float>& sharpness);

  /// Neighbours on each side over which a point is an edge; 0: it is none, or as the line's others are.
  [[nodiscard]] int reachOf(int n) const { return reach_.empty() ? 0 : reach_[static_cast<std::size_t>(n)]; }

private:
  void sum(const LinePoints& line, const std::vector<float>& sigma);
  [[nodiscard]] float sharpnessAt(int n, int reach, int each_side) const;

  std::vector<std::array<double, 4>> sums_;  ///< of coordinates and sigma, of all points before
  std::vector<int> reach_;
};

}  // namespace pcl_floam
