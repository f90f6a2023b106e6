/// \file quantile.h
/// Quantiles of some numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pcl_floam::tools {

/// Linear between the two numbers around the rank.
/// \param values at least one
/// \param part   0: the smallest; 1: the largest
[[nodiscard]] inline double quantile(std::vector<double> values, double part)
{
  const double rank = part * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), below, values.end());
  const auto above = below + 1 == values.end() ? below : std::min_element(below + 1, values.end());
  return *below + (rank - static_cast<double>(below - values.begin())) * (*above - *below);
}

}  // namespace pcl_floam::tools
