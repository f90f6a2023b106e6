/// \file spatial_sampling.h
/// A choice of a scan's returns that is even in space.
#pragma once

#include "common/hash.h"
#include "filters/scan_returns.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace pcl_floam {

/// Takes points evenly by space: the first one in each cube. Fastest where samples that follow each other are about as
/// large.
class SpatialSampling {
public:
  /// \param side m, of the cubes
  /// \param[out] sample overwritten; its memory is reused
  void sample(const std::vector<ScanPoint>& points, double side, std::vector<ScanPoint>& sample);
  /// Of a scan, whose other points need not be listed, nor their times be found.
  /// \param enough it may end with so many
  void sample(const ScanReturns& returns, double side, std::vector<ScanPoint>& sample,
              std::size_t enough = std::numeric_limits<std::size_t>::max());

  /// The side of cubes of which n returns fill about \p per_root times the root of n, m; 0 without returns.
  [[nodiscard]] double sideFor(const ScanReturns& returns, double per_root);

private:
  template <typename Take>
  void takeFirst(std::size_t count, const float* x, const float* y, const float* z, double side, const Take& take);

  HashTable<std::uint64_t> seen_;  // cubes, by what those of a block have in common: a bit for each
};

}  // namespace pcl_floam
