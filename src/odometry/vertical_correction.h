/// \file vertical_correction.h
/// Correction of a sensor's vertical calibration.
#pragma once

#include <pcl_floam/filters/features.h>
#include <pcl_floam/filters/scan_points.h>

#include <vector>

namespace pcl_floam {

/// Turns every feature by \p degrees about p x z, so that it rises (KITTI's HDL-64 needs about 0.205).
void correctVerticalAngle(double degrees, FeatureSet& features);

/// \copydoc correctVerticalAngle
void correctVerticalAngle(double degrees, std::vector<ScanPoint>& points);

}  // namespace pcl_floam
