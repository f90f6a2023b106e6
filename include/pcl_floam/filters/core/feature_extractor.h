/// \file feature_extractor.h
/// Edges and planes of one scan, for every point type: the core of \ref pcl_floam::FeatureExtraction.
#pragma once

#include <pcl_floam/common/core/cloud_view.h>
#include <pcl_floam/filters/core/feature_parameters.h>
#include <pcl_floam/filters/core/features.h>
#include <pcl_floam/filters/core/scan_timing.h>
#include <pcl_floam/filters/scan_lines.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// The mask that \ref extractFeatures takes, from PCL's indices; those outside the cloud are left out.
template <typename Indices>
[[nodiscard]] std::vector<std::uint8_t> maskOf(const Indices& indices, std::size_t cloud_size)
{
  std::vector<std::uint8_t> mask(cloud_size, 0);
  for (const auto index : indices) {
    if (index >= 0 && static_cast<std::size_t>(index) < cloud_size) {
      mask[static_cast<std::size_t>(index)] = 1;
    }
  }
  return mask;
}

/// Extracts the edge set E_k and the plane set S_k of a scan (the paper's "Sensor Model and Feature Extraction").
///
/// Edges are at the points of highest smoothness in each sector of each scan line, planes are those of lowest
/// smoothness, spread evenly over the sector. Points on the far side of a depth step (whose place depends on
/// what hides them), points on surfaces seen at grazing incidence, and points out of range are left out.
///
/// \param cloud      one scan in the sensor's frame
/// \param lines      its scan lines; without any there are no features
/// \param timing     the points' times
/// \param parameters must be valid (\ref validate)
/// \param[out] features overwritten; its memory is reused. In the order of the scan lines.
/// \param selectable empty, or one per point of the cloud: only points with a nonzero entry become features, while
///                   all points serve as neighbours, so that a cut does not look like an edge
/// \param threads    to share the work; the result is the same for every number. >= 1
void extractFeatures(const CloudView& cloud, const ScanLines& lines, const ScanTiming& timing,
                     const FeatureParameters& parameters, FeatureSet& features,
                     const std::vector<std::uint8_t>& selectable = {}, int threads = 1);

}  // namespace pcl_floam
