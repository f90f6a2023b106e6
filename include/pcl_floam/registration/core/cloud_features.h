/// \file cloud_features.h
/// From clouds to what the pose estimation works on.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/feature_parameters.h>
#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/filters/core/sensor_model.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// The edges and planes of a lidar scan; empty sets if the cloud has no scan lines. Rows of organised clouds are not
/// taken for scan lines here: depth images have them too.
/// \param selectable see extractFeatures
[[nodiscard]] FeatureSet scanLineFeatures(const CloudView& cloud, const SensorModel& sensor,
                                          const FeatureParameters& parameters,
                                          const std::vector<std::uint8_t>& selectable = {});

/// Every measurable point as a plane feature, for clouds without scan lines.
[[nodiscard]] FeatureSet pointFeatures(const CloudView& cloud, const std::vector<std::uint8_t>& selectable = {});

}  // namespace pcl_floam
