// Scan lines from the points' elevations: a sensor's table, or clusters found in the scan.
#include "common/pi.h"
#include "filters/line_grouping.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <cmath>

namespace pcl_floam {

namespace {

/// Assigns each point to the nearest of the rising \p elevations, if it is nearer than \p tolerance times the
/// distance to that beam's neighbours.
/// \return fraction of the measurable points that were assigned
float groupByElevation(const CloudView& cloud, const std::vector<float>& elevations, float tolerance, int threads,
                       LineGrouping& grouping, ScanLines& lines)
{
  grouping.assign(cloud, threads, [&](std::size_t i) {
    const float elevation = elevationOf(cloud, i);
    const auto above = std::lower_bound(elevations.begin(), elevations.end(), elevation);
    auto nearest = above == elevations.end() ? above - 1 : above;
    if (above != elevations.begin() && above != elevations.end() && elevation - *(above - 1) < *above - elevation) {
      nearest = above - 1;
    }
    const bool has_next = nearest + 1 != elevations.end();
    const float gap = (nearest != elevations.begin() && (!has_next || elevation < *nearest))
                          ? *nearest - *(nearest - 1)
                          : *(nearest + 1) - *nearest;
    const bool is_near = std::abs(elevation - *nearest) <= tolerance * gap;
    return is_near ? static_cast<int>(nearest - elevations.begin()) : LineGrouping::kNoLine;
  });
  grouping.list(static_cast<int>(elevations.size()), lines);
  return grouping.measurable() == 0
             ? 0.0F
             : static_cast<float>(grouping.onLines()) / static_cast<float>(grouping.measurable());
}

constexpr auto kHalfPi = static_cast<float>(0.5 * kPi);
/// rad: finer than scan lines lie apart.
constexpr float kBin = static_cast<float>(0.05 * kPi / 180.0);

/// Number of points per elevation bin.
std::vector<int> elevationHistogram(const CloudView& cloud)
{
  std::vector<int> histogram(static_cast<std::size_t>(2.0F * kHalfPi / kBin) + 2, 0);
  for (std::size_t i = 0; i < cloud.size; ++i) {
    if (isMeasurable(cloud, i)) {
      ++histogram[static_cast<std::size_t>((elevationOf(cloud, i) + kHalfPi) / kBin)];
    }
  }
  return histogram;
}

/// Centres of the histogram's runs of well-filled bins that empty bins separate.
std::vector<float> clusterCenters(const std::vector<int>& histogram, int min_count)
{
  std::vector<float> centers;
  double weighted = 0.0;
  int count = 0;
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    if (histogram[bin] >= min_count) {
      weighted += histogram[bin] * (static_cast<double>(bin) + 0.5);
      count += histogram[bin];
    } else if (count > 0) {
      centers.push_back(static_cast<float>(weighted / count) * kBin - kHalfPi);
      weighted = 0.0;
      count = 0;
    }
  }
  return centers;
}

}  // namespace

bool linesFromElevationTable(const CloudView& cloud, const SensorModel& sensor, int threads, LineGrouping& grouping,
                             ScanLines& lines)
{
  if (sensor.elevations.size() < 2 || sensor.elevations.size() > kMaxScanLines) {
    return false;
  }
  // Half a gap: every point between two beams belongs to one of them; beyond the outermost beams nothing does.
  const float assigned = groupByElevation(cloud, sensor.elevations, 0.5F, threads, grouping, lines);
  ensureSweepOrder(cloud, lines, threads);
  lines.confidence *= assigned;
  return assigned > 0.5F;
}

bool linesFromElevationClusters(const CloudView& cloud, const SensorModel& /*sensor*/, int threads,
                                LineGrouping& grouping, ScanLines& lines)
{
  const std::vector<int> histogram = elevationHistogram(cloud);
  // A line has at least some thousandths of the points; between lines there are next to none.
  const int min_count = std::max(2, static_cast<int>(cloud.size / 4000));
  const std::vector<float> centers = clusterCenters(histogram, min_count);
  constexpr std::size_t kMinClusters = 4;
  constexpr std::size_t kMaxClusters = 256;
  if (centers.size() < kMinClusters || centers.size() > kMaxClusters) {
    return false;
  }
  const float assigned = groupByElevation(cloud, centers, 0.35F, threads, grouping, lines);
  // Surfaces without lines fill the elevations evenly: a third of the gap then holds two thirds of the points.
  constexpr float kClusteredFraction = 0.9F;
  if (assigned < kClusteredFraction) {
    return false;
  }
  ensureSweepOrder(cloud, lines, threads);
  lines.confidence *= assigned;
  return true;
}

}  // namespace pcl_floam
