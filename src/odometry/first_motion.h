/// \file first_motion.h
/// The motion between the first two scans, when nothing can be predicted yet.
#pragma once

#include <pcl_floam/filters/features.h>
#include <pcl_floam/odometry/odometry_parameters.h>
#include <pcl_floam/registration/registration_report.h>

#include <optional>
#include <vector>

namespace pcl_floam {

/// The first two scans of a sequence, as measured.
struct FirstScans {
  const FeatureSet& first;
  const FeatureSet& second;
  double periods = 1.0;         ///< between them
  double sweep_fraction = 1.0;  ///< duration of a sweep in periods; 0 if the points have no times
  double reference = 0.5;       ///< the instant of the poses
};

/// Motions per period.
struct FirstMotion {
  Vector6 twist = Vector6::Zero();
  /// Quite other ones that may explain the scans as well; none where most features are explained.
  std::vector<Vector6> others;
};

/// Whether two motions per period are different ones, not one found twice.
inline bool areApart(const Vector6& a, const Vector6& b)
{
  constexpr double kApart = 0.5;  // m
  return (a - b).head<3>().norm() > kApart;
}

/// \return the motion, or nothing and a \p report that says why
[[nodiscard]] std::optional<FirstMotion> findFirstMotion(const FirstScans& scans, const OdometryParameters& parameters,
                                                         RegistrationReport& report);

}  // namespace pcl_floam
