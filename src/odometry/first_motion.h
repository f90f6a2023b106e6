/// \file first_motion.h
/// The motion between the first two scans, when nothing can be predicted yet.
#pragma once

#include <pcl_floam/filters/features.h>
#include <pcl_floam/odometry/odometry_parameters.h>
#include <pcl_floam/registration/registration_report.h>

#include <optional>

namespace pcl_floam {

/// The first two scans of a sequence, as measured.
struct FirstScans {
  const FeatureSet& first;
  const FeatureSet& second;
  double periods = 1.0;         ///< between them
  double sweep_fraction = 1.0;  ///< duration of a sweep in periods; 0 if the points have no times
  double reference = 0.5;       ///< the instant of the poses
};

/// \return the motion per period, or nothing and a \p report that says why
[[nodiscard]] std::optional<Vector6> findFirstMotion(const FirstScans& scans, const OdometryParameters& parameters,
                                                     RegistrationReport& report);

}  // namespace pcl_floam
