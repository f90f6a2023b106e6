/// \file registration_report.h
/// What came of a registration: not only the pose.
#pragma once

#include <pcl_floam/common/se3.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_floam {

/// Why the iterations ended.
enum class Termination : std::uint8_t {
  not_run,
  converged,                ///< the last step was below the thresholds
  iteration_limit,          ///< stopped by the maximum number of iterations; the pose is usable
  too_few_features,         ///< the source has too few features to constrain a pose
  empty_target,             ///< nothing to register against
  too_few_correspondences,  ///< too few source features have a line or plane nearby
  degenerate,               ///< the correspondences constrain no direction at all
  invalid_input             ///< a non-finite guess or non-finite result
};

[[nodiscard]] const char* toString(Termination termination);

/// A direction of motion that the correspondences hardly constrain, or only by the sensor's own pattern: what pulls the
/// pose back along it does not grow with the way. By surfaces what factors or locks tell of is not named, and several
/// directions are at right angles to each other.
struct WeakDirection {
  /// Unit direction in (translation, rotation) about the sensor's position, in the world's axes; rotation
  /// components are scaled by the scene's size, so that both are metres of displacement of a typical point.
  Vector6 direction = Vector6::Zero();
  /// Of the scaled information, without the noise of the normals, over the sum of the weights; >= 0, and 0.1 to 1 where
  /// a direction is well constrained. By surfaces 0 of what the sensor's pattern holds.
  double eigenvalue = 0.0;
};

/// The outcome of one registration.
struct RegistrationReport {
  Termination termination = Termination::not_run;
  int iterations = 0;
  int edge_correspondences = 0;   ///< of the last iteration
  int plane_correspondences = 0;  ///< of the last iteration
  int point_correspondences = 0;  ///< of the last iteration: neither line nor plane; only of clouds without scan lines
  int edge_inliers = 0;           ///< those with a robust weight of at least one half
  int plane_inliers = 0;
  double cost = 0.0;          ///< half the sum of weighted squared residuals, m^2
  double residual_rms = 0.0;  ///< weighted root mean square of the residuals, m
  SE3 target_T_source;        ///< the result; the guess when it failed
  /// Motion over the sweep that goes with the result: as it was given, or as it was estimated.
  Vector6 sweep_twist = Vector6::Zero();
  Vector6 sweep_acceleration = Vector6::Zero();  ///< change of that motion over the sweep
  /// J^T W J of the last iteration: by features of points and factors; by surfaces of points, without what noise makes
  /// of it. Perturbation order (translation m, rotation rad), on the left, with the rotation about the
  /// origin of the source's frame (the sensor) and the target's axes.
  Matrix6 information = Matrix6::Zero();
  /// Covariance of the pose in the same parametrisation: by features and clouds the information's inverse times the
  /// variance of an independent residual, which seven neighbouring ones make up. The map's own drift comes on top. Weak
  /// directions have a variance too large to be used, not infinity, or that of the motion prior; what the sensor's
  /// pattern holds keeps its own here, and has any motion's in that of the odometry's report.
  Matrix6 covariance = Matrix6::Zero();
  std::vector<WeakDirection> weak_directions;

  [[nodiscard]] bool hasConverged() const
  {
    return termination == Termination::converged || termination == Termination::iteration_limit;
  }
};

}  // namespace pcl_floam
