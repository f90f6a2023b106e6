/// \file spin_axis.h
/// The axis that a sensor's lasers turn about.
#pragma once

#include <pcl_floam/filters/scan_points.h>

#include <Eigen/Core>

#include <vector>

namespace pcl_floam {

/// The direction that the beams of each laser have most in common: a laser that turns draws a cone about it. So it is
/// found in any frame that the cloud may be given in.
/// \param points of a scan with scan lines, in the order of their lasers
/// \return a unit vector; zero if there are too few points to tell
[[nodiscard]] Eigen::Vector3d spinAxis(const std::vector<ScanPoint>& points);

}  // namespace pcl_floam
