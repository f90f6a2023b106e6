#include "filters/scan_line_finders.h"

#include <pcl_floam/filters/feature_extractor.h>
#include <pcl_floam/map/neighbor_search.h>
#include <pcl_floam/registration/cloud_features.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_floam {

FeatureSet scanLineFeatures(const CloudView& cloud, const SensorModel& sensor, const FeatureParameters& parameters,
                            const std::vector<std::uint8_t>& selectable)
{
  FeatureSet features;
  ScanLines lines;
  findScanLines(cloud, sensor, ScanLineSource::automatic, lines);
  if (lines.valid() && lines.source != ScanLineSource::organized_rows) {
    extractFeatures(cloud, lines, findScanTiming(cloud, lines), parameters, features, selectable);
  }
  return features;
}

FeatureSet pointFeatures(const CloudView& cloud, const std::vector<std::uint8_t>& selectable)
{
  FeatureSet features;
  for (std::size_t i = 0; i < cloud.size; ++i) {
    if (isMeasurable(cloud, i) && (selectable.empty() || selectable[i] != 0)) {
      features.planes.push_back({cloud.x(i), cloud.y(i), cloud.z(i), 1.0F, 0.0F, static_cast<std::int32_t>(i)});
    }
  }
  return features;
}

std::vector<Eigen::Vector3d> measurablePoints(const CloudView& cloud)
{
  std::vector<Eigen::Vector3d> points;
  points.reserve(cloud.size);
  for (std::size_t i = 0; i < cloud.size; ++i) {
    if (isMeasurable(cloud, i)) {
      points.emplace_back(cloud.x(i), cloud.y(i), cloud.z(i));
    }
  }
  return points;
}

double pointSpacing(const std::vector<Eigen::Vector3d>& points, const NeighborSearch& search)
{
  constexpr std::size_t kSamples = 200;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSamples);
  std::vector<double> distances;
  for (std::size_t i = 0; i < points.size(); i += step) {
    Neighbors neighbors;
    search.nearest(points[i], 5, std::sqrt(std::numeric_limits<float>::max()) / 2.0, neighbors);
    for (int n = 0; n < neighbors.count; ++n) {
      if (neighbors[n].squared_distance > 0.0F) {  // the nearest is the point itself, or a double of it
        distances.push_back(std::sqrt(static_cast<double>(neighbors[n].squared_distance)));
        break;
      }
    }
  }
  if (distances.empty()) {
    return 0.0;
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace pcl_floam
