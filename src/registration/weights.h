/// \file weights.h
/// What the features count: by their smoothness (Eq. 9), and planes by how well the map's points lie on them.
#pragma once

#include "registration/correspondences.h"

#include <pcl_floam/filters/core/feature_kind.h>
#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/registration/core/registration_parameters.h>

#include <vector>

namespace pcl_floam {

/// What an edge counts beside a plane, where Eq. 10 is not taken as printed, with 1. Edges are centimetres off, by the
/// noise and the spacing of the few points that they were seen by, where planes are good to millimetres; but along
/// corridors and roads there is little else.
inline constexpr double kEdgeWeight = 0.12;

/// W(p) of every feature of one kind (Eq. 9). But as printed they sum up to the features' number, or to \ref
/// kEdgeWeight times that of the edges: residuals keep their units, and each feature its say.
[[nodiscard]] std::vector<double> smoothnessWeights(const std::vector<Feature>& features, FeatureKind kind,
                                                    WeightScheme scheme);

/// A plane counts half if its map points' standard deviation across it is so many times the median of the scan's
/// planes.
inline constexpr double kPlaneScatter = 2.0;

/// Weighs each linked plane by W / (1 + v / (kPlaneScatter^2 m)), where v is its variance and m the median of all.
///
/// Five neighbours at the foot of a wall or a shelf are no plane, but tilt and lift the one that is fitted to them, and
/// always to the same side: the floor has things standing on it, none hang below.
/// \param weights W of Eq. 9, for each of the planes
void weighByScatter(const std::vector<double>& weights, std::vector<Correspondence>& planes);

}  // namespace pcl_floam
