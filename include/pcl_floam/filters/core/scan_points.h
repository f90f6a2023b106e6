/// \file scan_points.h
/// The returns of one scan as registration and map take them, and a choice of them that is even in space.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/scan_lines.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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
  /// known. See \ref findStraightRuns.
  std::array<float, 3> run = {};
  /// m: the same across the scan lines, to the next ones on both sides.
  std::array<float, 3> run_across = {};
};

/// All returns of a scan between two distances from the sensor, line after line; without scan lines in the cloud's
/// order. It refers to what it is made of.
struct ScanReturns {
  const CloudView& cloud;
  const ScanLines& lines;
  const ScanTiming& timing;
  double min_range;            ///< m
  double max_range;            ///< m
  double vertical_correction;  ///< degrees by which every point is turned up

  [[nodiscard]] bool areAtLeast(std::size_t count) const;
};

/// \param[out] points overwritten; its memory is reused
void collectPoints(const ScanReturns& returns, std::vector<ScanPoint>& points);

/// Finds how far each point's scan line goes on straight about it, up to three neighbours to both sides and a step
/// more, and whether what it is on goes straight on across the next scan lines. On such a run a return may have come
/// from anywhere: of the way along it a return tells as little as the run is long. A wall on which a lidar's columns
/// lie far apart then does not look like a row of posts that move along with the sensor, nor one that its lines cross
/// like a stack of bars. As measured: the sensor's turn from one neighbour to the next is neglected.
/// \param[in,out] points of those returns, best in the order of the lines: the next line's neighbour is sought from
///                       where the last point's was; others, of which laser, place and index do not agree, keep their
///                       runs
void findStraightRuns(const ScanReturns& returns, std::vector<ScanPoint>& points);

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
