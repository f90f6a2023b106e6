/// \file weights.h
/// Smoothness weights of the features (Eq. 9).
#pragma once

#include <pcl_floam/filters/features.h>
#include <pcl_floam/map/keyframe_voxel_map.h>
#include <pcl_floam/registration/registration_parameters.h>

#include <vector>

namespace pcl_floam {

/// W(p) of every feature of one kind (Eq. 9).
[[nodiscard]] std::vector<double> smoothnessWeights(const std::vector<Feature>& features, FeatureKind kind,
                                                    WeightScheme scheme, WeightNormalization normalization);

}  // namespace pcl_floam
