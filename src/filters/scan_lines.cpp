#include <pcl_floam/filters/scan_lines.h>

#include "filters/line_grouping.h"
#include "filters/scan_line_finders.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_floam {

const char* toString(ScanLineSource source)
{
  switch (source) {
    case ScanLineSource::automatic: return "automatic";
    case ScanLineSource::ring_field: return "ring field";
    case ScanLineSource::organized_rows: return "organized rows";
    case ScanLineSource::file_order: return "file order";
    case ScanLineSource::elevation_table: return "elevation table";
    case ScanLineSource::elevation_clusters: return "elevation clusters";
  }
  return "unknown";
}

const char* toString(ScanLineFailure failure)
{
  switch (failure) {
    case ScanLineFailure::none: return "none";
    case ScanLineFailure::empty_cloud: return "the cloud has no measurable point";
    case ScanLineFailure::source_not_available: return "the cloud lacks what the chosen source of scan lines needs";
    case ScanLineFailure::no_line_structure: return "no scan-line structure was found";
    case ScanLineFailure::not_looked_for: return "scan lines were not looked for";
    case ScanLineFailure::single_layer: return "the scan is a single layer";
  }
  return "unknown";
}

namespace {

using Finder = bool (*)(const CloudView&, const SensorModel&, int, LineGrouping&, ScanLines&);

/// In the order of trust: what the driver says, what the cloud's layout says, what geometry says.
constexpr std::pair<ScanLineSource, Finder> kFinders[] = {
    {ScanLineSource::ring_field, linesFromRingField},
    {ScanLineSource::organized_rows, linesFromOrganizedRows},
    {ScanLineSource::file_order, linesFromFileOrder},
    {ScanLineSource::elevation_table, linesFromElevationTable},
    {ScanLineSource::elevation_clusters, linesFromElevationClusters},
};

/// Along a scan line the azimuth changes, not the elevation: a lidar whose head does not turn numbers its lasers, too,
/// and a frame may be turned so that the rings stand upright in it.
bool runAlongTheAzimuth(const CloudView& cloud, const ScanLines& lines)
{
  constexpr std::size_t kSampled = 31;   // one step in so many tells enough; odd, since drivers' habits are even
  constexpr double kMostUpright = 0.25;  // of the steps: rings of a frame that is turned by 90 degrees have half
  std::size_t upright = 0;
  std::size_t steps = 0;
  for (std::size_t m = 0; m < lines.lines(); ++m) {
    for (std::size_t n = static_cast<std::size_t>(lines.begin[m]) + 1; n < static_cast<std::size_t>(lines.begin[m + 1]);
         n += kSampled) {
      const auto a = static_cast<std::size_t>(lines.index[n - 1]);
      const auto b = static_cast<std::size_t>(lines.index[n]);
      const double distance_a = std::hypot(cloud.x(a), cloud.y(a));
      const double distance_b = std::hypot(cloud.x(b), cloud.y(b));
      const double aside = static_cast<double>(cloud.x(a)) * cloud.y(b) - static_cast<double>(cloud.y(a)) * cloud.x(b);
      const double upwards = distance_a * cloud.z(b) - distance_b * cloud.z(a);
      // Both are products of distances and the tangent of an angle: of the azimuth's step, and of the elevation's.
      upright += std::abs(upwards) > std::abs(aside) ? 1U : 0U;
      ++steps;
    }
  }
  return static_cast<double>(upright) <= kMostUpright * static_cast<double>(steps);
}

}  // namespace

void findScanLines(const CloudView& cloud, const SensorModel& sensor, ScanLineSource source, ScanLines& lines,
                   int threads)
{
  LineGrouping grouping;
  findScanLines(cloud, sensor, source, threads, grouping, lines);
}

void findScanLines(const CloudView& cloud, const SensorModel& sensor, ScanLineSource source, int threads,
                   LineGrouping& grouping, ScanLines& lines)
{
  const auto start_over = [&lines] {
    lines.index.clear();
    lines.begin.clear();
    lines.source = ScanLineSource::automatic;
    lines.failure = ScanLineFailure::none;
    lines.confidence = 0.0F;
    lines.sorted_by_azimuth = lines.transposed = lines.kitti_order = false;
  };
  start_over();
  if (!sensor.has_scan_lines) {
    lines.failure = ScanLineFailure::not_looked_for;
    return;
  }
  if (firstMeasurable(cloud) == cloud.size) {
    lines.failure = ScanLineFailure::empty_cloud;
    return;
  }
  for (const auto& [own, find] : kFinders) {
    if (source != ScanLineSource::automatic && source != own) {
      continue;
    }
    if (find(cloud, sensor, std::max(threads, 1), grouping, lines) &&
        (source != ScanLineSource::automatic || runAlongTheAzimuth(cloud, lines))) {
      lines.source = own;
      return;
    }
    start_over();
  }
  lines.failure =
      source == ScanLineSource::automatic ? ScanLineFailure::no_line_structure : ScanLineFailure::source_not_available;
}

}  // namespace pcl_floam
