/// \file scan_returns.h
/// The returns of a scan, all or some at a time.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/scan_point.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/scan_lines.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace pcl_floam {

/// All returns of a scan between two distances from the sensor, line after line; without scan lines in the cloud's
/// order. It refers to what it is made of.
struct ScanReturns {
  const CloudView& cloud;
  const ScanLines& lines;
  const ScanTiming& timing;
  float min_range;             ///< m
  float max_range;             ///< m
  double vertical_correction;  ///< degrees by which every point is turned up

  [[nodiscard]] bool areAtLeast(std::size_t count) const;
};

/// Returns of one scan line that follow each other (of any, without scan lines): enough to make loops over them worth
/// while, and few enough to stay in the first cache.
struct ReturnBatch {
  static constexpr std::size_t kMost = 256;

  std::size_t count = 0;
  std::array<float, kMost> x, y, z;        ///< m, corrected
  std::array<std::int32_t, kMost> index;   ///< in the cloud
  std::array<std::int32_t, kMost> place;   ///< as \ref ScanPoint has it
  std::array<std::uint32_t, kMost> laser;  ///< as \ref ScanPoint has it

  [[nodiscard]] ScanPoint point(std::size_t n) const
  {
    return {x[n], y[n], z[n], 0.5F, laser[n], index[n], place[n], {}, {}};
  }
};

/// Squares of the distances between which returns count, m^2.
struct RangeLimits {
  float nearest;
  float farthest;
};

/// Reads the returns, line after line.
class ReturnReader {
public:
  explicit ReturnReader(const ScanReturns& returns);

  /// \return false if there are no more
  bool next(ReturnBatch& batch);

private:
  void readLine(ReturnBatch& batch);
  void readCloud(ReturnBatch& batch);

  const ScanReturns& returns_;
  RangeLimits limits_;
  std::size_t line_ = 0;
  std::size_t place_ = 0;  // in the lines' list, or in the cloud
};

}  // namespace pcl_floam
