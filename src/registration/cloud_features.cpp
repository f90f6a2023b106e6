#include "filters/scan_line_finders.h"

#include <pcl_floam/filters/core/feature_extractor.h>
#include <pcl_floam/registration/core/cloud_features.h>

#include <cstdint>

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

}  // namespace pcl_floam
