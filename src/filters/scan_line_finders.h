/// \file scan_line_finders.h
/// The ways to find scan lines; each returns false if the cloud does not support it. None depends on
/// the number of threads.
#pragma once

#include <pcl_floam/filters/scan_lines.h>

#include <cmath>

namespace pcl_floam {

/// A return that was measured: finite, and not the (0,0,0) that stands for "no return".
inline bool isMeasurable(const CloudView& cloud, std::size_t i)
{
  const float x = cloud.x(i);
  const float y = cloud.y(i);
  const float z = cloud.z(i);
  const float sum = std::abs(x) + std::abs(y) + std::abs(z);
  return sum > 0.0F && std::isfinite(sum);
}

/// The size of the cloud if there is none.
inline std::size_t firstMeasurable(const CloudView& cloud)
{
  std::size_t i = 0;
  while (i < cloud.size && !isMeasurable(cloud, i)) {
    ++i;
  }
  return i;
}

/// Angle above the sensor's xy plane, rad.
inline float elevationOf(const CloudView& cloud, std::size_t i)
{
  return std::atan2(cloud.z(i), std::hypot(cloud.x(i), cloud.y(i)));
}

/// A sensor has no more scan lines than this.
constexpr int kMaxScanLines = 1024;

class LineGrouping;

/// \ref findScanLines in memory that is kept from scan to scan.
void findScanLines(const CloudView& cloud, const SensorModel& sensor, ScanLineSource source, int threads,
                   LineGrouping& grouping, ScanLines& lines);

bool linesFromRingField(const CloudView& cloud, const SensorModel& sensor, int threads, LineGrouping& grouping,
                        ScanLines& lines);
bool linesFromOrganizedRows(const CloudView& cloud, const SensorModel& sensor, int threads, LineGrouping& grouping,
                            ScanLines& lines);
bool linesFromFileOrder(const CloudView& cloud, const SensorModel& sensor, int threads, LineGrouping& grouping,
                        ScanLines& lines);
bool linesFromElevationTable(const CloudView& cloud, const SensorModel& sensor, int threads, LineGrouping& grouping,
                             ScanLines& lines);
bool linesFromElevationClusters(const CloudView& cloud, const SensorModel& sensor, int threads, LineGrouping& grouping,
                                ScanLines& lines);

/// Whether the scan shows more than half a turn. What sees less need not turn at all, as a flash lidar.
bool goesRound(const CloudView& cloud, const ScanLines& lines);

/// Sorts each line by azimuth if the cloud's own order is not that of a sweep; sets the confidence to the
/// fraction of steps in the prevailing direction.
void ensureSweepOrder(const CloudView& cloud, ScanLines& lines, int threads);

}  // namespace pcl_floam
