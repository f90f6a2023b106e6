/// \file reason_to_doubt.h
/// When a pose that was found is not called tracked.
#pragma once

#include "odometry/tracker.h"

#include <pcl_floam/filters/scan_lines.h>
#include <pcl_floam/registration/core/registration_parameters.h>

namespace pcl_floam {

/// A pose that the map does not bear out is not called tracked, nor one of a single layer in space. The first
/// sweeps' map is too young to tell.
/// \param failure   why there are no scan lines, if there are none
/// \param explained part of the scan's points that lie on surfaces of the map
/// \param locked    degrees of freedom that are kept
/// \return nullptr: there is none
[[nodiscard]] const char* reasonToDoubt(const Tracker& tracker, ScanLineFailure failure, double explained,
                                        const DegreesOfFreedom& locked);

}  // namespace pcl_floam
