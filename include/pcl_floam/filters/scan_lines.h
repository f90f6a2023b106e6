/// \file scan_lines.h
/// Which laser saw each point of a scan, and in which order: its scan line m and its place n within the line.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/sensor_model.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_floam {

/// Where the scan lines come from.
enum class ScanLineSource : std::uint8_t {
  automatic,          ///< the first of the others, in this order, that the cloud supports
  ring_field,         ///< a field `ring`, `line` or `channel`
  organized_rows,     ///< the rows (or columns) of an organised cloud
  file_order,         ///< points stored line by line, as in KITTI's files
  elevation_table,    ///< the nearest beam of a named sensor
  elevation_clusters  ///< clusters of the elevations found in the scan itself
};

/// Why a scan has no lines.
enum class ScanLineFailure : std::uint8_t {
  none,
  empty_cloud,
  source_not_available,
  no_line_structure,
  not_looked_for,  ///< the sensor has none (\ref SensorModel::has_scan_lines)
  /// All points lie in one plane, as those of a 2-D lidar do: of an odometry by surfaces, whose poses are doubtful then
  /// unless height, roll and pitch are locked.
  single_layer
};

[[nodiscard]] const char* toString(ScanLineSource source);
[[nodiscard]] const char* toString(ScanLineFailure failure);

/// The points of a scan sorted into scan lines.
///
/// Holds only measurable points: finite and not at (0,0,0). The points of line m are
/// `index[begin[m]] ... index[begin[m + 1] - 1]`, in the order in which the head swept over them.
struct ScanLines {
  std::vector<std::int32_t> index;                    ///< point indices into the cloud, line after line
  std::vector<std::int32_t> begin;                    ///< lines() + 1 positions in \ref index
  ScanLineSource source = ScanLineSource::automatic;  ///< what was used; `automatic` if nothing could be
  ScanLineFailure failure = ScanLineFailure::none;
  /// Fraction in [0,1] of neighbouring points that agree with the structure found (same line, right order).
  float confidence = 0.0F;
  /// `organized_rows` only: lines are the cloud's columns, firings its rows (some drivers transpose).
  bool transposed = false;
  /// `file_order` only: lines begin at the front and azimuth rises, as in KITTI's files, which were sorted
  /// afterwards: the order does not show how the head turned.
  bool kitti_order = false;
  /// The points' order within a line was made by azimuth, since the cloud's own order was not a sweep's.
  bool sorted_by_azimuth = false;

  [[nodiscard]] std::size_t lines() const { return begin.empty() ? 0 : begin.size() - 1; }
  [[nodiscard]] bool valid() const { return failure == ScanLineFailure::none && lines() > 0; }
};

/// Finds the scan lines of a cloud.
///
/// \param cloud  one scan in the sensor's frame
/// \param sensor elevation table for `elevation_table`; in the automatic order it is tried before
///               `elevation_clusters` when the sensor is named. One without scan lines: none are looked for
/// \param source `automatic`, or the one source to use
/// \param[out] lines overwritten; its memory is reused. On failure it has no lines and says why.
/// \param threads >= 1; the lines do not depend on it
void findScanLines(const CloudView& cloud, const SensorModel& sensor, ScanLineSource source, ScanLines& lines,
                   int threads = 1);

}  // namespace pcl_floam
