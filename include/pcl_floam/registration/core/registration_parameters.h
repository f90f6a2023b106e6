/// \file registration_parameters.h
/// Settings of the pose estimation.
#pragma once

#include <array>
#include <cstdint>

namespace pcl_floam {

/// How the smoothness of a feature weighs its residual (Eq. 9).
enum class WeightScheme : std::uint8_t {
  uniform,   ///< all alike
  inverted,  ///< what the paper's text wants: exp(+sigma) on edges, exp(-sigma) on planes
  printed    ///< as Eq. 9 is printed: exp(-sigma) on edges, exp(+sigma) on planes, each kind's with a sum of 1
};

/// Influence of large residuals.
enum class RobustKernel : std::uint8_t { none, huber, cauchy, geman_mcclure };

enum class SolverKind : std::uint8_t { gauss_newton, ceres };

[[nodiscard]] const char* toString(WeightScheme scheme);
[[nodiscard]] const char* toString(RobustKernel kernel);
[[nodiscard]] const char* toString(SolverKind solver);

/// Degrees of freedom of a pose: translation along x, y, z, then rotation about x, y, z of the target's axes.
using DegreesOfFreedom = std::array<bool, 6>;

/// \ref RegistrationParameters::locked for a robot on level ground: height, roll and pitch. A 2-D lidar needs it.
inline constexpr DegreesOfFreedom kPlanarMotion = {false, false, true, true, true, false};

/// Settings of \ref EdgePlaneRegistration.
struct RegistrationParameters {
  SolverKind solver = SolverKind::gauss_newton;
  WeightScheme weights = WeightScheme::uniform;
  RobustKernel kernel = RobustKernel::cauchy;  ///< its scale follows the residuals' spread
  /// Degrees of freedom that keep the guess's value; none by default. Their covariance is zero. Exact for
  /// \ref kPlanarMotion, for all translations and for all rotations; else to second order of the correction.
  DegreesOfFreedom locked = {};
};

}  // namespace pcl_floam
