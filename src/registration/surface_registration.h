/// \file surface_registration.h
/// The pose estimation: points of a scan against the surfaces of a map (the paper's "Pose Estimation").
#pragma once

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/scan_points.h>
#include <pcl_floam/map/surface.h>
#include <pcl_floam/registration/registration_parameters.h>
#include <pcl_floam/registration/registration_report.h>

#include <vector>

namespace pcl_floam {

/// Points and where their surfaces are sought; nothing without points.
struct SurfaceTerm {
  const std::vector<ScanPoint>* points = nullptr;
  const SurfaceSearch* target = nullptr;
};

/// The motion during the sweep as it depends on the unknown pose: log(T(0)^-1 T(1)) = twist + gain e, with e how far
/// the pose is from the guess, in the sensor's axes.
struct SweepDependence {
  Vector6 twist = Vector6::Zero();
  Matrix6 gain = Matrix6::Zero();
};

/// What is to be registered, and what is known before.
struct SurfaceProblem {
  SurfaceTerm scan;   ///< points taken by space
  SurfaceTerm edges;  ///< the paper's edge features
  SE3 guess;          ///< target_T_sensor at mid-sweep
  /// Of the guess: perturbation on the left (translation m, rotation rad), about the sensor's position, the target's
  /// axes. It bounds how far the first iterations look.
  Matrix6 guess_covariance = Matrix6::Identity();
  bool guess_is_prior = true;  ///< the guess counts as a measurement of that covariance
  SweepDependence sweep;
  DegreesOfFreedom locked = {};  ///< these keep the guess's value
  bool wants_evidence = false;   ///< else the result has none
  int max_iterations = 12;
  int threads = 1;
};

struct SurfaceRegistration {
  RegistrationReport report;
  /// Of the pose, prior included, as if all residuals were independent: how the iterations weighed them.
  Matrix6 posterior = Matrix6::Zero();
  /// Log-likelihood of the points where the pose has them, over that of points that may be anywhere within a metre.
  double evidence = 0.0;
  std::size_t points = 0;  ///< that took part
};

/// Bit-identical for every number of threads.
[[nodiscard]] SurfaceRegistration registerSurfaces(const SurfaceProblem& problem);

/// What many residuals count as one, since neighbours share the errors of the map, of the lasers and of the motion.
inline constexpr double kResidualsPerIndependentOne = 20.0;

}  // namespace pcl_floam
