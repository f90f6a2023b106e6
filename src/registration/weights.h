/// \file weights.h
/// What the features count: by their smoothness (Eq. 9), and planes by how well the map's points lie on them.
#pragma once

#include "registration/correspondences.h"

#include <pcl_floam/filters/feature_kind.h>
#include <pcl_floam/filters/features.h>
#include <pcl_floam/registration/registration_parameters.h>

#include <vector>

namespace pcl_floam {

/// W(p) of every feature of one kind (Eq. 9).
[[nodiscard]] std::vector<double> smoothnessWeights(const std::vector<Feature>& features, FeatureKind kind,
                                                    WeightScheme scheme, WeightNormalization normalization);

/// A plane counts half if its map points' standard deviation across it is so many times the median of the scan's
/// planes.
inline constexpr double kPlaneScatter = 2.0;

/// Weighs each linked plane by W / (1 + v / (scatter^2 m)), where v is its variance and m the median of all.
///
/// Five neighbours at the foot of a wall or a shelf are no plane, but tilt and lift the one that is fitted to them, and
/// always to the same side: the floor has things standing on it, none hang below.
/// \param weights W of Eq. 9, for each of the planes
/// \param scatter as \ref kPlaneScatter; 0 leaves W
void weighByScatter(const std::vector<double>& weights, double scatter, std::vector<Correspondence>& planes);

}  // namespace pcl_floam
