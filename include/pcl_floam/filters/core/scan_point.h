/// \file scan_point.h
/// A return of a scan as registration and map take it.
#pragma once

#include <array>
#include <cstdint>

namespace pcl_floam {

/// One return.
struct ScanPoint {
  float x = 0.0F;  ///< m, in the sensor's frame at the instant of its own measurement
  float y = 0.0F;
  float z = 0.0F;
  float time = 0.5F;        ///< fraction of the sweep, in [0,1]
  std::uint32_t laser = 0;  ///< the scan line's number; without scan lines that of a part of the sweep, or, of a single
                            ///< layer, the return's own
  std::int32_t index = -1;  ///< of the point in its cloud
  std::int32_t place = -1;  ///< in the list of the scan lines (\ref ScanLines::index); -1: unknown
  /// m: along its scan line, as long as the line goes on straight about the point; zero: it does not, or it is not
  /// known.
  std::array<float, 3> run = {};
  /// m: the same across the scan lines, to the next ones on both sides.
  std::array<float, 3> run_across = {};
};

}  // namespace pcl_floam
