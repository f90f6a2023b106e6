/// \file scan_repetition.h
/// Scans that come twice, as drivers and recordings that stumble give them.
#pragma once

#include "common/hash.h"

#include <pcl_floam/common/core/cloud_view.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace pcl_floam {

/// The scan before, as far as it takes to know it again.
class ScanRepetition {
public:
  /// Whether a scan is the one before: of its stamp and size, and some points the same bit for bit. Noise does not draw
  /// them twice; without a stamp, a sensor of no noise might.
  bool isLastAgain(const CloudView& scan, std::optional<double> stamp)
  {
    constexpr std::size_t kSome = 256;
    std::uint64_t points = 0;
    const std::size_t stride = std::max<std::size_t>(1, scan.size / kSome);
    for (std::size_t i = 0; i < scan.size; i += stride) {
      points = hashOf(points ^ keyOf({scan.x(i), scan.y(i), scan.z(i)}), 0);
    }
    const bool is_again = stamp && scan.size > 0 && stamp == stamp_ && scan.size == size_ && points == points_;
    stamp_ = stamp;
    size_ = scan.size;
    points_ = points;
    return is_again;
  }

private:
  std::optional<double> stamp_;
  std::size_t size_ = 0;
  std::uint64_t points_ = 0;  // a hash of some
};

}  // namespace pcl_floam
