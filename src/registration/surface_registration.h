/// \file surface_registration.h
/// The pose estimation: points of a scan against the surfaces of a map (the paper's "Pose Estimation").
#pragma once

#include "registration/pose_factors.h"
#include "registration/sweep_prior.h"

#include <pcl_floam/common/se3.h>
#include <pcl_floam/filters/core/scan_point.h>
#include <pcl_floam/map/core/surface.h>
#include <pcl_floam/registration/core/registration_parameters.h>
#include <pcl_floam/registration/core/registration_report.h>

#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Points and where their surfaces are sought; nothing without points.
struct SurfaceTerm {
  const std::vector<ScanPoint>* points = nullptr;
  const SurfaceSearch* target = nullptr;
};

/// How a sweep's points follow the sensor's motion during it.
enum class SweepPlacement : std::uint8_t {
  held,     ///< they are placed by the velocity that was expected
  follows,  ///< by the velocity that each iteration makes of the pose
  joint     ///< and pose and velocity are what explains them best
};

/// How well the target explains the sweep where the pose has it: what a result tells of that.
enum class Evidence : std::uint8_t {
  none,
  total,     ///< of all residuals
  of_points  ///< and of each of the scan's points
};

/// What is to be registered, and what is known before.
struct SurfaceProblem {
  SurfaceTerm scan;   ///< points taken by space
  SurfaceTerm edges;  ///< the paper's edge features
  const PoseFactors* factors = nullptr;
  SweepPrior prior;
  Vector6 begins_off = Vector6::Zero();            ///< perturbation of the prior's pose from which the search begins
  Matrix6 guess_covariance = Matrix6::Identity();  ///< the first iteration looks so far
  SweepPlacement placement = SweepPlacement::joint;
  DegreesOfFreedom locked = {};  ///< these keep the guess's value
  Evidence evidence = Evidence::none;
  /// Several motions are compared, by how each explains the scan: then residuals count as they are, noise and all, and
  /// only what they do not tell is left to the prior.
  bool is_rival = false;
  /// The pose is moved aside to see what holds it: structure or, as it seems, the sensor's own sampling pattern.
  bool looks_for_patterns = false;
  int max_iterations = 12;  ///< and as many again where a pattern is left to a hint
  int threads = 1;
  struct SurfaceRoom* room = nullptr;  ///< memory of the last one, of none that runs; nullptr: there is none
};

struct SurfaceRegistration {
  RegistrationReport report;
  Vector6 velocity = Vector6::Zero();     ///< per period, in the sensor's axes
  Matrix12 posterior = Matrix12::Zero();  ///< of pose and velocity, as the prior's
  /// Log-likelihood per independent residual of the points where the pose has them, over that of points that may be
  /// anywhere within a metre.
  double evidence = 0.0;
  std::vector<float> point_evidence;  ///< of the scan's points (\ref Evidence::of_points)
  /// Covariance of the pose as the scan alone tells it, whatever was expected: nothing of where it is not held.
  Matrix6 told = Matrix6::Zero();
  std::size_t points = 0;  ///< that took part

  /// Part of the points that lie on surfaces of the target.
  [[nodiscard]] double explained() const
  {
    return points > 0 ? static_cast<double>(report.plane_inliers) / static_cast<double>(points) : 0.0;
  }
};

/// Bit-identical for every number of threads.
[[nodiscard]] SurfaceRegistration registerSurfaces(const SurfaceProblem& problem);

/// What many residuals count as one, since neighbours share the errors of the map, of the lasers and of the motion.
inline constexpr double kResidualsPerIndependentOne = 20.0;

}  // namespace pcl_floam
