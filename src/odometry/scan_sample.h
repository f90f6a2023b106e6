/// \file scan_sample.h
/// Points of a whole scan, of which the features are but a part.
#pragma once

#include <pcl_floam/common/cloud_view.h>
#include <pcl_floam/filters/feature_parameters.h>
#include <pcl_floam/filters/scan_lines.h>
#include <pcl_floam/filters/scan_timing.h>
#include <pcl_floam/filters/sweep_motion.h>

#include <Eigen/Core>

#include <vector>

namespace pcl_floam {

/// About 12000 points, as seen at the motion's reference instant: of neighbours along a scan line always the nearest,
/// so that a pole is not lost before a wall.
/// \param ranges              of its settings the ranges alone: points nearer or farther are left out
/// \param vertical_correction degrees
[[nodiscard]] std::vector<Eigen::Vector3f> undistortedSample(const CloudView& scan, const ScanLines& lines,
                                                             const ScanTiming& timing, const FeatureParameters& ranges,
                                                             double vertical_correction, const SweepMotion& motion);

}  // namespace pcl_floam
