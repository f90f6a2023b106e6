/// \file surface_registration.h
/// The pose estimation: points of a scan against the surfaces of a map (the paper's "Pose Estimation").
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/scan_points.h>
#include <pcl_floam/map/surface.h>
#include <pcl_floam/registration/registration_report.h>

#include <vector>

namespace pcl_floam {

/// What is to be registered, and what is known before.
struct SurfaceProblem {
  const std::vector<ScanPoint>* points = nullptr;
  const SurfaceSearch* target = nullptr;
  SE3 guess;  ///< target_T_sensor at mid-sweep
  /// Of the guess: perturbation on the left (translation m, rotation rad), about the sensor's position, the target's
  /// axes. It bounds how far the first iterations look.
  Matrix6 guess_covariance = Matrix6::Identity();
  bool guess_is_prior = true;  ///< the guess counts as a measurement of that covariance
  /// Motion during the sweep, if it is known: log(T(0)^-1 T(1)).
  Vector6 sweep_twist = Vector6::Zero();
  /// With `motion_per_sweep` > 0 the sweep's motion is that of the unknown pose since an earlier one, times this.
  SE3 earlier_pose;
  double sweep_per_motion = 0.0;
  int max_iterations = 12;
  int threads = 1;
};

/// Bit-identical for every number of threads.
[[nodiscard]] RegistrationReport registerSurfaces(const SurfaceProblem& problem);

}  // namespace pcl_floam
