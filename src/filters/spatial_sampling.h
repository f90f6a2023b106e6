/// \file spatial_sampling.h
/// A choice of a scan's returns that is even in space.
#pragma once

#include "filters/scan_returns.h"

#include <cstddef>
#include <cstdint>
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
  void sample(const ScanReturns& returns, double side, std::vector<ScanPoint>& sample);

  /// The side of cubes of which n returns fill about \p per_root times the root of n, m; 0 without returns.
  [[nodiscard]] double sideFor(const ScanReturns& returns, double per_root);

private:
  /// Some cubes, by what their keys have in common, and a bit for each that was seen.
  struct Block {
    std::uint64_t key = 0;
    std::uint64_t cubes = 0;
  };

  struct Places {
    std::vector<float> x, y, z;
  };

  [[nodiscard]] bool fillMore(const Places& places, double side, std::size_t cells);
  void addFirst(const struct ReturnBatch& batch, float inverse_side, std::vector<ScanPoint>& sample);
  [[nodiscard]] bool isFirst(std::uint64_t cube);
  void forget();
  void grow();
  [[nodiscard]] std::size_t placeOf(std::uint64_t key) const;

  std::vector<Block> table_;
  std::vector<Block> smaller_;  // the table before it grew
  unsigned shift_ = 0;          // leaves as many bits of a hash as number the table's slots
  std::size_t used_ = 0;
  std::size_t last_ = 0;  // block
};

}  // namespace pcl_floam
