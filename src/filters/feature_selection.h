/// \file feature_selection.h
/// Feature extraction in memory that is kept from scan to scan.
#pragma once

#include "filters/line_rating.h"

#include <pcl_floam/filters/core/feature_extractor.h>

#include <vector>

namespace pcl_floam {

struct EdgeCandidate {
  float sharpness;
  int place;  ///< in the line
};

/// What is taken from some of a scan's lines, and what that needs.
struct FeatureSelection {
  LineRating line;
  std::vector<EdgeCandidate> candidates;
  FeatureSet features;
};

/// \ref extractFeatures of all points.
/// \param selections room, one for each part of the scan that is looked at by itself
void extractFeatures(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
                     const FeatureParameters& parameters, const std::vector<std::uint8_t>& selectable, int threads,
                     std::vector<FeatureSelection>& selections, FeatureSet& features);

}  // namespace pcl_floam
