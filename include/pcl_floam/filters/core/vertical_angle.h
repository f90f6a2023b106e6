/// \file vertical_angle.h
/// Correction of a sensor's vertical calibration: the core of \ref pcl_floam::VerticalCorrection.
#pragma once

#include <pcl_floam/filters/core/features.h>

#include <cstddef>

namespace pcl_floam {

/// Turns every feature by \p degrees about p x z, so that it rises (KITTI's HDL-64 needs about 0.205).
void correctVerticalAngle(double degrees, FeatureSet& features);

/// The same for \p count points side by side.
/// \param threads >= 1; the result does not depend on it
void correctVerticalAngle(double degrees, std::size_t count, float* x, float* y, float* z, int threads = 1);

}  // namespace pcl_floam
